// The packed texture, read back by an own walk over the layout that svo/octree.h states, from lists made by hand.
#include "svo/pack_octree.h"

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::uvec2;
using Ranked = std::array<uint16_t, 4>;

constexpr uvec2 kNobody{gpu::kNoList, gpu::kNoList}, kDiffer{gpu::kNoList, 0};

uvec2 list(uint32_t a, uint32_t b = 0xffff, uint32_t c = 0xffff, uint32_t d = 0xffff)
{
    return {a | b << 16, c | d << 16};
}

/// Lists of all levels over a box of voxels, the coarser ones made from the finest: equal children make a leaf, others a node.
struct Lists
{
    OctreePlan plan;
    LevelLists levels;

    Lists(ivec3 topCells, int topShift, uint32_t marker = 255)
    {
        plan.tree.topCells = topCells;
        plan.tree.topShift = topShift;
        plan.tree.marker = marker;
        plan.build.count = topCells << topShift;
        for (int level = 0; level <= topShift; ++level)
        {
            const ivec3 size = plan.build.count >> level;
            levels.emplace_back(size_t(size.x) * size_t(size.y) * size_t(size.z), kNobody);
        }
    }
    uvec2& at(ivec3 p, int level = 0)
    {
        const ivec3 size = plan.build.count >> level;
        return levels[size_t(level)][size_t(p.x) + size_t(size.x) * (size_t(p.y) + size_t(size.y) * size_t(p.z))];
    }
    template <class Visit> void each(int level, Visit&& visit)
    {
        const ivec3 size = plan.build.count >> level;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) visit(ivec3(x, y, z));
    }
    Octree packed()
    {
        for (int level = 1; level <= plan.tree.topShift; ++level)
            each(level,
                 [&](ivec3 p)
                 {
                     at(p, level) = at(2 * p, level - 1);
                     for (int child = 1; child < 8; ++child)
                         if (at(2 * p + ivec3(child & 1, child >> 1 & 1, child >> 2), level - 1) != at(2 * p, level - 1))
                             at(p, level) = kDiffer;
                 });
        return packOctree(plan, levels);
    }
};

Ranked texelAt(const Octree& tree, uint32_t brick, ivec3 child)
{
    const glm::uvec3 b(brick % tree.bricks.x, brick / tree.bricks.x % tree.bricks.y, brick / tree.bricks.x / tree.bricks.y);
    const glm::uvec3 at = 2u * b + glm::uvec3(child), size = tree.textureSize();
    EXPECT_LT(b.z, tree.bricks.z);
    Ranked texel;
    std::copy_n(tree.texels.begin() + ptrdiff_t(4 * (at.x + size.x * (at.y + size_t(size.y) * at.z))), 4, texel.begin());
    return texel;
}

/// What a voxel asks. @param bricks  out: the bricks read on the way, without the top one
Ranked rankedAt(const Octree& tree, ivec3 voxel, std::set<uint32_t>* bricks = nullptr)
{
    const ivec3 top = voxel >> tree.topShift, across = (tree.topCells + 1) / 2;
    Ranked texel = texelAt(tree, uint32_t(top.x / 2 + across.x * (top.y / 2 + across.y * (top.z / 2))), top & 1);
    for (int level = tree.topShift - 1; level >= 0 && texel[3] == tree.marker; --level)
    {
        const uint32_t side = tree.marker + 1, brick = texel[0] + texel[1] * side + (side == 256 ? texel[2] * side * side : 0);
        if (bricks) bricks->insert(brick);
        texel = texelAt(tree, brick, (voxel >> level) & 1);
    }
    EXPECT_NE(texel[3], tree.marker) << "a node where a leaf must be";
    return texel;
}

TEST(PackOctree, EveryVoxelAsksItsOwnListWhateverWasShared)
{
    for (const uint32_t marker : {255u, 65535u})
    {
        Lists lists({3, 2, 5}, 3, marker);
        std::mt19937 random(marker);
        lists.each(0, [&](ivec3 p) { lists.at(p) = list(p.x / 4 == 1 ? 7u : random() % 3, random() % 2); }); // some uniform, some not
        const Octree tree = lists.packed();
        size_t nodes = 0;
        for (int level = 1; level <= 3; ++level) nodes += size_t(std::ranges::count(lists.levels[size_t(level)], kDiffer));
        EXPECT_EQ(tree.nodes, nodes);
        EXPECT_EQ(tree.leaves, 3u * 2u * 5u + 7u * nodes) << "each node turns one leaf into eight";
        EXPECT_EQ(tree.bytes(), tree.texels.size() / 4 * (marker == 255 ? 4 : 8));
        lists.each(0,
                   [&](ivec3 p)
                   {
                       const uint16_t first = uint16_t(lists.at(p).x), second = uint16_t(lists.at(p).x >> 16);
                       EXPECT_EQ(rankedAt(tree, p), (Ranked{first, second, first, first})) << p.x << ' ' << p.y << ' ' << p.z;
                   });
    }
}

// Cells that repeat one pattern are one brick, however many there are; one voxel of another kind adds its own path alone.
TEST(PackOctree, EqualBricksAreStoredOnce)
{
    Lists lists({4, 4, 4}, 2);
    lists.each(0, [&](ivec3 p) { lists.at(p) = list(uint32_t(p.x + p.y + p.z) % 2); });
    const auto bricksOf = [&](const Octree& tree)
    {
        std::set<uint32_t> bricks;
        lists.each(0, [&](ivec3 p) { rankedAt(tree, p, &bricks); });
        return bricks.size();
    };
    const Octree repeated = lists.packed();
    EXPECT_EQ(bricksOf(repeated), 2u); // one a level
    EXPECT_EQ(repeated.nodes, 64u * 9u) << "counted before they are shared";
    lists.at({5, 6, 7}) = list(9);
    const Octree other = lists.packed();
    EXPECT_EQ(bricksOf(other), 4u);
    EXPECT_EQ(rankedAt(other, {5, 6, 7})[0], 9);
    EXPECT_EQ(rankedAt(other, {5, 6, 6})[0], 1);
}

TEST(PackOctree, EqualSiblingsAreOneLeaf)
{
    Lists lists({2, 1, 1}, 4);
    lists.each(0, [&](ivec3 p) { lists.at(p) = list(p.x < 16 ? 3 : 4); });
    const Octree tree = lists.packed();
    EXPECT_EQ(tree.leaves, 2u);
    EXPECT_EQ(tree.nodes, 0u);
    EXPECT_EQ(tree.texels.size() / 4, 8u) << "the top brick alone";
    EXPECT_EQ(rankedAt(tree, {15, 3, 3})[0], 3);
    EXPECT_EQ(rankedAt(tree, {16, 3, 3})[0], 4);
}

TEST(PackOctree, MissingRanksRepeatTheFirst)
{
    Lists lists({1, 1, 1}, 1);
    const uvec2 cases[] = {list(1, 2, 3, 4), list(1, 2, 3), list(1, 2), list(1)};
    lists.each(0, [&](ivec3 p) { lists.at(p) = cases[p.x + 2 * p.y]; });
    const Octree tree = lists.packed();
    EXPECT_EQ(rankedAt(tree, {0, 0, 0}), (Ranked{1, 2, 3, 4}));
    EXPECT_EQ(rankedAt(tree, {1, 0, 0}), (Ranked{1, 2, 3, 1}));
    EXPECT_EQ(rankedAt(tree, {0, 1, 0}), (Ranked{1, 2, 1, 1}));
    EXPECT_EQ(rankedAt(tree, {1, 1, 0}), (Ranked{1, 1, 1, 1}));
}

// A voxel that no probe sees takes a sibling's list, a cell of such voxels that of the nearest cell that has one, all of them probe 0.
TEST(PackOctree, WhatNoProbeSeesAsksWhoeverIsNear)
{
    Lists lists({5, 1, 1}, 2);
    lists.at({17, 1, 2}) = list(6); // in the last cell
    const Octree tree = lists.packed();
    lists.each(0, [&](ivec3 p) { EXPECT_EQ(rankedAt(tree, p), (Ranked{6, 6, 6, 6})) << p.x; });

    Lists two({5, 1, 1}, 1);
    two.at({0, 0, 0}) = list(1);
    two.at({8, 0, 0}) = list(2);
    const Octree nearest = two.packed();
    EXPECT_EQ(rankedAt(nearest, {1, 1, 1})[0], 1);
    EXPECT_EQ(rankedAt(nearest, {3, 1, 1})[0], 1);
    EXPECT_EQ(rankedAt(nearest, {6, 1, 1})[0], 2);

    Lists none({2, 2, 1}, 2);
    const Octree dark = none.packed();
    none.each(0, [&](ivec3 p) { EXPECT_EQ(rankedAt(dark, p), (Ranked{0, 0, 0, 0})); });
}

} // namespace
} // namespace sconce
