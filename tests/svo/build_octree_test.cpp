#include "svo/build_octree.h"

#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "svo/octree_plan.h"
#include "tests/support/divided_box.h"

namespace sconce
{
namespace
{

using glm::vec3;
using testing_support::dividedBox;

namespace rank_text
{
using namespace glm;
/// The text that ranks, to ask of it what it leaves out.
struct Text
{
    using real = float;
    using uint = uint32_t;
    using vec2f = glm::vec2;
    static constexpr uint kNoSurfel = gpu::kNoSurfel, kNoList = gpu::kNoList, kSurfelSlots = gpu::kSurfelSlots, kSeesAll = gpu::kSeesAll;
    static constexpr int kRanked = gpu::kRanked, kBlock = gpu::kBlock, kFreeSamples = gpu::kFreeSamples;
    const gpu::OctreeBuild& build;
    const FieldData& field;
    uint distanceWord(uint index) const { return field.distance[index]; }
    vec3 probeCentre(uint probe) const { return field.probes[probe].centre; }
    bool holdsSurfels() const { return false; }
    uint candidateCount() const { return 0; }
    uvec2 candidateOf(uint) const { return {}; }
    uint surfelKey(uint) const { return kNoSurfel; }
    uvec2 listOf(ivec3, ivec3) const { return {}; }
#include "shaders/shared/pure_text.h"

#include "shaders/shared/octree_rank.h"
};
} // namespace rank_text

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

// Blocks that a probe's chain answers for: each of many points in them is answered alike by the map.
TEST(BuildOctree, WhatAChainTellsOfABlockIsSoOfItsPoints)
{
    for (const uint32_t faces : {52u, 64u, 128u}) // of 52 the coarsest cells reach over the border
    {
        const FieldData field = dividedBox(faces);
        const auto plan = planOctree({field.info, field.probes, field.distance}, {.voxels = 64});
        ASSERT_TRUE(plan);
        const gpu::OctreeBuild& build = plan->build;
        rank_text::Text text{build, field};
        std::mt19937 random(11);
        std::uniform_real_distribution<float> within(-0.5f, float(gpu::kBlock) + 0.5f);
        const glm::ivec3 blocks = (build.count + gpu::kBlock - 1) / gpu::kBlock;
        int answered[3] = {};
        for (int i = 0; i < blocks.x * blocks.y * blocks.z; ++i)
            for (uint32_t probe = 0; probe < 2; ++probe)
            {
                const glm::ivec3 block(i % blocks.x, i / blocks.x % blocks.y, i / blocks.x / blocks.y);
                const int sight = text.sightOf(probe, block);
                ++answered[sight];
                for (int point = 0; point < 40 && sight != text.kSightUnsure; ++point)
                {
                    const vec3 at = vec3(gpu::kBlock * block) + vec3(within(random), within(random), within(random));
                    ASSERT_EQ(text.probeSees(probe, text.probeCentre(probe), build.low + build.voxel * at), sight == text.kSightAll)
                        << faces << ", block " << i;
                }
            }
        for (const int sight : {text.kSightNone, text.kSightAll})
            EXPECT_GT(answered[sight], 800) << faces << " of " << answered[0] + answered[1] + answered[2];
    }
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

/// Every list in the box names probes of the point's own side, and many different ones.
void expectListsOfOwnSide(const FieldData& field, size_t different)
{
    twin::LightFieldTwin<float> text(field, {});
    int reads = 0;
    std::set<uint32_t> seen;
    for (float y = -0.9f; y < 0.9f; y += 0.05f)
        for (const float x : {-0.5f, 0.5f})
        {
            const glm::uvec4 ranked = text.rankedProbesAt(toField(field, vec3(x, y, 0.0f)), reads);
            for (int k = 0; k < 4; ++k)
            {
                ASSERT_LT(ranked[k], field.info.probeCount);
                if (field.info.probeCount > 1)
                {
                    EXPECT_EQ(ranked[k] % 2, x < 0.0f ? 0u : 1u) << "only probes on this side see the point";
                }
                seen.insert(ranked[k]);
            }
        }
    EXPECT_GE(seen.size(), different);
}

TEST(BuildOctree, From1To65535ProbesTheLastOf8BitsIs255)
{
    for (const uint32_t probes : {1u, 255u, 256u, 65535u})
    {
        SCOPED_TRACE(probes);
        FieldData field = dividedBox(8, probes);
        attachOctree(field, *buildOctree({field.info, field.probes, field.distance}, {.voxels = 16}));
        EXPECT_EQ(field.info.marker, probes <= 255 ? 255u : 65535u);
        EXPECT_EQ(field.octree.bytes(), field.octree.texels.size() / 4 * (probes <= 255 ? 4 : 8));
        expectListsOfOwnSide(field, std::min(probes, 10u));
    }
}

TEST(BuildOctree, EqualBricksAreStoredOnce)
{
    // The wall lies between voxels of the same two lists over and over: a handful of bricks serve the whole tree.
    FieldData field = dividedBox(64);
    const auto tree = buildOctree({field.info, field.probes, field.distance}, {.voxels = 64, .topShift = 2});
    ASSERT_TRUE(tree);
    const size_t top = size_t((tree->topCells.x + 1) / 2) * size_t((tree->topCells.y + 1) / 2) * size_t((tree->topCells.z + 1) / 2);
    EXPECT_GT(tree->nodes, 100u);
    EXPECT_LT(size_t(tree->bricks.x) * tree->bricks.y * tree->bricks.z, top + 100);
}

TEST(BuildOctree, ItsVoxelsGrowWithTheRootOfTheProbesUnlessSaid)
{
    const auto voxels = [](uint32_t probes, int asked)
    {
        const FieldData field = dividedBox(8, probes);
        return planOctree({field.info, field.probes, field.distance}, {.voxels = asked})->build.count.y;
    };
    EXPECT_NEAR(voxels(1, 0), 128, 4); // whole top cells
    EXPECT_NEAR(voxels(90, 0), 165, 4);
    EXPECT_NEAR(voxels(90, 16), 16, 4);
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
    EXPECT_NE(buildOctree({field.info, field.probes, field.distance}, {.voxels = 4}).error().message.find("voxels is 4"),
              std::string::npos);
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
