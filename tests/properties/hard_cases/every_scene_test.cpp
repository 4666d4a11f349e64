// What must hold wherever rays are traced, in every kind of scene: the box of a room, columns, sheets without thickness, streets with
// rooms, and a real building. 10,000 rays a row.
#include <array>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "runtime/bake/patches.h"
#include "runtime/field/field_space.h"
#include "runtime/field/light_field.h"
#include "svo/build_octree.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kRays = 10000;

class EveryScene : public DeviceTest, public testing::WithParamInterface<const char*>
{
protected:
    void SetUp() override
    {
        made = hardScene(GetParam());
        if (!made) GTEST_SKIP() << "the scene " << GetParam() << " is missing; set SCONCE_SCENES";
        bounds = made->scene.bounds();
        glossy = glossyRaysOf(*made, kRays);
    }

    /// Any point of the scene's bounds, enlarged, and any direction: along axes, in planes of two axes, grazing, any.
    std::pair<vec3, vec3> anyRay(uint64_t stream, size_t i) const
    {
        Random random(20, stream, i);
        vec3 d = unitVector(random);
        if (i % 4 == 1) d[int(i / 4 % 3)] = 0.0f;
        if (i % 4 == 2) d *= vec3(1.0f, 1e-6f, i & 4 ? 1e-7f : 1.0f);
        if (i % 4 == 3) d = vec3(0.0f), d[int(i / 4 % 3)] = i & 4 ? 1.0f : -1.0f;
        return {pointIn(random, bounds.low - 0.1f * bounds.size(), bounds.high + 0.1f * bounds.size()), glm::normalize(d)};
    }

    static bool differ(const TracedRay& a, const TracedRay& b) { return a.status != b.status || a.t != b.t || a.handoffs != b.handoffs; }
    /// Of this scene, where more than hardly any ray was found: at most twice as many.
    static double bound(std::initializer_list<std::pair<std::string_view, double>> found)
    {
        for (const auto& [scene, most] : found)
            if (scene == GetParam()) return most;
        return kHardlyAny;
    }
    std::string row(const char* what) const { return std::string(GetParam()) + ": " + what; }

    std::unique_ptr<HardScene> made;
    Bounds bounds; // of `made`'s scene
    RaySet glossy;
};

TEST_P(EveryScene, RaysEndAndDependOnNoLevelNorSignOfZero)
{
    const gpu::TraceQuality quality = defaultQuality();
    Walk<float> walk(made->field, quality);
    const auto answers = [&](Walk<float>& tracer)
    {
        auto all = walkAll(tracer, glossy);
        for (size_t i = 0; i < kRays; ++i) all.push_back(std::apply([&](vec3 o, vec3 d) { return tracer.trace(o, d); }, anyRay(5, i)));
        return all;
    };
    const auto expected = answers(walk);
    size_t levels = 0;
    for (int coarsest : {0, 2, 4})
    {
        gpu::TraceQuality other = quality;
        other.coarsestLevel = coarsest;
        other.startLevel = std::min(other.startLevel, coarsest);
        Walk<float> again(made->field, other);
        const auto got = answers(again);
        size_t different = 0;
        for (size_t i = 0; i < got.size(); ++i) different += differ(expected[i], got[i]);
        levels = std::max(levels, different);
    }
    expectAtMost(row("coarsest level 0, 2, 4: rays with another status, hand-off or bit of t"), expected.size(), double(levels), 0.0);

    // What the cap on hand-offs takes: a ray that reaches it ends UNKNOWN, and would go on.
    gpu::TraceQuality patient = quality;
    patient.maxHandoffs = knobs::maxHandoffs.most;
    Walk<float> uncapped(made->field, patient);
    const auto more = answers(uncapped);
    size_t cut = 0;
    for (size_t i = 0; i < more.size(); ++i) cut += differ(expected[i], more[i]);
    expectAtMost(row("share answered otherwise without a cap on hand-offs"), more.size(), double(cut) / double(more.size()),
                 bound({{"town", 0.0004}, {"sponza", 0.0007}}));

    size_t signs = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        const auto [o, d] = anyRay(0, i);
        vec3 turned = d;
        for (int a = 0; a < 3; ++a)
            if (turned[a] == 0.0f) turned[a] = -turned[a];
        const TracedRay a = walk.trace(o, d), b = walk.trace(o, turned);
        signs += a.status != b.status || a.t != b.t || a.distanceReads != b.distanceReads;
    }
    expectAtMost(row("any ray, inside and outside, -0 in place of 0: answered otherwise"), kRays, double(signs), 0.0);

    const gpu::LightFieldInfo& info = made->field.info;
    for (size_t i = 0; i < kRays; ++i) // from the borders of octree cells
    {
        Random random(20, 1, i);
        vec3 o;
        for (int a = 0; a < 3; ++a)
        {
            const auto cells = uint32_t((info.boundsHigh[a] - info.boundsLow[a]) / info.voxel);
            o[a] = (info.boundsLow[a] + float(random.below(cells + 1)) * info.voxel) * info.scale + info.origin[a];
        }
        walk.trace(o, anyRay(1, i).second);
    }
    expectAtMost(row("rays stopped by the limit of turns"), walk.rays, double(walk.limitReached), 0.0);
    expectAtMost(row("turns, share of the derived limit"), walk.rays, walk.worstTurns, 0.006); // beyond 1 it would be stopped
    expectAtMost(row("times t falls outside a second opinion"), walk.rays, double(walk.fallsOutsideOpinions), 0.0);
    expectAtMost(row("numbers that are not finite"), walk.rays, double(walk.notFinite), 0.0);
}

TEST_P(EveryScene, OddNumbersGiveFiniteAnswers)
{
    twin::LightFieldTwin<float> text(made->field, defaultQuality());
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::array<float, 14> odd = {0.0f, -0.0f, 1.0f, -1.0f, NAN, inf, -inf, 1e-40f, -1e-40f, 1e30f, 3e38f, 1e-20f, 0.5f, 1e9f};
    size_t bad = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(20, 2, i);
        auto [o, d] = anyRay(2, i);
        for (int a = 0; a < 3; ++a)
        {
            if (random.below(3) == 0) o[a] = odd[random.below(uint32_t(odd.size()))];
            if (random.below(3) == 0) d[a] = odd[random.below(uint32_t(odd.size()))];
        }
        const auto hit = text.queryRay(o, d);
        for (const float value : {hit.t, hit.position.x, hit.position.y, hit.position.z, hit.normal.x, hit.normal.y, hit.normal.z,
                                  hit.radiance.x, hit.radiance.y, hit.radiance.z, hit.confidence})
            bad += !std::isfinite(value);
        bad += hit.t < 0.0f;
    }
    expectAtMost(row("odd numbers in origin and direction: answers that are not finite"), kRays, double(bad), 0.0);
}

TEST_P(EveryScene, DeepAndShallowOctreesGiveTheSameAnswers)
{
    Walk<float> walk(made->field, defaultQuality());
    const double right = scoreTraces(glossy, walkAll(walk, glossy)).right1;
    double worst = 0.0;
    size_t limits = 0;
    for (const auto& [voxels, topShift] : {std::pair{32, 1}, {32, 5}, {64, 6}})
    {
        FieldData field = made->field;
        attachOctree(field, *buildOctree({field.info, field.probes, field.distance}, {.voxels = voxels, .topShift = topShift}));
        Walk<float> other(field, defaultQuality());
        worst = std::max(worst, right - scoreTraces(glossy, walkAll(other, glossy)).right1);
        limits += other.limitReached + other.notFinite;
    }
    expectAtMost(row("octrees of 1, 5 and 6 levels: loss of the share right"), 3 * kRays, worst,
                 bound({{"temple", 0.001}, {"curtains", 0.001}, {"town", 0.0008}}));
    expectAtMost(row("octrees of 1, 5 and 6 levels: rays stopped by the limit, or not finite"), 3 * kRays, double(limits), 0.0);
}

/// From surfaces to one another, and out of the scene, where nothing is within 0.5 % of the diagonal before the light.
TEST_P(EveryScene, ShadowRaysAgreeWithEmbree)
{
    twin::LightFieldTwin<float> text(made->field, defaultQuality());
    const float diagonal = bounds.diagonal();
    for (const bool outside : {false, true})
    {
        size_t asked = 0, lit = 0, dark = 0;
        for (size_t i = 0; i < kRays; ++i)
        {
            Random random(20, 6 + outside, i);
            const RayTruth& end = glossy.truth[random.below(kRays)];
            const vec3 side = glossy.normals[i], point = glossy.origins[i];
            vec3 direction = unitVector(random);
            float far = 1e30f;
            if (!outside)
            {
                far = glm::distance(point, end.position);
                direction = (end.position - point) / far;
            }
            if ((!outside && !end.hit) || !(glm::dot(direction, side) > 0.05f) || far < 0.05f * diagonal) continue;
            ++asked;
            const bool free = !made->rays.occluded(point, direction, outside ? far : far - 0.005f * diagonal);
            const bool reaches = text.lightReaches(point, direction, far, side);
            lit += reaches && !free;
            dark += !reaches && free;
        }
        ASSERT_GT(asked, kRays / 4);
        // Of maps of 64 texels a face (curtains 128): what stands within a texel of the light hides it.
        const std::string to = outside ? "shadow rays to the sky: share " : "shadow rays between surfaces: share ";
        expectAtMost(row((to + "wrongly lit").c_str()), asked, double(lit) / double(asked),
                     outside ? bound({{"cornell", 0.003}, {"temple", 0.005}, {"town", 0.014}, {"sponza", 0.004}})
                             : bound({{"cornell", 0.015}, {"temple", 0.005}, {"curtains", 0.004}, {"town", 0.02}, {"sponza", 0.07}}));
        expectAtMost(row((to + "wrongly dark").c_str()), asked, double(dark) / double(asked),
                     outside ? bound({{"temple", 0.006}, {"town", 0.011}, {"sponza", 0.005}})
                             : bound({{"cornell", 0.07}, {"temple", 0.03}, {"curtains", 0.006}, {"town", 0.04}, {"sponza", 0.045}}));
    }
}

/// Whether a float look-up is off by over 1e-3 from double in some channel.
bool differs(vec3 a, glm::dvec3 b)
{
    for (int c = 0; c < 3; ++c)
        if (!(std::abs(double(a[c]) - b[c]) <= 1e-3 * std::abs(b[c]))) return true;
    return false;
}

/// Light of many sizes in every texel of irradiance, from a seed: what a float look-up makes of it is compared with double.
TEST_P(EveryScene, LightLookedUpInFloatIsThatInDouble)
{
    FieldData& field = made->field;
    twin::LightFieldTwin<float> text(field, defaultQuality());
    field.irradiance.resize(field.probes.size() * kIrradianceWordsPerProbe);
    for (size_t i = 0; i < field.irradiance.size(); i += 2)
    {
        Random random(20, 3, i);
        field.irradiance[i] = text.packRadiance(vec3(random.uniform(), 4.0f * random.uniform(), 0.1f + random.uniform()));
        const float mean = 0.4f * random.uniform();
        field.irradiance[i + 1] = glm::packHalf2x16(glm::vec2(mean, 0.1f * mean * mean));
    }
    field.radiance.assign(size_t(6) * field.info.faceSize * field.info.faceSize * field.probes.size(), 0);
    for (size_t i = 0; i < field.radiance.size(); ++i) field.radiance[i] = field.irradiance[2 * (i % (field.irradiance.size() / 2))];
    makePatches(field, std::vector<uint32_t>(field.radiance.size(), 1u), {});
    twin::LightFieldTwin<float> single(field, defaultQuality());
    twin::LightFieldTwin<double> oracle(field, defaultQuality());
    size_t other = 0, bad = 0, otherPatches = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        const vec3 point = (glossy.origins[i] - vec3(field.info.origin)) / field.info.scale, n = glossy.normals[i];
        const vec3 leaf = point + 0.5f * field.info.voxel * n;
        int reads = 0;
        const vec3 a = single.irradianceAt(point, n, leaf, reads);
        const glm::dvec3 b = oracle.irradianceAt(glm::dvec3(point), glm::dvec3(n), glm::dvec3(leaf), reads);
        bad += !std::isfinite(a.x + a.y + a.z);
        other += differs(a, b);
        const uint32_t probe = uint32_t(i % field.probes.size());
        const vec3 fromProbe = point - vec3(field.probes[probe].centre);
        const vec3 thrown = single.patchIrradiance(probe, fromProbe, n);
        bad += !std::isfinite(thrown.x + thrown.y + thrown.z);
        otherPatches += differs(thrown, oracle.patchIrradiance(probe, glm::dvec3(fromProbe), glm::dvec3(n)));
    }
    expectAtMost(row("irradiance in float: share off by over 1e-3 from double"), kRays, double(other) / kRays, kHardlyAny);
    expectAtMost(row("light of patches in float: share off by over 1e-3 from double"), kRays, double(otherPatches) / kRays, kHardlyAny);
    expectAtMost(row("irradiance in float: numbers that are not finite"), kRays, double(bad), 0.0);
}

TEST_P(EveryScene, DeviceAnswersLikeFloat)
{
    FieldData& field = made->field;
    field.irradiance.assign(size_t(field.info.probeCount) * kIrradianceWordsPerProbe, 0);
    auto device = makeLightField(gpu(), field);
    ASSERT_TRUE(device) << device.error().message;
    auto tracer = makeRayTracer(gpu(), *device);
    ASSERT_TRUE(tracer) << tracer.error().message;
    std::vector<gpu::Ray> rays(kRays);
    for (uint32_t i = 0; i < kRays; ++i)
    {
        rays[i] = {};
        rays[i].origin = glossy.origins[i];
        rays[i].direction = glossy.directions[i];
        if (i % 4 == 0) std::tie(rays[i].origin, rays[i].direction) = anyRay(4, i);
    }
    std::vector<gpu::RayHit> hits(kRays);
    ASSERT_TRUE(tracer->trace(rays, hits));
    twin::LightFieldTwin<float> text(field, defaultQuality());
    size_t integers = 0, far = 0;
    for (uint32_t i = 0; i < kRays; ++i)
    {
        const gpu::RayHit cpu = text.queryRay(rays[i].origin, rays[i].direction);
        const bool same = cpu.status == hits[i].status && cpu.probe == hits[i].probe && cpu.handoffs == hits[i].handoffs &&
                          cpu.distanceReads == hits[i].distanceReads && cpu.indexReads == hits[i].indexReads;
        integers += !same;
        far += same && std::abs(cpu.t - hits[i].t) > 2e-5f * cpu.t;
    }
    expectAtMost(row("device against float: share with another integer"), kRays, double(integers) / kRays, kHardlyAny, 0.0);
    expectAtMost(row("device against float: share with t off by over 2e-5"), kRays, double(far) / kRays, kHardlyAny, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::Values("cornell", "temple", "curtains", "town", "sponza"),
                         [](const auto& scene) { return std::string(scene.param); });

} // namespace
} // namespace sconce
