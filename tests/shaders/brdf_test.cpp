#include "shaders/shared/brdf.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "shaders/shared/pure.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

vec3 directionAt(double cosine, double phi)
{
    const double s = std::sqrt(1.0 - cosine * cosine);
    return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosine)};
}

const vec3 kNormal(0.0f, 0.0f, 1.0f);

// Midpoint rule over the hemisphere, finer toward small angles to the mirror direction than any lobe tested here.
template <class F> double overHemisphere(F f)
{
    constexpr int kCosines = 400, kAngles = 800;
    double sum = 0.0;
    for (int i = 0; i < kCosines; ++i)
        for (int j = 0; j < kAngles; ++j)
        {
            const double cosine = (i + 0.5) / kCosines;
            sum += f(directionAt(cosine, 2.0 * std::numbers::pi * (j + 0.5) / kAngles));
        }
    return sum * 2.0 * std::numbers::pi / (kCosines * kAngles);
}

/// x: what a white GGX lobe reflects of white light without scattering twice, y: the same weighted by (1 - v.h)^5. In double and from the
/// formulas of the papers: GGX (Walter et al. 2007, equation 33), height-correlated Smith (Heitz 2014, equation 99). The half vector is
/// integrated over, by tan(theta) = alpha sqrt(u / (1 - u)), whose density is D cos(theta): the lobe is flat in u however narrow it is.
glm::dvec2 whiteByQuadrature(double nv, double alpha)
{
    constexpr int kRings = 1000, kAround = 240;
    const glm::dvec3 view(std::sqrt(1.0 - nv * nv), 0.0, nv);
    const auto lambda = [&](double cosine) { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0); };
    glm::dvec2 sum(0.0);
    for (int ring = 0; ring < kRings; ++ring)
    {
        const double u = (ring + 0.5) / kRings, tangent = alpha * std::sqrt(u / (1.0 - u)), nh = 1.0 / std::sqrt(1.0 + tangent * tangent);
        for (int i = 0; i < kAround; ++i)
        {
            const double phi = 2.0 * std::numbers::pi * (i + 0.5) / kAround;
            const glm::dvec3 half(tangent * nh * std::cos(phi), tangent * nh * std::sin(phi), nh);
            const double vh = glm::dot(view, half);
            const double nl = 2.0 * vh * nh - nv;
            if (vh <= 0.0 || nl <= 0.0) continue;
            // D G / (4 nl nv) nl dl, with dl = 4 vh dh and D nh dh uniform in u and phi
            const double weight = vh / (nv * nh) / (1.0 + lambda(nl) + lambda(nv));
            sum += glm::dvec2(weight, weight * std::pow(1.0 - vh, 5.0));
        }
    }
    return sum / double(kRings * kAround);
}

TEST(Brdf, SharesOfWhiteLightAgreeWithQuadrature)
{
    for (const double roughness : {0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0})
        for (const double nv : {0.05, 0.15, 0.3, 0.5, 0.7, 0.9, 1.0})
        {
            const glm::dvec2 truth = whiteByQuadrature(nv, std::max(roughness * roughness, 1e-3));
            const vec2 found = whiteShares(float(nv), float(roughness));
            EXPECT_NEAR(found.x, truth.x, 0.006 * truth.x) << "roughness " << roughness << ", n.v " << nv; // 0.55 % at most
            const double dielectric = 0.04 * truth.x + 0.96 * truth.y;
            EXPECT_NEAR(0.04 * found.x + 0.96 * found.y, dielectric, 0.02 * dielectric) << "roughness " << roughness << ", n.v " << nv;
        }
    for (const double nv : {0.0, 0.3, 1.0}) // a mirror's are Schlick's
    {
        EXPECT_EQ(whiteShares(float(nv), 0.0f).x, 1.0f);
        EXPECT_NEAR(whiteShares(float(nv), 0.0f).y, std::pow(1.0 - nv, 5.0), 1e-6);
    }
}

TEST(Brdf, RoughnessOneIsItsClosedForm)
{
    const BrdfSurface surface{vec3(0.7f), 0.25f, 1.0f};
    const test::RoughModel model{0.7, 0.25};
    for (double nl : {0.05, 0.4, 0.9})
        for (double nv : {0.1, 0.5, 1.0})
            for (double phi : {0.0, 1.0, 3.0})
            {
                const BrdfValue value = evaluateBrdf(surface, kNormal, directionAt(nv, 0.0), directionAt(nl, phi));
                const double vh = test::RoughModel::cosineToHalf(nl, nv, phi), diffuse = model.diffuse(nl, nv),
                             specular = model.specular(vh, nl, nv);
                // Within what the shares' fits allow: 0.55 % of the gain, 2 % of the 4 to 9 % that a dielectric reflects.
                EXPECT_NEAR(value.diffuse.x, diffuse, 0.003 * diffuse) << nl << ' ' << nv << ' ' << phi;
                EXPECT_NEAR(value.specular.x, specular, 0.006 * specular) << nl << ' ' << nv << ' ' << phi;
            }
}

// What a surface reflects of a white furnace by quadrature over the light, against the number 1: metals and dielectrics, every roughness.
TEST(Brdf, WhiteFurnaceGivesOne)
{
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.3f, 0.5f, 0.7f, 0.85f, 1.0f})
            for (const double nv : {0.05, 0.2, 0.4, 0.7, 1.0})
            {
                const BrdfSurface surface{vec3(1.0f), metallic, roughness};
                const vec3 view = directionAt(nv, 0.0);
                const double reflects = overHemisphere(
                    [&](vec3 l)
                    {
                        const BrdfValue f = evaluateBrdf(surface, kNormal, view, l);
                        return double(f.diffuse.x + f.specular.x) * l.z;
                    });
                EXPECT_NEAR(reflects, 1.0, 0.01) << "metallic " << metallic << ", roughness " << roughness << ", n.v " << nv;
            }
}

/// overHemisphere() in double of a GGX lobe too narrow for that rule: by the half vectors of whiteByQuadrature().
/// @param f  of the light's direction, the normal being +z
template <class F> double overHalfVectors(glm::dvec3 view, double alpha, F f)
{
    constexpr int kRings = 400, kAround = 120;
    double sum = 0.0;
    for (int ring = 0; ring < kRings; ++ring)
    {
        const double u = (ring + 0.5) / kRings, tangent = alpha * std::sqrt(u / (1.0 - u)), nh = 1.0 / std::sqrt(1.0 + tangent * tangent);
        const double density = (1.0 - u) * (1.0 - u) / (std::numbers::pi * alpha * alpha * nh * nh * nh); // D nh
        for (int i = 0; i < kAround; ++i)
        {
            const double phi = 2.0 * std::numbers::pi * (i + 0.5) / kAround;
            const glm::dvec3 half(tangent * nh * std::cos(phi), tangent * nh * std::sin(phi), nh);
            const double vh = glm::dot(view, half);
            const glm::dvec3 light = 2.0 * vh * half - view;
            if (vh > 0.0 && light.z > 0.0) sum += f(light) * 4.0 * vh / density; // dl = 4 vh dh
        }
    }
    return sum / (kRings * kAround);
}

// The same of smooth surfaces. The diffuse lobe is alike all around; a mirror's specular one is a delta, which has its weight.
TEST(Brdf, WhiteFurnaceOfSmoothSurfacesGivesOne)
{
    using Exact = Pure<double>;
    constexpr int kCosines = 2000;
    const glm::dvec3 normal(0.0, 0.0, 1.0);
    for (const double metallic : {0.0, 0.5, 1.0})
        for (const double roughness : {0.0, 0.05, 0.1, 0.2})
            for (const double nv : {0.05, 0.2, 0.4, 0.7, 1.0})
            {
                const Exact::BrdfSurface surface{glm::dvec3(1.0), metallic, roughness};
                const glm::dvec3 view(std::sqrt(1.0 - nv * nv), 0.0, nv);
                double diffuse = 0.0;
                for (int i = 0; i < kCosines; ++i)
                {
                    const double nl = (i + 0.5) / kCosines;
                    const glm::dvec3 light(0.0, std::sqrt(1.0 - nl * nl), nl);
                    diffuse += 2.0 * std::numbers::pi / kCosines * Exact::evaluateBrdf(surface, normal, view, light).diffuse.x * nl;
                }
                const double specular =
                    Exact::isMirror(roughness)
                        ? Exact::specularColor(Exact::lobesAt(surface, nv)).x
                        : overHalfVectors(view, Exact::ggxAlpha(roughness),
                                          [&](glm::dvec3 l) { return Exact::evaluateBrdf(surface, normal, view, l).specular.x * l.z; });
                EXPECT_NEAR(diffuse + specular, 1.0, 0.01) << "metallic " << metallic << ", roughness " << roughness << ", n.v " << nv;
            }
}

TEST(Brdf, HemisphericalAlbedoAgreesWithQuadrature)
{
    for (const BrdfSurface& surface :
         {BrdfSurface{vec3(0.7f), 0.0f, 1.0f}, {vec3(0.7f), 0.5f, 0.5f}, {vec3(0.9f), 1.0f, 1.0f}, {vec3(0.7f), 0.0f, 0.3f}})
    {
        double sum = 0.0;
        constexpr int kViews = 24;
        for (int i = 0; i < kViews; ++i)
        {
            const double nv = (i + 0.5) / kViews;
            const vec3 view = directionAt(nv, 0.0);
            sum += 2.0 * nv / kViews *
                   overHemisphere(
                       [&](vec3 l)
                       {
                           const BrdfValue f = evaluateBrdf(surface, kNormal, view, l);
                           return double(f.diffuse.x + f.specular.x) * l.z;
                       });
        }
        EXPECT_NEAR(hemisphericalAlbedo(surface).x, sum, 0.004 * sum) << surface.metallic << ' ' << surface.roughness;
    }
    EXPECT_NEAR(hemisphericalAlbedo({vec3(0.9f), 1.0f, 1.0f}).x, test::RoughModel({0.9, 1.0}).hemisphericalAlbedo(), 0.004);
    EXPECT_NEAR(hemisphericalAlbedo({vec3(0.7f), 0.0f, 1.0f}).x, test::RoughModel({0.7, 0.0}).hemisphericalAlbedo(), 0.002);
    // A mirror's: Schlick's term has the mean 1/21.
    EXPECT_NEAR(hemisphericalAlbedo({vec3(0.5f), 1.0f, 0.0f}).x, 0.5 + 0.5 / 21.0, 1e-4);
}

// What a metal sends to all sides of light along a cosine, over the mean of all cosines: with the gain on the viewer's side, by quadrature
// in double.
TEST(Brdf, RoughMetalsSendOnOfLightAlongACosineWhatTheirLobeDoes)
{
    using Exact = Pure<double>;
    constexpr int kCosines = 24, kAngles = 48;
    const auto cosineOf = [](int i) { return (i + 0.5) / kCosines; };
    for (const double base : {0.5, 0.9})
        for (const double roughness : {0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
        {
            const Exact::BrdfSurface metal{glm::dvec3(base), 1.0, roughness};
            std::vector<double> sent(kCosines, 0.0);
            double mean = 0.0;
            for (int l = 0; l < kCosines; ++l)
            {
                const glm::dvec3 light(std::sqrt(1.0 - cosineOf(l) * cosineOf(l)), 0.0, cosineOf(l));
                for (int v = 0; v < kCosines; ++v)
                    for (int i = 0; i < kAngles; ++i)
                    {
                        const double phi = std::numbers::pi * (i + 0.5) / kAngles, sine = std::sqrt(1.0 - cosineOf(v) * cosineOf(v));
                        const glm::dvec3 view(sine * std::cos(phi), sine * std::sin(phi), cosineOf(v));
                        sent[size_t(l)] += Exact::evaluateBrdf(metal, glm::dvec3(0, 0, 1), view, light).specular.x * view.z;
                    }
                mean += 2.0 * cosineOf(l) / kCosines * sent[size_t(l)];
            }
            double squares = 0.0;
            for (int l = 0; l < kCosines; ++l)
            {
                const double c = cosineOf(l), off = Exact::takenAlong(c, -Exact::leanOfRoughness(roughness)) - sent[size_t(l)] / mean;
                squares += 2.0 * c / kCosines * off * off;
            }
            EXPECT_LT(std::sqrt(squares), roughness < 0.65 ? 0.037 : 0.030) << "base " << base << ", roughness " << roughness;
        }
}

// takenAlong() takes nothing away: its mean over the hemisphere, weighted by the cosine, is 1.
TEST(Brdf, WhatIsTakenAlongCosinesIsAllThereIs)
{
    for (const double grazing : {-1.2, -0.4, 0.0, 0.5, 1.05})
    {
        double sum = 0.0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i)
        {
            const double c = (i + 0.5) / kSteps;
            sum += 2.0 * c / kSteps * Pure<double>::takenAlong(c, grazing);
        }
        EXPECT_NEAR(sum, 1.0, 1e-6) << grazing;
    }
}

TEST(Brdf, FloatAgreesWithDouble)
{
    using Exact = Pure<double>;
    for (double roughness : {0.05, 0.4, 1.0})
        for (double nl : {0.1, 0.9})
            for (double phi : {0.0, 1.0, 3.0})
            {
                const vec3 v = directionAt(0.5, 0.0), l = directionAt(nl, phi);
                const BrdfValue value = evaluateBrdf({vec3(0.7f), 0.25f, float(roughness)}, kNormal, v, l);
                const Exact::BrdfValue exact = Exact::evaluateBrdf({glm::dvec3(0.7), 0.25, roughness}, kNormal, v, l);
                EXPECT_NEAR(value.diffuse.x, exact.diffuse.x, 1e-6) << roughness << ' ' << nl << ' ' << phi;
                EXPECT_NEAR(value.specular.x, exact.specular.x, 1e-5 * (1 + exact.specular.x)) << roughness << ' ' << nl << ' ' << phi;
            }
}

// The diffuse lobe in full; the specular one up to its gain, which is the viewer's alone.
TEST(Brdf, ReciprocalInViewAndLight)
{
    const BrdfSurface surface{vec3(0.7f, 0.2f, 0.1f), 0.0f, 0.4f};
    const vec3 v = directionAt(0.8, 0.3), l = directionAt(0.3, 2.0);
    const BrdfValue a = evaluateBrdf(surface, kNormal, v, l), b = evaluateBrdf(surface, kNormal, l, v);
    EXPECT_NEAR(a.diffuse.x, b.diffuse.x, 1e-6f);
    const auto gain = [&](double nv) { return 1.0 + 0.04 * (1.0 / whiteByQuadrature(nv, 0.16).x - 1.0); };
    EXPECT_NEAR(a.specular.x / gain(0.8), b.specular.x / gain(0.3), 1e-3 * a.specular.x);
}

// As much as the lobe about the mirrored direction, but back: brightest towards the viewer, and reciprocal but for the gain, as that is.
TEST(Brdf, ARetroreflectiveLobeLiesAboutTheViewerAndReflectsAsMuch)
{
    const vec3 view = directionAt(0.64, 0.3), light = directionAt(0.5, 0.9);
    for (const float roughness : {0.3f, 0.6f, 1.0f})
    {
        const BrdfSurface surface{vec3(0.9f), 1.0f, roughness};
        const auto retro = [&](vec3 v, vec3 l) { return evaluateBrdf(surface, kNormal, viewerOfLobes(kNormal, v, true), l); };
        const double mirrored = overHemisphere([&](vec3 l) { return double(evaluateBrdf(surface, kNormal, view, l).specular.x) * l.z; });
        EXPECT_NEAR(overHemisphere([&](vec3 l) { return double(retro(view, l).specular.x) * l.z; }), mirrored, 1e-3 * mirrored);
        const double alpha = double(roughness) * roughness;
        const auto gain = [&](double nv) { return 1.0 + 0.9 * (1.0 / whiteByQuadrature(nv, alpha).x - 1.0); };
        const double there = retro(view, light).specular.x / gain(0.64), back = retro(light, view).specular.x / gain(0.5);
        EXPECT_NEAR(there, back, 5e-3 * there) << roughness << ": the gain is of a table";
        EXPECT_NEAR(retro(view, view).specular.x, evaluateBrdf(surface, kNormal, view, viewerOfLobes(kNormal, view, true)).specular.x,
                    1e-4 * retro(view, view).specular.x);
    }
    EXPECT_EQ(viewerOfLobes(kNormal, view, false), view);
    const BrdfSurface coat{vec3(0.5f), 0.0f, 0.3f};
    EXPECT_NEAR(evaluateBrdf(coat, kNormal, viewerOfLobes(kNormal, view, true), light).diffuse.x,
                evaluateBrdf(coat, kNormal, view, light).diffuse.x, 1e-6f)
        << "what is below the coat is scattered to all sides";
}

TEST(Brdf, VisibleNormalSamplesAgreeWithQuadrature)
{
    for (float roughness : {0.35f, 0.6f, 1.0f})
        for (double nv : {0.1, 0.6, 1.0})
        {
            const BrdfSurface surface{vec3(0.9f), 1.0f, roughness};
            const float alpha = ggxAlpha(roughness);
            const vec3 view = directionAt(nv, 0.7);
            const double truth = overHemisphere([&](vec3 l) { return double(evaluateBrdf(surface, kNormal, view, l).specular.x) * l.z; });
            Random random(5, 1, 2);
            constexpr int kSamples = 100000;
            double sum = 0.0, squares = 0.0;
            for (int i = 0; i < kSamples; ++i)
            {
                const vec3 m = sampleVisibleNormal(view, alpha, random.uniform2());
                const vec3 l = 2.0f * glm::dot(view, m) * m - view;
                const float pdf = visibleNormalPdf(kNormal, view, l, alpha);
                const double x = pdf > 0.0f ? evaluateBrdf(surface, kNormal, view, l).specular.x * l.z / pdf : 0.0;
                sum += x, squares += x * x;
            }
            const double mean = sum / kSamples, sigma = std::sqrt((squares / kSamples - mean * mean) / kSamples);
            EXPECT_NEAR(mean, truth, 4.0 * sigma + 2e-3) << "roughness " << roughness << ", n.v " << nv;
        }
}

// Only directions below the horizon are missing from the density of the reflected directions.
TEST(Brdf, VisibleNormalDensityIntegratesToTheShareAboveTheHorizon)
{
    for (double nv : {0.2, 0.9})
    {
        const float alpha = 0.36f;
        const vec3 view = directionAt(nv, 0.0);
        const double truth = overHemisphere([&](vec3 l) { return double(visibleNormalPdf(kNormal, view, l, alpha)); });
        Random random(9, 0, 0);
        int above = 0;
        constexpr int kSamples = 100000;
        for (int i = 0; i < kSamples; ++i)
        {
            const vec3 m = sampleVisibleNormal(view, alpha, random.uniform2());
            above += (2.0f * glm::dot(view, m) * m - view).z > 0.0f;
        }
        EXPECT_NEAR(double(above) / kSamples, truth, 0.006) << nv;
    }
}

TEST(Brdf, SmoothestLobeStaysFinite)
{
    const BrdfSurface surface{vec3(1.0f), 1.0f, kMirrorRoughness};
    for (double nv : {1e-6, 1e-3, 0.5, 1.0})
    {
        const vec3 v = directionAt(nv, 0.0), mirrored(-v.x, -v.y, v.z);
        EXPECT_TRUE(std::isfinite(evaluateBrdf(surface, kNormal, v, mirrored).specular.x)) << nv;
        EXPECT_TRUE(std::isfinite(visibleNormalPdf(kNormal, v, mirrored, ggxAlpha(surface.roughness)))) << nv;
    }
    EXPECT_EQ(evaluateBrdf(surface, kNormal, kNormal, -kNormal).specular.x, 0.0f);
}

TEST(Brdf, TangentFramesAreOrthonormal)
{
    for (vec3 n : {vec3(0, 0, 1), vec3(0, 0, -1), glm::normalize(vec3(1, 2, -3)), glm::normalize(vec3(1e-4f, 0, -1))})
    {
        const TangentFrame f = tangentFrame(n);
        EXPECT_NEAR(glm::dot(f.tangent, f.bitangent), 0.0f, 1e-5f);
        EXPECT_NEAR(glm::dot(f.tangent, n), 0.0f, 1e-5f);
        EXPECT_NEAR(glm::length(glm::cross(f.tangent, f.bitangent) - n), 0.0f, 1e-5f);
    }
}

TEST(PunctualLight, FallsOffWithTheSquareAndEndsAtItsRange)
{
    EXPECT_FLOAT_EQ(distanceAttenuation(2.0f, 0.0f), 0.25f);
    EXPECT_FLOAT_EQ(distanceAttenuation(4.0f, 4.0f), 0.0f);
    EXPECT_FLOAT_EQ(distanceAttenuation(5.0f, 4.0f), 0.0f);
    EXPECT_FLOAT_EQ(spotAttenuation(1.0f, 0.2f, 0.5f), 1.0f);
    EXPECT_FLOAT_EQ(spotAttenuation(std::cos(0.51f), 0.2f, 0.5f), 0.0f);
}

} // namespace
} // namespace sconce
