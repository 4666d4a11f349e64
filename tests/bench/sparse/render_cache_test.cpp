#include "bench/sparse/render_cache.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 64, kHeight = 48, kPixels = kWidth * kHeight, kBudget = kPixels / 16;

/// A wall whose colour changes slowly along it, and a dark square before it.
struct World
{
    bool square = true;
    float light = 1.0f;

    RenderCache::Point at(const Camera& camera, uint32_t pixel) const
    {
        const vec3 way =
            Pinhole(camera, kWidth, kHeight).direction(float(pixel % kWidth) + 0.5f, float(pixel / kWidth) + 0.5f, kWidth, kHeight);
        const vec3 near = camera.eye + way * ((1.0f - camera.eye.z) / way.z), far = camera.eye + way * ((4.0f - camera.eye.z) / way.z);
        if (square && std::max(std::abs(near.x), std::abs(near.y)) < 0.2f) return {near, vec3(0.1f * light)};
        return {far, light * vec3(1.0f + 0.1f * std::sin(far.x), 1.0f + 0.1f * std::cos(far.y), 1.0f)};
    }
};

Camera cameraAt(float x)
{
    Camera camera;
    camera.eye = {x, 0.0f, 0.0f};
    camera.forward = {0.0f, 0.0f, 1.0f};
    return camera;
}

/// Asks for a frame's samples, and gives them.
std::vector<uint32_t> frame(RenderCache& cache, const World& world, const Camera& camera, size_t budget = kBudget)
{
    cache.project(camera);
    const std::vector<uint32_t> asked = cache.ask(budget);
    std::vector<RenderCache::Point> samples;
    for (const uint32_t pixel : asked) samples.push_back(world.at(camera, pixel));
    cache.add(asked, samples);
    return asked;
}

/// Pixels whose colour is off by over a tenth of the truth.
size_t wrong(const RenderCache& cache, const World& world, const Camera& camera)
{
    size_t count = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const vec3 truth = world.at(camera, pixel).colour;
        count += glm::distance(cache.picture()[pixel], truth) > 0.1f * glm::length(truth) ? 1 : 0;
    }
    return count;
}

RenderCache filled(const World& world, RenderCache::Desc desc = {.width = kWidth, .height = kHeight})
{
    RenderCache cache(desc);
    for (int i = 0; i < 40; ++i) frame(cache, world, cameraAt(0.0f));
    cache.project(cameraAt(0.0f));
    return cache;
}

TEST(RenderCache, AStillCameraFillsItsPictureWithinTheBudget)
{
    const World world;
    RenderCache cache({.width = kWidth, .height = kHeight});
    std::set<uint32_t> all;
    for (int i = 0; i < 40; ++i)
    {
        const std::vector<uint32_t> asked = frame(cache, world, cameraAt(0.0f));
        EXPECT_LE(asked.size(), kBudget);
        EXPECT_GE(asked.size(), kBudget * 9 / 10);
        EXPECT_EQ(std::set<uint32_t>(asked.begin(), asked.end()).size(), asked.size());
        all.insert(asked.begin(), asked.end());
    }
    cache.project(cameraAt(0.0f));
    EXPECT_EQ(all.size(), kPixels);
    EXPECT_EQ(cache.holes(), 0u);
    EXPECT_EQ(wrong(cache, world, cameraAt(0.0f)), 0u);
}

TEST(RenderCache, PointsMoveWithTheCamera)
{
    const World world{.square = false};
    RenderCache cache = filled(world);
    cache.project(cameraAt(0.3f)); // without a ray
    EXPECT_EQ(wrong(cache, world, cameraAt(0.3f)), 0u);
    EXPECT_GT(cache.holes(), 0u);
}

TEST(RenderCache, WhatLiesBehindDoesNotShineThrough)
{
    const World world;
    RenderCache::Desc open{.width = kWidth, .height = kHeight};
    open.culls = false;
    RenderCache culled = filled(world), bare = filled(world, open);
    // Nearer by half, so that the square's points lie two pixels apart and the wall's show between them.
    Camera camera = cameraAt(0.0f);
    camera.eye.z = 0.5f;
    culled.project(camera);
    bare.project(camera);
    const size_t through = wrong(bare, world, camera), left = wrong(culled, world, camera);
    EXPECT_GE(through, 100u);
    EXPECT_LE(20 * left, 11 * through); // what is left is along the outline
}

TEST(RenderCache, AChangeOfLightIsFollowedSoonerWhereItIsSeen)
{
    const World day, night{.light = 0.5f};
    RenderCache::Desc plain{.width = kWidth, .height = kHeight};
    plain.hastens = false;
    const auto framesToChange = [&](const RenderCache::Desc& desc)
    {
        RenderCache cache = filled(day, desc);
        int frames = 0;
        for (; frames < 200 && wrong(cache, night, cameraAt(0.0f)) > kPixels / 50; ++frames)
        {
            frame(cache, night, cameraAt(0.0f));
            cache.project(cameraAt(0.0f));
        }
        return frames;
    };
    const int hastened = framesToChange({.width = kWidth, .height = kHeight}), not_ = framesToChange(plain);
    EXPECT_LE(hastened, 26); // 16 if no pixel were asked for twice
    EXPECT_LE(hastened, not_);
}

TEST(RenderCache, AWholeFrameIsShownAsItIs)
{
    const World world;
    RenderCache cache({.width = kWidth, .height = kHeight});
    std::vector<RenderCache::Point> points;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        points.push_back(world.at(cameraAt(0.0f), pixel));
        points.back().age = 0.0f;
    }
    cache.replace(points);
    cache.project(cameraAt(0.0f));
    EXPECT_EQ(cache.holes(), 0u);
    EXPECT_EQ(wrong(cache, world, cameraAt(0.0f)), 0u);
}

} // namespace
} // namespace sconce
