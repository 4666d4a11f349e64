// Prefiltered radiance against integrals over the sphere, also where the octahedral map folds.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "runtime/bake/prefilter.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/brdf.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

/// A probe whose radiance is a function of direction.
template <class Light> FieldData probeOf(const Light& light, uint32_t chart = gpu::kChartCube)
{
    FieldData field;
    field.info.chart = chart;
    field.info.faceSize = 64;
    field.info.probeCount = 1;
    field.probes.resize(1);
    const int n = int(field.info.faceSize), faces = chart == gpu::kChartCube ? 6 : 1;
    for (int face = 0; face < faces; ++face)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
            {
                const vec2 uv = (vec2(x, y) + 0.5f) / float(n);
                const vec3 d =
                    faces == 6 ? Pure<float>::faceDirection(face, vec3(2.0f * uv - 1.0f, 1.0f)) : Pure<float>::directionFromOctahedral(uv);
                field.radiance.push_back(Pure<float>::packRadiance(light(glm::normalize(d))));
            }
    prefilterRadiance(field);
    return field;
}

/// The lobe's mean by a fine sum over the sphere.
template <class Light> glm::dvec3 bruteForce(const Light& light, vec3 axis, double width)
{
    glm::dvec3 sum(0.0);
    double weights = 0.0;
    constexpr int kRings = 400;
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < 2 * kRings; ++j)
        {
            const double theta = std::numbers::pi * (i + 0.5) / kRings, phi = std::numbers::pi * (j + 0.5) / kRings;
            const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            const double weight = std::sin(theta) * std::exp((glm::dot(d, glm::dvec3(axis)) - 1.0) / (width * width));
            sum += weight * glm::dvec3(light(vec3(d)));
            weights += weight;
        }
    return sum / weights;
}

vec3 halves(vec3 d) // three great circles, none along an axis: the hardest edges there are
{
    return {glm::dot(d, vec3(0.6f, 0.64f, 0.48f)) > 0.0f ? 4.0f : 0.0f, glm::dot(d, vec3(-0.8f, 0.36f, 0.48f)) > 0.0f ? 2.0f : 1.0f,
            glm::dot(d, vec3(0.0f, 0.6f, -0.8f)) > 0.0f ? 1.0f : 0.0f};
}

/// Directions at the octahedral map's border, corners and axes, and at random.
std::vector<vec3> hardDirections()
{
    std::vector<vec3> all = {{0, 0, -1}, {1e-3f, 1e-3f, -1}, {1, 0, -1e-3f}, {-1, 1e-4f, 0},
                             {0, 1, 0},  {1, 0, 0},          {0, -1, -1},    {1, 1, -1e-3f}};
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 24; ++i) all.emplace_back(normal(random), normal(random), -std::abs(normal(random)));
    for (vec3& d : all) d = glm::normalize(d);
    return all;
}

TEST(Prefilter, OneRadianceEverywhereStaysThatInEveryLobe)
{
    for (uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        const FieldData field = probeOf([](vec3) { return vec3(3.0f, 1.0f, 0.5f); }, chart);
        Text text(field, {});
        for (vec3 d : hardDirections())
            for (float width : {0.0f, 0.07f, 0.3f, 2.0f})
                EXPECT_LT(glm::distance(text.prefilteredRadiance(0, d, width), vec3(3.0f, 1.0f, 0.5f)), 0.03f);
    }
}

TEST(Prefilter, LobesAreIntegralsOverTheSphereAcrossTheMapsEdges)
{
    for (uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        const FieldData field = probeOf(halves, chart);
        Text text(field, {});
        for (const float width : {0.125f, 0.3125f, 0.78125f}) // of levels 1 to 3
        {
            double worst = 0.0;
            for (vec3 d : hardDirections())
                worst = std::max(worst, glm::distance(glm::dvec3(text.prefilteredRadiance(0, d, width)), bruteForce(halves, d, width)));
            EXPECT_LT(worst, 0.25) << "of lights up to 4; width " << width; // bilinear texels of about the lobe's width blur the edge
        }
    }
}

TEST(Prefilter, NoSeamWhereTheMapFolds)
{
    const FieldData field = probeOf(halves);
    Text text(field, {});
    for (int i = 0; i < 2000; ++i) // the fold is the equator z = 0
    {
        const float phi = 2.0f * std::numbers::pi_v<float> * float(i) / 2000.0f;
        const vec3 above(std::cos(phi), std::sin(phi), 1e-5f), below(std::cos(phi), std::sin(phi), -1e-5f);
        for (float width : {0.05f, 0.2f, 0.6f})
            EXPECT_LT(glm::distance(text.prefilteredRadiance(0, above, width), text.prefilteredRadiance(0, below, width)), 5e-3f);
    }
}

// A host's direction may be NaN, and so may one between places that are far apart.
TEST(Prefilter, LookUpsOfNumbersThatAreNoneStayInTheMap)
{
    const float nan = std::nanf(""), huge = INFINITY;
    for (const int n : {1, 2, 8, 16})
        for (const float u : {nan, huge, -huge, -1e30f, -0.5f, -0.0f, 0.0f, 0.5f, 1.0f, 1.5f, 1e30f})
            for (const float v : {nan, -huge, 0.25f, 1.0f, huge})
            {
                const auto taps = Text::octahedralTaps(vec2(u, v), n);
                for (int i = 0; i < 4; ++i) EXPECT_LT(taps.texel[i], uint32_t(n * n)) << u << " " << v << " of " << n;
                EXPECT_NEAR(taps.weight.x + taps.weight.y + taps.weight.z + taps.weight.w, 1.0f, 1e-6f) << u << " " << v;
            }
}

} // namespace
} // namespace sconce
