// How the irradiance of several probes is weighed, measured beside the weights of others: light that surfaces reflect onto a point, against
// paths traced from it. One truth, one bake and the same probes for all; on a grid the others' own eight corners, too.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "bench/reference/path_tracer.h"
#include "placement/place.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using Text = twin::LightFieldTwin<float>;

/// What a surface of the picture gets from other surfaces.
struct Sample
{
    vec3 position, normal, view, truth; // world; cosine-weighted mean radiance without emission and sky
};

constexpr int kPaths = 144; // a point

std::vector<Sample> samplesOf(const Scene& scene)
{
    const RayScene rays = std::move(*RayScene::create(scene));
    const PathTracer paths(rays, {}, 1); // three scatterings at most after the point: those of two bounces
    const Camera& camera = scene.cameras.front();
    const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up)), up = glm::cross(right, camera.forward);
    constexpr int kWidth = 24, kHeight = 18;
    std::vector<Sample> samples;
    for (int i = 0; i < kWidth * kHeight; ++i)
    {
        const float tangent = std::tan(0.5f * camera.verticalFov);
        const vec2 at = (vec2(i % kWidth, i / kWidth) + 0.5f) / vec2(kWidth, kHeight) * 2.0f - 1.0f;
        const vec3 direction = glm::normalize(camera.forward + tangent * (4.0f / 3.0f * at.x * right - at.y * up));
        const auto hit = rays.closest(camera.eye, direction);
        if (!hit) continue;
        const ShadingPoint point = paths.shade(*hit, -direction);
        if (point.surface.metallic > 0.5f || point.surface.baseColor == vec3(0.0f)) continue; // has no diffuse light
        samples.push_back({point.position, point.normal, -direction, vec3(0.0f)});
    }
    parallelFor(samples.size(),
                [&](size_t i)
                {
                    Sample& sample = samples[i];
                    const TangentFrame frame = tangentFrame(sample.normal);
                    const vec3 start = sample.position + rays.offset() * sample.normal;
                    for (int k = 0; k < kPaths; ++k)
                    {
                        Random random(7, i, uint64_t(k));
                        const vec2 u = (vec2(k % 12, k / 12) + random.uniform2()) / 12.0f;
                        const vec3 direction = glm::normalize(toWorld(frame, sampleCosine(u)));
                        const auto hit = rays.closest(start, direction);
                        if (!hit) continue;
                        const PathLight light = paths.trace(start, direction, random);
                        sample.truth += light.direct - paths.shade(*hit, -direction).emission + light.diffuse + light.glossy;
                    }
                    sample.truth /= float(kPaths);
                });
    return samples;
}

/// Probes that a point asks, each with the weight of its place (1, or its share of the grid's cell).
struct Asked
{
    uint32_t probe;
    float share;
};

std::vector<Asked> rankedOf(Text& text, vec3 point, vec3 normal)
{
    int reads = 0;
    const auto ranked = text.rankedProbesAt(point + 0.5f * text.field.voxel * normal, reads);
    std::vector<Asked> asked;
    for (int k = 0; k < gpu::kRanked; ++k)
    {
        const bool repeated = std::ranges::any_of(asked, [&](const Asked& a) { return a.probe == ranked[k]; });
        const vec3 to = text.source.probes[ranked[k]].centre - point;
        if (!repeated) asked.push_back({ranked[k], 1.0f / (glm::dot(to, to) + text.field.voxel * text.field.voxel)}); // as we do
    }
    return asked;
}

std::vector<Asked> cornersOf(const gpu::LightFieldInfo& info, vec3 point)
{
    const glm::ivec3 count(info.gridX, info.gridY, info.gridZ);
    const vec3 at = glm::clamp((point - info.gridOrigin) / info.gridStep, vec3(0.0f), vec3(count - 1));
    const glm::ivec3 low = glm::min(glm::ivec3(at), glm::max(count - 2, glm::ivec3(0)));
    const vec3 f = at - vec3(low);
    std::vector<Asked> asked;
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::ivec3 upper(corner & 1, (corner >> 1) & 1, corner >> 2), p = glm::min(low + upper, count - 1);
        const vec3 share = glm::mix(vec3(1.0f) - f, f, vec3(upper));
        asked.push_back({uint32_t(p.x + count.x * (p.y + count.y * p.z)), share.x * share.y * share.z});
    }
    return asked;
}

float chebyshev(Text& text, uint32_t probe, vec3 direction, float distance)
{
    const vec2 moments = text.probeMoments(probe, direction);
    if (distance <= moments.x) return 1.0f;
    const float beyond = distance - moments.x, variance = std::max(moments.y, 0.0f);
    return variance / std::max(variance + beyond * beyond, 1e-12f);
}

/// McGuire et al. 2017, "Real-Time Global Illumination using Precomputed Light Field Probes": cosine, and Chebyshev's bound as it is.
vec3 weighed2017(Text& text, const Sample& sample, vec3 point, std::span<const Asked> asked)
{
    vec3 sum(0.0f);
    float weights = 0.0f;
    for (const auto& [probe, share] : asked)
    {
        const vec3 to = text.source.probes[probe].centre - point;
        const float distance = glm::length(to);
        float weight = std::max(0.05f, glm::dot(to / distance, sample.normal));
        weight = std::max(0.0002f, weight * chebyshev(text, probe, -to / distance, distance)) * share;
        sum += weight * text.probeIrradiance(probe, sample.normal);
        weights += weight;
    }
    return sum / std::max(weights, 1e-20f);
}

/// RTXGI 1.3 (Majercik et al. 2019 and after): biased point, wrapped cosine, Chebyshev cubed with a floor, small weights crushed, blended
/// as square roots. The bias, which is the scene's own choice there, is 0.2 % of the diagonal along the normal and as much along the view.
vec3 weighedRtxgi(Text& text, const Sample& sample, vec3 point, std::span<const Asked> asked)
{
    vec3 sum(0.0f);
    float weights = 0.0f;
    const vec3 biased = point + 0.002f * text.field.diagonal * (sample.normal + sample.view);
    for (const auto& [probe, share] : asked)
    {
        const vec3 centre = text.source.probes[probe].centre;
        const vec3 to = centre - biased;
        const float distance = glm::length(to), wrap = 0.5f * glm::dot(glm::normalize(centre - point), sample.normal) + 0.5f;
        float weight = wrap * wrap + 0.2f;
        const float seen = chebyshev(text, probe, -to / distance, distance);
        weight *= std::max(0.05f, seen * seen * seen);
        weight = std::max(1e-6f, weight);
        if (weight < 0.2f) weight *= weight * weight / 0.04f;
        weight *= std::max(0.001f, share);
        sum += weight * glm::sqrt(text.probeIrradiance(probe, sample.normal));
        weights += weight;
    }
    sum /= std::max(weights, 1e-20f);
    return sum * sum;
}

/// The probes' patches instead of their irradiance, by our weights.
vec3 byPatches(Text& text, const Sample& sample, vec3 point, std::span<const Asked> asked)
{
    vec3 sum(0.0f);
    float weights = 0.0f;
    for (const auto& [probe, share] : asked)
    {
        const float weight = text.weightOfProbe(probe, point, sample.normal);
        sum += weight * text.patchIrradiance(probe, point - vec3(text.source.probes[probe].centre), sample.normal);
        weights += weight;
    }
    return sum / std::max(weights, 1e-20f);
}

/// Mean of the squared error over the squared truth, as compare's relmse; the darkest are lifted: by 5 % of the mean's square.
double relMse(std::span<const Sample> samples, const std::function<vec3(const Sample&)>& weighed)
{
    double mean = 0.0, sum = 0.0;
    for (const Sample& sample : samples) mean += (sample.truth.x + sample.truth.y + sample.truth.z) / 3.0;
    mean /= double(samples.size());
    for (const Sample& sample : samples)
        for (int c = 0; c < 3; ++c)
        {
            const double asked = sample.truth[c], error = double(weighed(sample)[c]) - asked;
            sum += error * error / (asked * asked + 0.05 * mean * mean);
        }
    return sum / (3.0 * double(samples.size()));
}

class IrradianceWeightsTest : public FrameTest
{
};

TEST_F(IrradianceWeightsTest, OursStayBesideThoseOf2017AndOfRtxgi)
{
    std::printf("| scene | probes | ours | 2017 | RTXGI | ours, by patches |\n|---|---|---|---|---|---|\n");
    std::array<double, 4> all{};
    for (const auto& [name, count] : {std::pair{"cornell", 8u}, {"temple", 16u}, {"hall", 24u}})
    {
        const Scene scene = *makeBuiltinScene(name);
        const std::vector<Sample> samples = samplesOf(scene);
        for (const bool onGrid : {false, true})
        {
            PlaceSettings place;
            place.count = count;
            place.method = onGrid ? PlaceSettings::Method::grid : PlaceSettings::Method::sdf;
            place.voxels = 1u << 15;
            place.candidates = 300;
            place.surfels = place.refineSurfels = 4000;
            place.refineRounds = 1;
            PlaceReport placed;
            const Result<ProbeSet> set = placeProbes(scene, place, placed);
            ASSERT_TRUE(set) << set.error().message;
            std::vector<vec3> positions;
            for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
            BakeSettings bake;
            bake.resolution = 64;
            bake.bounces = 2;
            bake.prefiltered = false;
            bake.grid = set->grid;
            bake.surfaceTexels = 0; // irradiance and patches are what is judged
            bake.octree.voxels = 64;
            bake.scene.light = {.emitterSamples = 24, .skySamples = 32, .emitterShadow = 128, .skyShadow = 512};
            BakeReport report;
            const auto field = bakeLightField(gpu(), scene, positions, bake, {}, report);
            ASSERT_TRUE(field) << field.error().message;
            Text text(*field, {});
            const auto fieldPoint = [&](const Sample& sample) { return (sample.position - field->info.origin) / field->info.scale; };
            const auto asked = [&](const Sample& sample)
            {
                const vec3 point = fieldPoint(sample);
                return onGrid ? cornersOf(field->info, point) : rankedOf(text, point, sample.normal);
            };
            const std::array<double, 4> errors = {
                relMse(samples,
                       [&](const Sample& sample)
                       {
                           int reads = 0;
                           const vec3 point = fieldPoint(sample);
                           return text.irradianceAt(point, sample.normal, point + 0.5f * field->info.voxel * sample.normal, reads);
                       }),
                relMse(samples, [&](const Sample& sample) { return weighed2017(text, sample, fieldPoint(sample), asked(sample)); }),
                relMse(samples, [&](const Sample& sample) { return weighedRtxgi(text, sample, fieldPoint(sample), asked(sample)); }),
                relMse(samples, [&](const Sample& sample) { return byPatches(text, sample, fieldPoint(sample), asked(sample)); })};
            std::printf("| %s | %zu%s | %.4f | %.4f | %.4f | %.4f |\n", name, positions.size(), onGrid ? ", grid" : "", errors[0],
                        errors[1], errors[2], errors[3]);
            if (!onGrid)
                for (size_t i = 0; i < 4; ++i) all[i] += std::log(errors[i]) / 3.0;
        }
    }
    // In pictures nothing is left of these differences (docs/light.md): it is where probes stand and what they hold that errs.
    // SHORT: not worse is aimed at. Found: 1.056 and 1.123 times their errors, most of it in the box of 2 m whose lamp a probe stands
    // above; patches 0.70 times the best. By rays of processors without AVX2 the eight probes of the box stand a little elsewhere: 1.117.
    EXPECT_LT(all[0], all[1] + std::log(1.08)) << "on placed probes, geometric mean of three scenes";
    EXPECT_LT(all[0], all[2] + std::log(1.15));
    EXPECT_LT(all[3], std::min({all[0], all[1], all[2]}) + std::log(0.75)) << "patches are right about what is near";
}

} // namespace
} // namespace sconce
