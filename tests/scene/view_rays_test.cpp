#include "scene/view_rays.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 64, kHeight = 36;

/// Looks along -z from (1, 2, 3), x to the right.
Camera straight()
{
    Camera camera;
    camera.eye = vec3(1.0f, 2.0f, 3.0f);
    camera.verticalFov = 1.2f;
    return camera;
}

/// Where a ray goes through the plane one metre ahead, half heights of the picture from its middle, y down.
vec2 onPicture(const ViewRay& ray)
{
    const float half = std::tan(0.5f * straight().verticalFov);
    return vec2(ray.direction.x, -ray.direction.y) / (-ray.direction.z * half);
}

TEST(ViewRays, AreTheCamerasAndTheFirstGoesThroughThePixelsCentre)
{
    const auto rays = ViewRays::create(straight(), {.width = kWidth, .height = kHeight, .samples = 4});
    ASSERT_TRUE(rays);
    EXPECT_EQ(rays->width(), kWidth);
    const ViewRay ray = rays->ray(40, 7, 0);
    EXPECT_EQ(ray.origin, straight().eye);
    EXPECT_NEAR(onPicture(ray).x, (40.5f - 32.0f) / 18.0f, 1e-5f);
    EXPECT_NEAR(onPicture(ray).y, (7.5f - 18.0f) / 18.0f, 1e-5f);
}

TEST(ViewRays, SamplesFillThePixel)
{
    constexpr uint32_t kSamples = 64;
    const auto rays = ViewRays::create(straight(), {.width = kWidth, .height = kHeight, .samples = kSamples});
    ASSERT_TRUE(rays);
    int quarter[4] = {};
    for (uint32_t i = 0; i < kSamples; ++i)
    {
        const vec2 within = 18.0f * onPicture(rays->ray(40, 7, i)) + vec2(32.0f, 18.0f) - vec2(40.0f, 7.0f);
        ASSERT_TRUE(within.x > -1e-3f && within.x < 1.001f && within.y > -1e-3f && within.y < 1.001f) << within.x << " " << within.y;
        ++quarter[(within.x < 0.5f ? 0 : 1) + (within.y < 0.5f ? 0 : 2)];
    }
    for (const int count : quarter) EXPECT_NEAR(count, int(kSamples / 4), 3);
}

TEST(ViewRays, EyesStandApartAndLookAlike)
{
    const auto rays = ViewRays::create(straight(), {.width = kWidth, .height = kHeight, .eyesApart = 0.064f});
    ASSERT_TRUE(rays);
    EXPECT_EQ(rays->width(), 2 * kWidth);
    const ViewRay left = rays->ray(5, 9, 0), right = rays->ray(kWidth + 5, 9, 0);
    EXPECT_EQ(left.direction, right.direction);
    EXPECT_NEAR(glm::length(right.origin - left.origin - vec3(0.064f, 0.0f, 0.0f)), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::length(0.5f * (left.origin + right.origin) - straight().eye), 0.0f, 1e-6f);
}

TEST(ViewRays, ALensShowsThingsWhereItsFormulaSays)
{
    const vec2 k(0.22f, 0.24f);
    const auto rays = ViewRays::create(straight(), {.width = kWidth, .height = kHeight, .lens = k});
    ASSERT_TRUE(rays);
    for (const uint32_t x : {0u, 20u, 63u})
        for (const uint32_t y : {0u, 17u, 35u})
        {
            const vec2 off((float(x) + 0.5f - 32.0f) / 18.0f, (float(y) + 0.5f - 18.0f) / 18.0f);
            const float r = glm::length(off), shown = r * (1.0f + k.x * r * r + k.y * r * r * r * r);
            EXPECT_NEAR(glm::length(onPicture(rays->ray(x, y, 0))), shown, 2e-5f * (1.0f + shown * shown)) << x << "," << y;
        }
}

TEST(ViewRays, TilesHoldEachPixelOfTheRowsOnce)
{
    const auto rays = ViewRays::create(straight(), {.width = 21, .height = kHeight});
    ASSERT_TRUE(rays);
    std::vector<int> seen(size_t(21) * kHeight, 0);
    const std::vector<glm::uvec2> pixels = rays->pixelsInTiles(8, 19);
    for (const glm::uvec2 at : pixels) ++seen[size_t(at.y) * 21 + at.x];
    for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i / 21 >= 8 && i / 21 < 19 ? 1 : 0) << i;
    EXPECT_EQ(pixels[7], glm::uvec2(7, 8));
    EXPECT_EQ(pixels[8], glm::uvec2(0, 9)) << "a tile's rows before the next tile";
}

TEST(ViewRays, WhatHasNoSenseIsRefused)
{
    const auto refused = [](const View& view)
    {
        const auto rays = ViewRays::create(straight(), view);
        return rays ? std::string() : rays.error().message;
    };
    EXPECT_NE(refused({.lens = {-0.5f, 0.0f}}).find("folds"), std::string::npos);
    EXPECT_NE(refused({.lens = {std::nanf(""), 0.0f}}).find("folds"), std::string::npos);
    EXPECT_EQ(refused({.lens = {-0.05f, 0.0f}}), "");
    EXPECT_NE(refused({.eyesApart = -1.0f}).find("-1 m apart"), std::string::npos);
    EXPECT_NE(refused({.eyesApart = std::numeric_limits<float>::infinity()}).find("apart"), std::string::npos);
    EXPECT_NE(refused({.width = 0}).find("0 x 360"), std::string::npos);
}

} // namespace
} // namespace sconce
