#include "bench/sparse/sparse_fill.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

constexpr uint32_t kSize = 32;
const std::vector<std::array<vec2, 2>> kDivided = {{vec2(10.3f, -1.0f), vec2(21.7f, 33.0f)}};

/// Light of 1 on one side of a slanted line, of 3 on the other.
float lightAt(vec2 place)
{
    const vec2 along = kDivided[0][1] - kDivided[0][0], off = place - kDivided[0][0];
    return along.x * off.y - along.y * off.x > 0.0f ? 1.0f : 3.0f;
}

std::vector<vec3> lights()
{
    std::vector<vec3> of;
    for (uint32_t i = 0; i < kSize * kSize; ++i) of.push_back(vec3(lightAt(vec2(i % kSize, i / kSize) + 0.5f)));
    return of;
}

/// One plane before the eye: surfaces that nothing tells apart.
SurfacePixels plane()
{
    SurfacePixels pixels{kSize, kSize, vec3(0.0f, 0.0f, 2.0f), {}, {}, {}};
    for (uint32_t i = 0; i < kSize * kSize; ++i)
    {
        pixels.position.push_back({0.01f * float(i % kSize), 0.01f * float(i / kSize), 0.0f});
        pixels.normal.push_back({0.0f, 0.0f, 1.0f});
        pixels.roughness.push_back(0.5f);
    }
    return pixels;
}

size_t wrong(const std::vector<vec3>& light)
{
    const std::vector<vec3> truth = lights();
    size_t count = 0;
    for (size_t i = 0; i < truth.size(); ++i) count += glm::distance(light[i], truth[i]) > 1e-4f ? 1 : 0;
    return count;
}

TEST(SparseFill, EdgesKeepApartWhatTheGBufferTakesForOneSurface)
{
    const EdgeImage edges(kSize, kSize, kDivided);
    for (const uint32_t every : {4u, 16u, 64u})
    {
        const Filled filled = fillSparse(plane(), edges, lights(), every, FillBy::edges);
        EXPECT_EQ(wrong(filled.light), 0u) << every;
        EXPECT_LE(filled.samples, kSize * kSize / every + kSize); // what no sample reaches on its side, along the line
        EXPECT_GE(wrong(fillSparse(plane(), edges, lights(), every, FillBy::likeness).light), kSize);
        EXPECT_EQ(wrong(fillSparse(plane(), edges, lights(), every, FillBy::both).light), 0u) << every;
    }
}

TEST(SparseFill, LikenessKeepsApartWhatNoEdgeDivides)
{
    SurfacePixels pixels = plane();
    const std::vector<vec3> truth = lights();
    for (size_t i = 0; i < truth.size(); ++i)
        if (truth[i].x > 2.0f) pixels.normal[i] = {1.0f, 0.0f, 0.0f};
    const EdgeImage none(kSize, kSize, {});
    EXPECT_EQ(wrong(fillSparse(pixels, none, truth, 16, FillBy::likeness).light), 0u);
    EXPECT_EQ(wrong(fillSparse(pixels, none, truth, 16, FillBy::both).light), 0u);
    EXPECT_GE(wrong(fillSparse(pixels, none, truth, 16, FillBy::edges).light), kSize);
}

TEST(SparseFill, OneOfOneIsTheLightItself)
{
    const Filled filled = fillSparse(plane(), EdgeImage(kSize, kSize, {}), lights(), 1, FillBy::distance);
    EXPECT_EQ(filled.samples, kSize * kSize);
    EXPECT_EQ(filled.light, lights());
}

TEST(SparseFill, ASlopeOfLightIsKeptBetweenSamples)
{
    std::vector<vec3> slope;
    for (uint32_t i = 0; i < kSize * kSize; ++i) slope.push_back(vec3(float(i % kSize)));
    const Filled filled = fillSparse(plane(), EdgeImage(kSize, kSize, {}), slope, 16, FillBy::distance);
    for (uint32_t y = 8; y < kSize - 8; ++y)
        for (uint32_t x = 8; x < kSize - 8; ++x)
            EXPECT_NEAR(filled.light[y * kSize + x].x, float(x), 0.5f); // a tent of 1.5 cells: off by an eighth of a cell
}

TEST(SmoothEdges, APixelOnTheLineHasTheMeanOfItsArea)
{
    const EdgeImage edges(kSize, kSize, kDivided);
    const std::vector<vec3> smooth = smoothEdges(edges, lights());
    constexpr int kPoints = 16;
    for (uint32_t y = 1; y + 1 < kSize; ++y)
        for (uint32_t x = 1; x + 1 < kSize; ++x)
        {
            float mean = 0.0f;
            for (int i = 0; i < kPoints * kPoints; ++i)
                mean += lightAt(vec2(x, y) + (vec2(i % kPoints, i / kPoints) + 0.5f) / float(kPoints)) / float(kPoints * kPoints);
            EXPECT_NEAR(smooth[y * kSize + x].x, mean, 0.05f) << x << " " << y;
        }
}

} // namespace
} // namespace sconce
