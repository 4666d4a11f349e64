// Scenes of any size and at any place, and the same scene said otherwise: turned, mirrored, reordered, doubled.
#include <sched.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"
#include "tests/support/cornell_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kRays = 10000;

/// A scene with its probes and rays, before any field is made of them.
struct Setting
{
    Scene scene = *makeBuiltinScene("cornell");
    std::vector<vec3> probes = kCornellProbes;
    std::vector<vec3> origins, directions;
    Setting()
    {
        const RayScene rays = std::move(*RayScene::create(scene));
        const RaySet set = *glossyRays(rays, scene.cameras, {}, {.count = kRays, .alphaLow = 0.1f, .alphaHigh = 0.3f, .seed = 4});
        origins = set.origins;
        directions = set.directions;
    }
    template <class Map> void mapPoints(const Map& map)
    {
        for (vec3& p : scene.positions) p = map(p);
        for (vec3& p : probes) p = map(p);
        for (vec3& p : origins) p = map(p);
    }
    template <class Map> void mapDirections(const Map& map)
    {
        for (vec3& d : scene.normals) d = map(d);
        for (vec3& d : directions) d = map(d);
    }
};

struct Answers
{
    std::vector<TracedRay> rays;
    TraceScore score;
};

Answers answersOf(const Setting& setting)
{
    const HardScene made(setting.scene, setting.probes, 64, 32);
    const RaySet set = raySetFrom(made.rays, setting.origins, setting.directions);
    Walk<float> walk(made.field, defaultQuality());
    Answers answers{walkAll(walk, set), {}};
    answers.score = scoreTraces(set, answers.rays);
    EXPECT_EQ(walk.limitReached + walk.notFinite, 0u);
    return answers;
}

const Answers& plain()
{
    static const Answers answers = answersOf(Setting());
    return answers;
}

/// Expects the same answers ray by ray, t times `scale`, but for a share of them, and the same share right.
/// @param tolerance  of t, metres before scaling, beside 1e-4 of it
void expectLikePlain(const std::string& name, const Answers& got, double share, double scale = 1.0, double tolerance = 1e-5,
                     double right = kHardlyAny)
{
    size_t different = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        const TracedRay &a = plain().rays[i], &b = got.rays[i];
        different += a.status != b.status || std::abs(double(a.t) * scale - b.t) > 1e-4 * scale * a.t + tolerance * scale;
    }
    expectAtMost(name + ": share answered otherwise", kRays, double(different) / kRays, share);
    expectAtMost(name + ": change of the share right", kRays, std::abs(got.score.right1 - plain().score.right1), right);
}

TEST(Scales, OneMillimetreToAHundredKilometres)
{
    for (const auto& [name, scale, share] : {std::tuple{"scene of 1 mm", 0.0005f, kHardlyAny}, {"scene of 100 km", 50000.0f, 0.0006}})
    {
        Setting setting;
        setting.mapPoints([&](vec3 p) { return scale * p; });
        expectLikePlain(name, answersOf(setting), share, double(scale), 0.007); // maps round otherwise: 0.2 % of the diagonal
    }
}

TEST(Scales, PowersOfTwoChangeNoBit)
{
    Setting setting;
    const HardScene made(setting.scene, setting.probes, 64, 32);
    twin::LightFieldTwin<float> text(made.field, defaultQuality());
    size_t different = 0;
    for (const float scale : {0x1p-20f, 0x1p-3f, 0x1p17f})
    {
        Bounds bounds;
        bounds.add(scale * made.scene.bounds().low);
        bounds.add(scale * made.scene.bounds().high);
        const gpu::LightFieldInfo space = fieldSpace(bounds);
        FieldData scaled = made.field;
        EXPECT_EQ(space.sceneLow, scaled.info.sceneLow);
        EXPECT_EQ(space.sceneHigh, scaled.info.sceneHigh);
        EXPECT_EQ(space.diagonal, scaled.info.diagonal);
        EXPECT_EQ(space.origin, scale * scaled.info.origin);
        scaled.info.origin = space.origin;
        scaled.info.scale = space.scale;
        twin::LightFieldTwin<float> other(scaled, defaultQuality());
        for (uint32_t i = 0; i < kRays; ++i)
        {
            const gpu::RayHit a = text.queryRay(setting.origins[i], setting.directions[i]);
            const gpu::RayHit b = other.queryRay(scale * setting.origins[i], setting.directions[i]);
            different += a.status != b.status || a.t * scale != b.t || a.position * scale != b.position || a.normal != b.normal ||
                         a.distanceReads != b.distanceReads;
        }
    }
    expectAtMost("scale by 2^-20, 2^-3, 2^17: rays with another bit", size_t(3) * kRays, double(different), 0.0);
}

TEST(Scales, AMillionMetresFromTheOrigin)
{
    // Single precision has a grain of 6 cm there: the box's corners and the rays' origins are multiples of it, so that all of it is exact.
    const vec3 away(1e6f, -1e6f, 1e6f);
    const auto grain = [](vec3 p) { return glm::round(p * 16.0f) / 16.0f; };
    std::vector<vec3> probes = {vec3(2.0f, -4.0f, 1.0f), vec3(-6.0f, 2.0f, -2.0f)};
    const HardScene near(closedBox(16.0f), probes, 128);
    for (vec3& p : probes) p += away;
    const HardScene far(closedBox(16.0f, away), probes, 128);
    Walk<float> nearWalk(near.field, defaultQuality()), farWalk(far.field, defaultQuality());
    size_t off = 0, miss = 0, different = 0;
    for (uint32_t i = 0; i < kRays; ++i)
    {
        Random random(6, 0, i);
        const vec3 o = grain(pointIn(random, -15.5f * kBoxHalf, 15.5f * kBoxHalf)), d = unitVector(random);
        const TracedRay a = nearWalk.trace(o, d), b = farWalk.trace(o + away, d);
        miss += b.status == TraceStatus::miss;
        off += b.status == TraceStatus::hit && std::abs(b.t - boxExit(o, d, 16.0f * kBoxHalf)) > 0.01 * 32.0 * glm::length(kBoxHalf);
        different += a.status != b.status || std::abs(a.t - b.t) > 1e-4f * a.t;
    }
    expectAtMost("box of 32 m at 1e6 m: share that leaves it", kRays, double(miss) / kRays, 0.0);
    expectAtMost("box of 32 m at 1e6 m: share of hits off by over 1 %", kRays, double(off) / kRays, kHardlyAny);
    expectAtMost("box of 32 m at 1e6 m: share answered otherwise than at the origin", kRays, double(different) / kRays, kHardlyAny);
}

TEST(Scales, CentimetresAndAKilometreInOneScene)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t wall = mesh.material("wall", vec3(0.5f));
    mesh.quad({-500, -0.2f, 500}, {500, -0.2f, 500}, {500, -0.2f, -500}, {-500, -0.2f, -500}, wall);
    mesh.box({-490, 0, -490}, {-480, 50, -480}, wall);
    BlockSolid room;
    room.fill({-2.1f, -0.1f, -2.1f}, {2.1f, 2.6f, 2.1f}, wall);
    room.carve({-2, 0, -2}, {2, 2.5f, 2});
    room.addTo(mesh);
    mesh.box({-0.5f, 0.7f, -0.5f}, {0.5f, 0.72f, 0.5f}, wall); // a board of 2 cm with dice of 1 cm
    for (int i = 0; i < 20; ++i) mesh.box({-0.45f + 0.045f * float(i), 0.72f, -0.1f}, {-0.44f + 0.045f * float(i), 0.73f, -0.09f}, wall);
    const std::vector<vec3> probes = {vec3(1.2f, 1.5f, 0.9f), vec3(-1.3f, 1.3f, -0.8f), vec3(0.1f, 0.35f, 0.1f), vec3(-0.2f, 1.0f, 0.1f)};
    const HardScene mixed(std::move(scene), probes, 128);
    std::vector<vec3> origins, directions;
    for (uint32_t i = 0; i < kRays; ++i)
    {
        Random random(6, 1, i);
        origins.push_back(pointIn(random, {-1.9f, 0.8f, -1.9f}, {1.9f, 2.4f, 1.9f}));
        directions.push_back(unitVector(random));
    }
    RaySet set = raySetFrom(mixed.rays, origins, directions);
    set.diagonal = glm::length(vec3(4.0f, 2.5f, 4.0f)); // judged by the room, not by the kilometre
    Walk<float> walk(mixed.field, defaultQuality());
    const TraceScore score = scoreTraces(set, walkAll(walk, set));
    expectAtMost("room with dice of 1 cm on 1 km of ground: leaks", kRays, score.leak, kHardlyAny);
    expectAtMost("room with dice of 1 cm on 1 km of ground: false hits", kRays, score.falseHit, 0.0006);
    expectAtMost("room with dice of 1 cm on 1 km of ground: unknown", kRays, score.unresolved, kHardlyAny);
}

TEST(Metamorphic, TranslationQuarterTurnAndMirror)
{
    Setting moved;
    moved.mapPoints([](vec3 p) { return p + vec3(37.0f, -12.5f, 8.25f); });
    expectLikePlain("moved by (37, -12.5, 8.25) m", answersOf(moved), kHardlyAny);

    Setting turned;
    const auto quarter = [](vec3 p) { return vec3(p.z, p.y, -p.x); };
    turned.mapPoints(quarter);
    turned.mapDirections(quarter);
    // the octree's cells start at the low corner of the bounds, and their lists are sampled: they don't turn with the scene
    expectLikePlain("turned by 90 degrees", answersOf(turned), 0.006, 1.0, 1e-5, 0.005);

    Setting mirrored;
    const auto mirror = [](vec3 p) { return vec3(-p.x, p.y, p.z); };
    mirrored.mapPoints(mirror);
    mirrored.mapDirections(mirror);
    for (uvec3& triangle : mirrored.scene.triangles) std::swap(triangle.y, triangle.z);
    expectLikePlain("mirrored", answersOf(mirrored), 0.0014, 1.0, 1e-5, 0.0008);
}

TEST(Metamorphic, OrderOfVerticesTrianglesAndProbesAndProbesTwice)
{
    Setting shuffled;
    Random random(7, 0, 0);
    for (size_t i = shuffled.scene.triangles.size(); i > 1; --i)
    {
        const size_t j = random.below(uint32_t(i));
        std::swap(shuffled.scene.triangles[i - 1], shuffled.scene.triangles[j]);
        std::swap(shuffled.scene.triangleMaterial[i - 1], shuffled.scene.triangleMaterial[j]);
    }
    for (uvec3& t : shuffled.scene.triangles) t = uvec3(t.y, t.z, t.x);
    expectLikePlain("vertices and triangles in another order", answersOf(shuffled), kHardlyAny);

    Setting reversed;
    std::ranges::reverse(reversed.probes);
    expectLikePlain("probes in another order", answersOf(reversed), kHardlyAny);

    Setting doubled;
    doubled.probes.push_back(doubled.probes[2]);
    expectLikePlain("a probe twice", answersOf(doubled), kHardlyAny);
}

TEST(Metamorphic, SameFieldOnOneThreadAndMany)
{
    const Setting setting;
    const HardScene many(setting.scene, setting.probes, 64, 32);
    cpu_set_t before, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
        if (CPU_ISSET(cpu, &before))
        {
            CPU_SET(cpu, &one);
            break;
        }
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
    const HardScene single(setting.scene, setting.probes, 64, 32);
    ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
    EXPECT_EQ(many.field.octree.texels, single.field.octree.texels);
    EXPECT_EQ(many.field.distance, single.field.distance);
}

} // namespace
} // namespace sconce
