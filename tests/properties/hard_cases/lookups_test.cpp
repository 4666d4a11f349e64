// Light looked up with numbers that a bake should never write and a host should never ask with.
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "runtime/field/tracer_cpu.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr size_t kRays = 10000;
constexpr float kLight = 3.0f;
constexpr double kStep = 0x1p-22 / kLight; // between two floats about that light, relative; two and three of them were found

/// A closed box whose probes hold one light everywhere: whatever the weights are, their mean is that light.
struct UniformBox
{
    HardScene box{closedBox(), std::vector<vec3>{{0.0f, 0.25f, -0.125f}, {-0.4f, -0.3f, 0.2f}, {0.1f, -0.5f, -0.3f}}, 32};
    twin::LightFieldTwin<float> text{box.field, defaultQuality()};

    UniformBox() { setMoments(0.4f, 0.01f); }
    void setMoments(float mean, float variance)
    {
        const uint32_t light = text.packRadiance(vec3(kLight));
        const uint32_t moments = glm::packHalf2x16(glm::vec2(mean, variance));
        box.field.irradiance.resize(box.field.probes.size() * kIrradianceWordsPerProbe);
        for (size_t i = 0; i < box.field.irradiance.size(); i += 2)
        {
            box.field.irradiance[i] = light;
            box.field.irradiance[i + 1] = moments;
        }
    }
    /// From a point, moved off its surface as the look-up moves it, to a probe.
    vec3 toProbe(uint32_t probe, vec3 point, vec3 normal)
    {
        const vec3 to = vec3(box.field.probes[probe].centre) - point;
        return to - text.texelAngle() * glm::length(to) * normal;
    }
    /// Relative distance from the light of the worst channel; infinite when it is not a number.
    double error(vec3 point, vec3 normal)
    {
        int reads = 0;
        const vec3 got = text.irradianceAt(point, normal, point, reads);
        double worst = 0.0;
        for (int c = 0; c < 3; ++c)
            worst =
                std::isfinite(got[c]) ? std::max(worst, std::abs(double(got[c]) / kLight - 1.0)) : std::numeric_limits<double>::infinity();
        return worst;
    }
};

TEST(Lookups, ChebyshevWithoutAndWithNegativeVariance)
{
    UniformBox made;
    double worst = 0.0;
    size_t count = 0;
    for (const float mean : {0.0f, 1e-7f, 0.1f, 0.4f, 100.0f})
        for (const float variance : {0.0f, -0.0f, 6e-8f, -6e-8f, -1e-6f, -1e-4f, -0.01f, -0.25f, -65504.0f, 65504.0f})
        {
            made.setMoments(mean, variance);
            for (size_t i = 0; i < kRays / 20; ++i, ++count)
            {
                Random random(10, 0, i);
                worst = std::max(worst, made.error(pointIn(random, -kBoxHalf, kBoxHalf), unitVector(random)));
            }
        }
    expectAtMost("variance 0, negative and huge: error of a uniform light", count, worst, 4.0 * kStep);
}

TEST(Lookups, VarianceThatCancelsTheDistanceBeyondExactly)
{
    // variance = -(distance - mean)^2: the pole of Chebyshev's bound. Half floats, in which a field holds it, meet that exactly where the
    // distance beyond the mean has few bits: there a point is, along an axis from a probe, which the look-up takes to be just so far.
    UniformBox made;
    double worst = 0.0;
    size_t met = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(10, 1, i);
        const uint32_t probe = uint32_t(i % 3);
        const vec3 centre = made.box.field.probes[probe].centre;
        vec3 point = pointIn(random, -kBoxHalf, kBoxHalf) / made.box.field.info.scale, normal = unitVector(random);
        float mean = 0.125f, past = glm::length(made.toProbe(probe, point, normal)) - mean;
        if (i % 2)
        {
            mean = 0.0625f * float(1 + random.below(4));
            past = 0.0625f * float(1 + random.below(4));
            const int axis = int(i / 3 % 3);
            const float sign = random.below(2) ? 1.0f : -1.0f;
            normal = vec3(0.0f);
            normal[axis] = -sign; // towards the probe
            point = centre;
            point[axis] += sign * (mean + past) / (1.0f - made.text.texelAngle());
            for (int step = 0; step < 32 && glm::length(made.toProbe(probe, point, normal)) != mean + past; ++step)
            {
                const bool farther = glm::length(made.toProbe(probe, point, normal)) < mean + past;
                point[axis] = std::nextafter(point[axis], (farther ? sign : -sign) * 4.0f);
            }
        }
        made.setMoments(mean, -past * past);
        const vec3 to = made.toProbe(probe, point, normal);
        const float away = glm::length(to);
        const auto moments = made.text.probeMoments(probe, -to / away);
        met += away > moments.x && moments.y == -(away - moments.x) * (away - moments.x);
        worst = std::max(worst, made.error(point, normal));
    }
    EXPECT_GT(met, kRays / 8) << "look-ups at the very pole";
    expectAtMost("variance at Chebyshev's pole: error of a uniform light", kRays, worst, 6.0 * kStep);
}

TEST(Lookups, AllWeightsAsGoodAsZero)
{
    UniformBox made;
    made.setMoments(1e-4f, 0.0f); // nothing is visible beyond a hair
    double worst = 0.0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(10, 2, i);
        const float away = i % 2 ? 1.0f : std::exp2(float(i % 30)); // up to 2^29 m outside
        worst = std::max(worst, made.error(away * pointIn(random, -kBoxHalf, kBoxHalf), unitVector(random)));
    }
    expectAtMost("all weights as good as zero, points far outside: error of a uniform light", kRays, worst, 6.0 * kStep);
}

TEST(Lookups, PointsAtProbeCentres)
{
    UniformBox made;
    double worst = 0.0;
    size_t met = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(10, 3, i);
        const uint32_t probe = uint32_t(i % 3);
        const int axis = int(i / 3 % 3);
        vec3 point = made.box.field.probes[probe].centre, normal(0.0f);
        normal[axis] = i % 2 ? 1.0f : -1.0f;
        if (i % 4 == 0) normal = unitVector(random);
        if (i % 5 == 0) point[axis] = std::nextafter(point[axis], 4.0f); // beside it, by the least there is
        met += made.toProbe(probe, point, normal) == vec3(0.0f);
        worst = std::max(worst, made.error(point, normal));
    }
    EXPECT_GT(met, kRays / 2) << "look-ups at the very centre";
    expectAtMost("points at probe centres: error of a uniform light", kRays, worst, 6.0 * kStep);
}

TEST(Lookups, OddNumbersGiveFiniteLight)
{
    UniformBox made;
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::array<float, 12> odd = {0.0f, -0.0f, NAN, inf, -inf, 1e-40f, -1e-40f, 1e30f, -3e38f, 0.5f, 1e9f, 1e-30f};
    size_t bad = 0;
    for (size_t i = 0; i < 2 * kRays; ++i)
    {
        Random random(10, 4, i);
        std::array<float, 6> pick{};
        for (float& value : pick) value = odd[random.below(uint32_t(odd.size()))];
        vec3 point(pick[0], pick[1], pick[2]), normal(pick[3], pick[4], pick[5]);
        if (i % 3 == 1) normal = unitVector(random);
        if (i % 3 == 2) point = pointIn(random, -kBoxHalf, kBoxHalf);
        int reads = 0;
        const vec3 got = made.text.irradianceAt(point, normal, point, reads);
        bad += !std::isfinite(got.x + got.y + got.z) || got.x < 0.0f;
    }
    expectAtMost("irradiance at odd points and normals: numbers that are not finite", 2 * kRays, double(bad), 0.0);
}

TEST(Lookups, RadianceOfAnySizeIsStored)
{
    const FieldData none;
    twin::LightFieldTwin<float> text(none, {});
    constexpr float inf = std::numeric_limits<float>::infinity();
    size_t bad = 0;
    double worst = 0.0;
    for (const float value : {0.0f, -0.0f, -1.0f, -inf, NAN, inf, 1e6f, 3e38f, 64000.0f, 65504.0f, 65024.0f, 1e-40f})
    {
        const vec3 back = text.unpackRadiance(text.packRadiance(vec3(value)));
        for (int c = 0; c < 3; ++c)
            bad += !std::isfinite(back[c]) || back[c] < 0.0f || (value > 6e4f ? back[c] < 6e4f : !(value > 1e-5f) && back[c] != 0.0f);
    }
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(10, 5, i);
        const float value = std::exp2(-13.0f + 28.0f * random.uniform());
        const vec3 back = text.unpackRadiance(text.packRadiance(vec3(value)));
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(double(back[c] / value) - 1.0));
    }
    expectAtMost("black, negative, 1e6, NaN and Inf in R11G11B10F: wrong numbers", 36, double(bad), 0.0);
    expectAtMost("2^-13 to 2^15 in R11G11B10F: relative error", kRays, worst, 1.0 / 64.0 + 1e-3);
}

} // namespace
} // namespace sconce
