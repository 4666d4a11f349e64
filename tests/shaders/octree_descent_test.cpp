// The descent through an octree's texture, on one made by hand (layout: svo/octree.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::uvec4;
using glm::vec3;

using Texel = std::array<uint16_t, 4>;

/// Top cells 3 x 1 x 1 of 4 voxels a side, each 0.5 wide, from (-1, 2, 0). Cell 0 is a leaf. Cell 1 points to brick 2, whose children are
/// leaves 10..17. Cell 2 points to brick 3, whose child 5 points to brick 4 with leaves 20..27, its others are leaves 30..37.
FieldData byHand(uint32_t marker)
{
    Octree tree;
    tree.boundsLow = {-1, 2, 0};
    tree.boundsHigh = {5, 4, 2};
    tree.voxel = 0.5f;
    tree.topCells = {3, 1, 1};
    tree.topShift = 2;
    tree.bricks = {2, 2, 2}; // room for eight, five are used
    tree.marker = marker;
    const glm::uvec3 size = tree.textureSize();
    tree.texels.assign(size_t(4) * size.x * size.y * size.z, 99);
    const auto put = [&](uint32_t brick, uint32_t child, Texel texel)
    {
        const uint32_t x = 2 * (brick & 1) + (child & 1), y = 2 * (brick >> 1 & 1) + (child >> 1 & 1), z = 2 * (brick >> 2) + (child >> 2);
        std::copy_n(texel.begin(), 4, tree.texels.begin() + ptrdiff_t(4 * (x + size.x * (y + size.y * z))));
    };
    const auto leaf = [](uint32_t probe) { return Texel{uint16_t(probe), uint16_t(probe + 1), uint16_t(probe), uint16_t(probe)}; };
    const auto node = [&](uint32_t brick) { return Texel{uint16_t(brick), 0, 0, uint16_t(marker)}; };
    put(0, 0, leaf(5)); // cells 0 and 1 in the first brick, cell 2 in the second
    put(0, 1, node(2));
    put(1, 0, node(3));
    for (uint32_t child = 0; child < 8; ++child)
    {
        put(2, child, leaf(10 + child));
        put(3, child, child == 5 ? node(4) : leaf(30 + child));
        put(4, child, leaf(20 + child));
    }
    FieldData field;
    attachOctree(field, tree);
    return field;
}

TEST(OctreeDescent, QuotientsByFloatsAreTheIntegers)
{
    twin::LightFieldTwin<float> text(byHand(255), {});
    std::mt19937 random(3);
    for (int i = 0; i < 200000; ++i)
    {
        const int divisor = 1 + int(random() % 2048), number = i % 2 ? int(random() % (1u << 24)) : divisor * int(random() % 8192) - i % 3;
        if (number < 0) continue;
        EXPECT_EQ(text.quotient(number, divisor), glm::ivec2(number / divisor, number % divisor)) << number << ' ' << divisor;
    }
}

TEST(OctreeDescent, FindsTheLeafThatHoldsAPoint)
{
    for (const uint32_t marker : {255u, 65535u})
    {
        const FieldData field = byHand(marker);
        twin::LightFieldTwin<float> text(field, {});
        std::mt19937 random(1);
        std::uniform_real_distribution<float> share(0.001f, 0.999f);
        for (int i = 0; i < 5000; ++i)
        {
            const ivec3 voxel(int(random() % 12), int(random() % 4), int(random() % 4));
            const vec3 inside = vec3(-1, 2, 0) + 0.5f * (vec3(voxel) + vec3(share(random), share(random), share(random)));
            EXPECT_EQ(text.octreeVoxel(inside), voxel);
            const auto child = [&](int level)
            { return uint32_t((voxel.x >> level & 1) + 2 * (voxel.y >> level & 1) + 4 * (voxel.z >> level & 1)); };
            uint32_t probe = 5;
            int depth = 1;
            if (voxel.x >= 8)
            {
                probe = child(1) == 5 ? 20 + child(0) : 30 + child(1);
                depth = child(1) == 5 ? 3 : 2;
            }
            else if (voxel.x >= 4)
                probe = 10 + child(1), depth = 2;
            int reads = 7;
            EXPECT_EQ(text.rankedProbesAt(inside, reads), uvec4(probe, probe + 1, probe, probe))
                << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
            EXPECT_EQ(reads, 7 + depth) << "reads are added";
        }
    }
}

TEST(OctreeDescent, PointsOutsideAndNotANumberAskTheNearestVoxel)
{
    const FieldData field = byHand(255);
    twin::LightFieldTwin<float> text(field, {});
    const float inf = INFINITY, nan = std::nanf("");
    EXPECT_EQ(text.octreeVoxel({-9, 3.2f, 0.7f}), ivec3(0, 2, 1));
    EXPECT_EQ(text.octreeVoxel({9, 9, 9}), ivec3(11, 3, 3));
    EXPECT_EQ(text.octreeVoxel({5, 4, 2}), ivec3(11, 3, 3)) << "the high bounds themselves";
    EXPECT_EQ(text.octreeVoxel({inf, -inf, 1e38f}), ivec3(11, 0, 3));
    const ivec3 odd = text.octreeVoxel({nan, nan, nan});
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(odd[axis] >= 0 && odd[axis] < (axis == 0 ? 12 : 4));
}

// Against a queue of twelve. Numbers about those whose halves of a word look alike: 0, the sign bit, the last that a field has.
TEST(TriedProbes, RemembersTheLastTwelve)
{
    const FieldData field = byHand(255);
    twin::LightFieldTwin<float> text(field, {});
    auto tried = text.noneTried();
    EXPECT_FALSE(text.wasTried(tried, 0));
    std::deque<uint32_t> queue;
    std::mt19937 random(2);
    const auto numberOf = [](uint32_t n) { return n < 10 ? n : n < 20 ? 0x8000u - 15 + n : 65534u - 29 + n; };
    for (int i = 0; i < 2000; ++i)
    {
        const uint32_t probe = numberOf(random() % 30);
        text.addTried(tried, probe);
        queue.push_front(probe);
        if (queue.size() > 12) queue.pop_back();
        for (uint32_t n = 0; n < 30; ++n)
        {
            const uint32_t p = numberOf(n);
            ASSERT_EQ(text.wasTried(tried, p), std::ranges::find(queue, p) != queue.end()) << i << ' ' << p;
        }
        if (i % 40 != 39) continue;
        text.keepLastTried(tried);
        queue.resize(1);
        EXPECT_EQ(tried.count, 1);
    }
}

TEST(TriedProbes, NothingToKeepIsNothing)
{
    const FieldData field = byHand(255);
    twin::LightFieldTwin<float> text(field, {});
    auto tried = text.noneTried();
    text.keepLastTried(tried);
    EXPECT_EQ(tried.count, 0);
}

} // namespace
} // namespace sconce
