// Geometry and probes that nobody would place so on purpose.
#include <gtest/gtest.h>

#include "runtime/bake/probe_clearance.h"
#include "runtime/field/field_space.h"
#include "scene/mesh_builder.h"
#include "svo/build_octree.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"
#include "tests/support/divided_box.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr size_t kRays = 10000;
const std::vector<vec3> kGoodProbes = {vec3(0.125f, -0.25f, 0.0625f), vec3(-0.375f, 0.125f, -0.125f)};

/// Random rays in the closed box, by its closed form.
void expectBoxIsSeen(const std::string& name, const FieldData& field, double off, double unknown)
{
    Walk<float> walk(field, defaultQuality());
    size_t miss = 0, wrong = 0, unsure = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(8, 0, i);
        const vec3 o = pointIn(random, -0.95f * kBoxHalf, 0.95f * kBoxHalf), d = unitVector(random);
        const TracedRay got = walk.trace(o, d);
        miss += got.status == TraceStatus::miss;
        unsure += got.status == TraceStatus::unknown;
        wrong += got.status == TraceStatus::hit && !(std::abs(got.t - boxExit(o, d, kBoxHalf)) <= 0.01 * 2.0 * glm::length(kBoxHalf));
    }
    expectAtMost(name + ": share that leaves the closed box", kRays, double(miss) / kRays, 0.0);
    expectAtMost(name + ": share of hits off by over 1 %", kRays, double(wrong) / kRays, off);
    expectAtMost(name + ": share unknown", kRays, double(unsure) / kRays, unknown);
    expectAtMost(name + ": rays stopped by the limit, or not finite", kRays, double(walk.limitReached + walk.notFinite), 0.0);
}

TEST(DegenerateGeometry, CoplanarDuplicatesSliversAndTrianglesWithoutArea)
{
    Scene scene = closedBox();
    MeshBuilder mesh(scene);
    mesh.box(-kBoxHalf, kBoxHalf, 0); // every wall twice, wound alike
    for (size_t i = scene.triangles.size(); i-- > 0;)
    {
        const uvec3 t = scene.triangles[i];
        scene.triangles.emplace_back(t.x, t.z, t.y); // and the other way round
        scene.triangleMaterial.push_back(0);
    }
    for (int i = 0; i < 400; ++i) // slivers of 1e-7 m across the floor, and triangles that are lines and points
    {
        const float x = -0.9f + 0.0045f * float(i), y = -kBoxHalf.y;
        mesh.triangle({x, y, -0.5f}, {x + 1e-7f, y, -0.5f}, {x, y, 0.5f}, 0);
        mesh.triangle({x, y, 0.1f}, {x, y, 0.2f}, {x, y, 0.3f}, 0);
        mesh.triangle({x, y, 0.1f}, {x, y, 0.1f}, {x, y, 0.1f}, 0);
    }
    const HardScene box(std::move(scene), kGoodProbes, 128);
    expectBoxIsSeen("walls twice and turned, slivers, no area", box.field, kHardlyAny, kHardlyAny);
}

TEST(OddProbes, OnInAndBehindSurfaces)
{
    const struct
    {
        const char* name;
        vec3 probe;
    } cases[] = {{"probe exactly on a wall", {1.0f, 0.1f, 0.05f}},
                 {"probe exactly in a corner", {-1.0f, -0.75f, -0.5f}},
                 {"probe 1e-6 m before a wall", {0.999999f, 0.1f, 0.05f}},
                 {"probe 1e-6 m behind a wall", {1.000001f, 0.1f, 0.05f}},
                 {"probe outside", {2.5f, 0.3f, 0.1f}}};
    for (const auto& odd : cases)
    {
        std::vector<vec3> probes = kGoodProbes;
        probes.push_back(odd.probe);
        // As a bake does: a plane through a probe's centre lies in none of its texels, and rays would cross it unseen.
        const Scene scene = closedBox();
        const ClearedProbes cleared = clearedOfSurfaces(scene, probes, 2e-4f * glm::distance(scene.bounds().low, scene.bounds().high));
        EXPECT_EQ(cleared.tight, 0u);
        const HardScene box(closedBox(), cleared.positions, 128);
        expectBoxIsSeen(std::string("two good probes and a ") + odd.name, box.field, kHardlyAny, kHardlyAny);
    }
}

TEST(OddProbes, InSolid)
{
    Scene scene = closedBox();
    MeshBuilder mesh(scene);
    mesh.box({0.5f, -0.75f, -0.5f}, {1.0f, 0.75f, 0.5f}, 0); // fills one end
    std::vector<vec3> probes = {kGoodProbes[1], vec3(0.0f, 0.0f, 0.1f), vec3(0.75f, 0.0f, 0.0f)};
    const HardScene box(std::move(scene), probes, 128);
    Walk<float> walk(box.field, defaultQuality());
    size_t wrong = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(8, 1, i);
        const vec3 o = pointIn(random, -0.95f * kBoxHalf, {0.45f, 0.7f, 0.47f}), d = unitVector(random);
        const glm::dvec3 shift(0.25, 0.0, 0.0); // the free part reaches from -1 to 0.5
        const double truth = boxExit(glm::dvec3(o) + shift, d, {0.75, 0.75, 0.5});
        const TracedRay got = walk.trace(o, d);
        wrong += got.status != TraceStatus::hit || !(std::abs(got.t - truth) <= 0.01 * 2.0 * glm::length(kBoxHalf));
    }
    expectAtMost("a probe in solid beside two good ones: share wrong or unknown", kRays, double(wrong) / kRays, kHardlyAny);
}

TEST(OddProbes, AllInOneSpot)
{
    const HardScene box(closedBox(), std::vector<vec3>(16, kGoodProbes[0]), 128);
    expectBoxIsSeen("16 probes in one spot", box.field, 0.0004, kHardlyAny);
}

TEST(OddProbes, From1To65535)
{
    for (const uint32_t probes : {1u, 255u, 256u, 65535u})
    {
        FieldData field = dividedBox(8, probes);
        const size_t wordsPerFace = field.info.wordsPerProbe / 6;
        for (size_t face = 0; face < size_t(6) * probes; ++face) buildChain(field.distance.data() + face * wordsPerFace, 8);
        attachOctree(field, *buildOctree({field.info, field.probes, field.distance}, {.voxels = 16}));
        Walk<float> walk(field, defaultQuality());
        size_t crossed = 0, miss = 0;
        for (size_t i = 0; i < kRays; ++i)
        {
            Random random(9, probes, i);
            vec3 o = pointIn(random, vec3(-0.95f), vec3(0.95f));
            o.x = (probes == 1 || i % 2 ? -1.0f : 1.0f) * (0.1f + 0.85f * std::abs(o.x)); // a single probe sees the negative half
            const vec3 d = unitVector(random);
            const TracedRay got = walk.trace(o, d);
            const float x = o.x + got.t * d.x;
            miss += got.status == TraceStatus::miss;
            crossed += got.status == TraceStatus::hit && x * o.x < 0.0f && std::abs(x) > 0.1f;
        }
        const std::string name = std::to_string(probes) + " probes in a divided box, faces of 8";
        expectAtMost(name + ": share through the wall", kRays, double(crossed) / kRays, probes == 1 ? kHardlyAny : 0.006);
        expectAtMost(name + ": share that leaves", kRays, double(miss) / kRays, probes == 1 ? kHardlyAny : 0.008);
        expectAtMost(name + ": rays stopped by the limit, or not finite", kRays, double(walk.limitReached + walk.notFinite), 0.0);
    }
}

TEST(OddProbes, FacesOfAnySizeFrom32To1024)
{
    for (const uint32_t size : {32u, 60u, 100u, 324u, 1024u})
    {
        const HardScene box(closedBox(), std::vector<vec3>{kGoodProbes[0]}, size, 16);
        expectBoxIsSeen("faces of " + std::to_string(size) + " texels", box.field,
                        size == 32   ? 0.0012
                        : size == 60 ? 0.0006
                                     : kHardlyAny,
                        kHardlyAny);
    }
}

} // namespace
} // namespace sconce
