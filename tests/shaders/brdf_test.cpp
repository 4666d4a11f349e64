#include "shaders/shared/brdf.h"

#include <cmath>
#include <numbers>

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

TEST(Brdf, RoughnessOneIsItsClosedForm)
{
    const BrdfSurface surface{vec3(0.7f), 0.25f, 1.0f};
    const test::RoughModel model{0.7, 0.25};
    for (double nl : {0.05, 0.4, 0.9})
        for (double nv : {0.1, 0.5, 1.0})
            for (double phi : {0.0, 1.0, 3.0})
            {
                const BrdfValue value = evaluateBrdf(surface, kNormal, directionAt(nv, 0.0), directionAt(nl, phi));
                const double vh = test::RoughModel::cosineToHalf(nl, nv, phi);
                EXPECT_NEAR(value.diffuse.x, model.diffuse(vh), 1e-5) << nl << ' ' << nv << ' ' << phi;
                EXPECT_NEAR(value.specular.x, model.specular(vh, nl, nv), 1e-5 * (1 + model.specular(vh, nl, nv)));
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

TEST(Brdf, ReciprocalInViewAndLight)
{
    const BrdfSurface surface{vec3(0.7f, 0.2f, 0.1f), 0.5f, 0.4f};
    const vec3 v = directionAt(0.8, 0.3), l = directionAt(0.3, 2.0);
    const BrdfValue a = evaluateBrdf(surface, kNormal, v, l), b = evaluateBrdf(surface, kNormal, l, v);
    EXPECT_NEAR(a.diffuse.x, b.diffuse.x, 1e-6f);
    EXPECT_NEAR(a.specular.x, b.specular.x, 1e-6f);
}

// A white metal can lose light between facets, never gain it (Heitz 2014: the single-scattering albedo is at most 1).
TEST(Brdf, WhiteFurnaceNeverGainsLight)
{
    for (float roughness : {0.3f, 0.5f, 0.8f, 1.0f})
        for (double nv : {0.05, 0.3, 0.7, 1.0})
        {
            const BrdfSurface surface{vec3(1.0f), 1.0f, roughness};
            const vec3 view = directionAt(nv, 0.0);
            const double albedo = overHemisphere([&](vec3 l) { return double(evaluateBrdf(surface, kNormal, view, l).specular.x) * l.z; });
            EXPECT_LE(albedo, 1.002) << "roughness " << roughness << ", n.v " << nv;
            // Seen straight on at alpha 1 the integral of nl / (1 + nl) is closed.
            if (roughness == 1.0f && nv == 1.0)
            {
                EXPECT_NEAR(albedo, 1.0 - std::numbers::ln2, 1e-4);
            }
        }
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
