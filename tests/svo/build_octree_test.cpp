#include "svo/build_octree.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/field_space.h"
#include "runtime/tracer_cpu.h"

namespace sconce
{
namespace
{

using glm::vec3;

/// Two probes in a box of [-1,1]^3 that a wall at x = 0 (hole-free) divides: probe 0 sees x < 0, probe 1 sees x > 0. Closed-form maps.
FieldData dividedBox(uint32_t faceSize, int copies = 1)
{
    FieldData field;
    Bounds bounds;
    bounds.add(vec3(-1.0f));
    bounds.add(vec3(1.0f));
    field.info = fieldSpace(bounds);
    field.info.chart = gpu::kChartCube;
    field.info.faceSize = faceSize;
    field.info.topLevel = coarsestLevel(faceSize);
    field.info.wordsPerProbe = distanceWordsPerProbe(gpu::kChartCube, faceSize);
    const int probes = 2 * copies;
    field.info.probeCount = uint32_t(probes);
    field.probes.resize(size_t(probes));
    field.distance.resize(size_t(field.info.wordsPerProbe) * size_t(probes));
    twin::LightFieldTwin<float> text(field, {});
    for (int probe = 0; probe < probes; ++probe)
    {
        const float side = probe % 2 == 0 ? -1.0f : 1.0f;
        const vec3 centre(0.5f * side, 0.05f * float(probe / 2), 0.0f);
        const vec3 low(side < 0 ? -1.0f : 0.0f, -1.0f, -1.0f), high(side < 0 ? 0.0f : 1.0f, 1.0f, 1.0f);
        field.probes[size_t(probe)] = {};
        field.probes[size_t(probe)].centre = (centre - field.info.origin) / field.info.scale;
        for (int face = 0; face < 6; ++face)
            for (uint32_t i = 0; i < faceSize * faceSize; ++i)
            {
                const float u = 2.0f * (float(i % faceSize) + 0.5f) / float(faceSize) - 1.0f,
                            v = 2.0f * (float(i / faceSize) + 0.5f) / float(faceSize) - 1.0f;
                const vec3 d = text.faceDirection(face, vec3(u, v, 1.0f));
                float w = 1e9f;
                for (int a = 0; a < 3; ++a)
                    if (d[a] != 0.0f) w = std::min(w, ((d[a] > 0.0f ? high[a] : low[a]) - centre[a]) / d[a]);
                field.distance[size_t(probe) * field.info.wordsPerProbe + size_t(face) * (field.info.wordsPerProbe / 6) + i] =
                    text.packTexel(field.info.scale / w, 0.0f, 0.0f);
            }
        summariseProbe(field, size_t(probe));
    }
    return field;
}

vec3 toField(const FieldData& field, vec3 world)
{
    return (world - field.info.origin) / field.info.scale;
}

TEST(BuildOctree, PointsAskTheProbeThatSeesThem)
{
    FieldData field = dividedBox(64);
    auto tree = buildOctree({field.info, field.probes, field.distance}, {.voxels = 32});
    ASSERT_TRUE(tree);
    attachOctree(field, *tree);
    twin::LightFieldTwin<float> text(field, {});
    std::mt19937 random(3);
    std::uniform_real_distribution<float> across(-0.95f, 0.95f);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 p(across(random), across(random), across(random));
        if (std::abs(p.x) < 0.07f) continue; // a voxel's width about the wall
        int reads = 0;
        EXPECT_EQ(text.rankedProbesAt(toField(field, p), reads).x, p.x < 0.0f ? 0u : 1u) << p.x << " " << p.y << " " << p.z;
        EXPECT_LE(reads, 1 + field.info.topShift);
    }
}

TEST(BuildOctree, EveryPointHasALeafEvenOutsideAndNotANumber)
{
    FieldData field = dividedBox(64);
    attachOctree(field, *buildOctree({field.info, field.probes, field.distance}, {.voxels = 16}));
    twin::LightFieldTwin<float> text(field, {});
    const float nan = std::nanf(""), inf = INFINITY;
    for (vec3 p :
         {vec3(100.0f), vec3(-100.0f), vec3(nan), vec3(inf, 0, 0), vec3(-inf, nan, 3.0f), vec3(0.0f), vec3(-0.0f), vec3(1e30f, -1e30f, 0)})
    {
        int reads = 0;
        const glm::uvec4 ranked = text.rankedProbesAt(p, reads);
        for (int k = 0; k < 4; ++k) EXPECT_LT(ranked[k], 2u) << p.x;
    }
    int reads = 0;
    EXPECT_EQ(text.rankedProbesAt(vec3(50.0f, 0.1f, 0.0f), reads).x, 1u) << "a point outside asks the nearest leaf";
}

TEST(BuildOctree, DescentEqualsTheUncollapsedVoxels)
{
    // The same voxels with every level kept (topShift 1) and with three levels collapsed give the same lists everywhere.
    FieldData shallow = dividedBox(64), deep = dividedBox(64);
    attachOctree(shallow, *buildOctree({shallow.info, shallow.probes, shallow.distance}, {.voxels = 32, .topShift = 1}));
    attachOctree(deep, *buildOctree({deep.info, deep.probes, deep.distance}, {.voxels = 32, .topShift = 4}));
    EXPECT_LT(deep.octree.leaves, shallow.octree.leaves);
    twin::LightFieldTwin<float> a(shallow, {}), b(deep, {});
    std::mt19937 random(5);
    std::uniform_real_distribution<float> across(-0.49f, 0.49f);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 p(across(random), across(random), across(random));
        int reads = 0;
        EXPECT_EQ(a.rankedProbesAt(p, reads), b.rankedProbesAt(p, reads));
    }
}

TEST(BuildOctree, MoreThan255ProbesTake16Bits)
{
    FieldData field = dividedBox(16, 130);
    attachOctree(field, *buildOctree({field.info, field.probes, field.distance}, {.voxels = 16}));
    EXPECT_EQ(field.info.marker, 65535u);
    twin::LightFieldTwin<float> text(field, {});
    int reads = 0;
    std::set<uint32_t> seen;
    for (float y = -0.9f; y < 0.9f; y += 0.05f)
    {
        const glm::uvec4 ranked = text.rankedProbesAt(toField(field, vec3(-0.5f, y, 0.0f)), reads);
        for (int k = 0; k < 4; ++k)
        {
            ASSERT_LT(ranked[k], 260u);
            EXPECT_EQ(ranked[k] % 2, 0u) << "only probes on this side of the wall see the point";
            seen.insert(ranked[k]);
        }
    }
    EXPECT_GT(seen.size(), 4u);
}

TEST(BuildOctree, SameBytesTwice)
{
    const FieldData field = dividedBox(64);
    EXPECT_EQ(buildOctree({field.info, field.probes, field.distance}, {})->texels,
              buildOctree({field.info, field.probes, field.distance}, {})->texels);
}

TEST(BuildOctree, RefusesWhatItCantDoWithASentence)
{
    FieldData field = dividedBox(16);
    EXPECT_NE(buildOctree({field.info, {}, field.distance}, {}).error().message.find("at least one probe"), std::string::npos);
    EXPECT_NE(buildOctree({field.info, field.probes, field.distance}, {.voxels = 4}).error().message.find("voxels 4"), std::string::npos);
    field.info.chart = gpu::kChartOctahedral;
    EXPECT_NE(buildOctree({field.info, field.probes, field.distance}, {}).error().message.find("cube"), std::string::npos);
}

TEST(BuildOctree, CancelsWhenAsked)
{
    const FieldData field = dividedBox(16);
    const auto result = buildOctree({field.info, field.probes, field.distance}, {}, [](std::string_view, double) { return false; });
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace sconce
