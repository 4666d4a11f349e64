// The Hi-Z chain of a face: layout, and that its bounds hold what lies below them. Planes are evaluated in double precision.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/field/field_data.h"
#include "runtime/field/field_space.h"
#include "shaders/shared/pure.h"
#include "tests/support/chain_bounds.h"

namespace sconce
{
namespace
{

using testing_support::expectChainBounds;
using testing_support::planeAt;

using Text = Pure<float>;

std::vector<uint32_t> emptyFace(uint32_t size)
{
    return std::vector<uint32_t>(distanceWordsPerProbe(gpu::kChartCube, size) / 6);
}

/// Words of a plane over a face: q = q0 (1 + gx x + gy y), x, y in texels from the face's corner.
std::vector<uint32_t> flatFace(uint32_t size, float q0, float gx, float gy)
{
    std::vector<uint32_t> words = emptyFace(size);
    for (uint32_t i = 0; i < size * size; ++i)
    {
        const float q = q0 * (1.0f + gx * (float(i % size) + 0.5f) + gy * (float(i / size) + 0.5f));
        words[i] = Text::packTexel(q, q0 * gx / q, q0 * gy / q);
    }
    buildChain(words.data(), size);
    return words;
}

TEST(FaceChain, EveryWordBelongsToOneCell)
{
    for (const uint32_t size : {8u, 12u, 16u, 48u, 64u, 80u, 208u, 256u, 1024u})
    {
        const int top = Text::chainTop(size);
        std::vector<int> owners(Text::chainWords(size, top), 0);
        for (int level = 0; level <= top; level += 2)
        {
            const uint32_t width = Text::chainWidth(size, level);
            EXPECT_GE(width << level, size);
            for (uint32_t i = 0; i < width * width; ++i) ++owners.at(Text::chainOffset(size, level) + i);
        }
        for (uint32_t cell = 0; cell < Text::chainCells(size, top); cell += 2) ++owners.at(Text::chainNearWords(size, top) + cell / 2);
        for (const int owner : owners) ASSERT_EQ(owner, 1) << "faces of " << size;
        EXPECT_EQ(6 * owners.size(), distanceWordsPerProbe(gpu::kChartCube, size));
    }
}

TEST(FaceChain, BoundsHoldEverySurfelBelow)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<float> q(0.01f, 8.0f), gradient(-0.2f, 0.2f);
    for (const uint32_t size : {8u, 48u, 64u, 80u})
    {
        std::vector<uint32_t> words = emptyFace(size);
        for (uint32_t i = 0; i < size * size; ++i)
            words[i] = i % 17 == 0 ? 0u : Text::packTexel(q(random), gradient(random), gradient(random));
        buildChain(words.data(), size);
        expectChainBounds(words, size);
    }
}

TEST(FaceChain, BoundsHoldSmoothSurfacesWithSilhouettes)
{
    const uint32_t size = 80;
    std::vector<uint32_t> words = emptyFace(size);
    for (uint32_t i = 0; i < size * size; ++i)
    {
        const float x = float(i % size) - 31.5f, y = float(i / size) - 47.5f, r2 = x * x + y * y;
        // a ball before a slanted wall, sky in one corner
        const float ball = 900.0f - r2;
        const float near = 2.0f + 0.001f * std::max(ball, 0.0f), wall = 0.5f + 0.004f * float(i % size);
        if (ball > 0.0f)
            words[i] = Text::packTexel(near, -0.002f * x / near, -0.002f * y / near);
        else if (i % size + i / size < 140)
            words[i] = Text::packTexel(wall, 0.004f / wall, 0.0f);
    }
    buildChain(words.data(), size);
    expectChainBounds(words, size);
}

TEST(FaceChain, BoundOfAFlatWallIsTheWall)
{
    const uint32_t size = 64;
    for (const float g : {0.0f, 0.004f, -0.01f})
    {
        const std::vector<uint32_t> words = flatFace(size, 2.0f, std::abs(g), 0.3f * std::abs(g));
        expectChainBounds(words, size);
        for (int level = 2; level <= 6; level += 2)
        {
            const uint32_t width = Text::chainWidth(size, level);
            for (uint32_t i = 0; i < width * width; ++i)
            {
                const double half = 0.5 * (1 << level);
                const double x = (i % width) * 2.0 * half + half, y = (i / width) * 2.0 * half + half;
                const double wall = 2.0 * (1.0 + std::abs(g) * x + 0.3 * std::abs(g) * y);
                // rounding: a half up (1e-3), the bytes of the gradients over half a cell, each to half a step of theirs
                const double step = 0.15 * (2.0 * std::sqrt(std::abs(g) / 0.15) + 1.0 / 127.0) / 127.0;
                EXPECT_NEAR(planeAt(words[Text::chainOffset(size, level) + i], 0.0, 0.0), wall, wall * (2e-3 + (half + 0.5) * step));
            }
        }
    }
}

TEST(FaceChain, SkyAloneIsFree)
{
    std::vector<uint32_t> words = emptyFace(16);
    buildChain(words.data(), 16);
    for (const uint32_t word : words) EXPECT_EQ(word, 0u);
}

} // namespace
} // namespace sconce
