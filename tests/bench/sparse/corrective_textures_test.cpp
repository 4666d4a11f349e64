#include "bench/sparse/corrective_textures.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

constexpr uint32_t kSide = 32;

/// A wall that an eye sees from one metre, all of it.
SurfacePixels wall(float shift = 0.0f)
{
    SurfacePixels pixels{kSide, kSide, vec3(shift, 0.0f, 1.0f), {}, {}, {}};
    for (uint32_t i = 0; i < kSide * kSide; ++i)
    {
        pixels.position.push_back({shift + 0.03f * float(i % kSide), 0.03f * float(i / kSide), 0.0f});
        pixels.normal.push_back({0.0f, 0.0f, 1.0f});
        pixels.roughness.push_back(0.2f);
    }
    return pixels;
}

/// What the cheap picture lacks, by the place alone.
vec3 lackAt(vec3 place)
{
    return vec3(0.2f + 0.1f * place.x, 0.3f, 0.1f + 0.1f * place.y);
}

const std::vector<vec3> kCheap(kSide* kSide, vec3(0.5f));
const std::vector<bool> kAll(kSide* kSide, true);

double errorOf(std::span<const vec3> picture, const SurfacePixels& pixels)
{
    double sum = 0.0;
    for (size_t i = 0; i < picture.size(); ++i)
        sum += glm::distance(picture[i], kCheap[i] + lackAt(pixels.position[i])) / double(picture.size());
    return sum;
}

void learn(CorrectiveTextures& textures, const SurfacePixels& pixels, int frames)
{
    for (int i = 0; i < frames; ++i)
    {
        textures.correct(pixels, kCheap, kAll);
        const std::vector<uint32_t> asked = textures.ask(kSide * kSide / 16);
        std::vector<vec3> differences;
        for (const uint32_t pixel : asked) differences.push_back(lackAt(pixels.position[pixel]));
        textures.add(pixels, asked, differences);
    }
}

TEST(CorrectiveTextures, WhatDoesNotDependOnTheViewIsLearntAndKeptWhereTheCameraGoes)
{
    CorrectiveTextures textures({});
    EXPECT_EQ(errorOf(textures.correct(wall(), kCheap, kAll), wall()), errorOf(kCheap, wall())); // nothing is known
    learn(textures, wall(), 40);
    EXPECT_LT(errorOf(textures.correct(wall(), kCheap, kAll), wall()), 0.01);
    const SurfacePixels moved = wall(0.2f); // two thirds of it were seen
    EXPECT_LT(errorOf(textures.correct(moved, kCheap, kAll), moved), 0.3 * errorOf(kCheap, moved));
    EXPECT_GT(textures.bytes(), 16u * 100u);
    EXPECT_LT(textures.bytes(), 16u * 1000u); // cells of 8 cm on a square metre, two deep
}

TEST(CorrectiveTextures, WhatCannotBeOffIsLeftAloneAndNeverAskedFor)
{
    CorrectiveTextures textures({});
    std::vector<bool> left(kAll);
    for (uint32_t i = 0; i < kSide * kSide; ++i) left[i] = i % kSide < kSide / 2;
    learn(textures, wall(), 20);
    const std::vector<vec3> picture = textures.correct(wall(), kCheap, left);
    for (const uint32_t pixel : textures.ask(kSide * kSide)) EXPECT_TRUE(left[pixel]);
    for (uint32_t i = 0; i < kSide * kSide; ++i) EXPECT_TRUE(left[i] || picture[i] == kCheap[i]);
}

TEST(CorrectiveTextures, TheTwoSidesOfASheetAreTwoTextures)
{
    CorrectiveTextures textures({});
    learn(textures, wall(), 20);
    SurfacePixels back = wall();
    std::ranges::fill(back.normal, vec3(0.0f, 0.0f, -1.0f));
    EXPECT_EQ(textures.correct(back, kCheap, kAll), kCheap);
}

} // namespace
} // namespace sconce
