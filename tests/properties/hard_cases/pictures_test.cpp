// The same scene said otherwise gives the same picture: moved, turned, mirrored, scaled, its triangles or probes in another order, a probe
// twice. Every effect but the filter over time is on, with many rays, since noise turns with the scene.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "base/random.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_frames.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kWidth = 64, kHeight = 36;

struct Picture
{
    Scene scene = *makeBuiltinScene("cornell-glossy");
    std::vector<vec3> probes = {{0.0f, 1.5f, 0.5f}, {-0.8f, 0.5f, 0.6f}, {0.8f, 0.5f, -0.4f}, {-0.75f, 1.0f, -0.8f}};

    void map(const std::function<vec3(vec3)>& point, const std::function<vec3(vec3)>& direction)
    {
        for (vec3& p : scene.positions) p = point(p);
        for (vec3& n : scene.normals) n = direction(n);
        for (vec3& p : probes) p = point(p);
        for (Camera& camera : scene.cameras)
        {
            camera.eye = point(camera.eye);
            camera.forward = direction(camera.forward);
            camera.up = direction(camera.up);
        }
    }
};

/// All samples of the lamp: fewer lie elsewhere when its triangles are said otherwise.
DeviceSceneDesc samples()
{
    DeviceSceneDesc desc = fewSamples();
    desc.light.emitterSamples = 128;
    return desc;
}

// Where a pixel or none is another, by a rounding: another processor may bring it to three of the 2,304.
constexpr double kHardlyAPixel = 0.0013, kHardlyBrighter = 1.5e-4;
constexpr double kNoise = 0.0075; // of the mean light, with other random numbers; 0.0038 found

class MetamorphicPictures : public FrameTest
{
protected:
    RenderedFrame draw(const Picture& picture, uint32_t seed = 1)
    {
        BakeSettings bake;
        bake.resolution = 128;
        bake.bounces = 1;
        bake.scene = samples();
        bake.surfaceTexels = 26;
        const auto field = bakeOnce(picture.scene, picture.probes, bake);
        EXPECT_TRUE(field) << field.error().message;
        const auto device = DeviceScene::create(gpu(), picture.scene, field->info, samples());
        const auto light = makeLightField(gpu(), *field);
        EXPECT_TRUE(device && light);
        RenderSettings settings;
        settings.width = kWidth;
        settings.height = kHeight;
        settings.glossyRays = 16;
        settings.areaSamples = 128;
        settings.seed = seed;
        const auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        EXPECT_TRUE(renderer);
        auto frame = (*renderer)->render(picture.scene.cameras.front());
        EXPECT_TRUE(frame) << frame.error().message;
        return std::move(*frame);
    }

    const RenderedFrame& plain()
    {
        static const RenderedFrame frame = draw({});
        return frame;
    }

    /// @param other    share of the pixels whose light may differ by more than 5 % of the picture's mean
    /// @param brighter  by how much the mean may differ, relative
    void expectLikePlain(const std::string& name, const RenderedFrame& got, double other, double brighter, bool mirrored = false)
    {
        const double typical = mean(plain().diffuseIndirect) + mean(plain().glossyIndirect);
        size_t different = 0;
        double sum = 0.0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
            {
                const size_t a = size_t(y) * kWidth + x, b = size_t(y) * kWidth + (mirrored ? kWidth - 1 - x : x);
                const vec3 off = glm::abs(got.beauty[b] - plain().beauty[a]);
                different += !(std::max({off.x, off.y, off.z}) <= 0.05 * typical);
            }
        sum = (mean(got.diffuseIndirect) + mean(got.glossyIndirect)) / typical - 1.0;
        expectAtMost("picture, " + name + ": share of pixels that differ", got.beauty.size(), double(different) / double(got.beauty.size()),
                     other);
        expectAtMost("picture, " + name + ": change of the mean indirect light", got.beauty.size(), std::abs(sum), brighter);
    }
};

TEST_F(MetamorphicPictures, ScaledByPowersOfTwo)
{
    for (const float scale : {0x1p-11f, 0x1p16f}) // the box of 2 m as one of 1 mm and of 131 km
    {
        Picture scaled;
        scaled.map([&](vec3 p) { return scale * p; }, [](vec3 d) { return d; });
        const RenderedFrame frame = draw(scaled);
        size_t other = 0;
        for (size_t i = 0; i < frame.beauty.size(); ++i) other += frame.beauty[i] != plain().beauty[i];
        expectAtMost(std::string("picture, scaled by ") + (scale < 1.0f ? "2^-11, to 1 mm" : "2^16, to 131 km") +
                         ": pixels with another bit",
                     frame.beauty.size(), double(other), 0.0);
    }
}

TEST_F(MetamorphicPictures, MovedTurnedMirrored)
{
    Picture moved;
    moved.map([](vec3 p) { return p + vec3(37.0f, -12.5f, 8.25f); }, [](vec3 d) { return d; });
    expectLikePlain("moved by (37, -12.5, 8.25) m", draw(moved), kHardlyAPixel, kHardlyBrighter);

    expectLikePlain("as it is, with other random numbers", draw({}, 2), 0.2, kNoise); // what a mirrored picture can't do better than

    Picture turned;
    const auto quarter = [](vec3 p) { return vec3(p.z, p.y, -p.x); };
    turned.map(quarter, quarter);
    expectLikePlain("turned by 90 degrees", draw(turned), 0.25, kNoise);

    Picture mirrored;
    const auto mirror = [](vec3 p) { return vec3(-p.x, p.y, p.z); };
    mirrored.map(mirror, mirror);
    for (uvec3& triangle : mirrored.scene.triangles) std::swap(triangle.y, triangle.z);
    expectLikePlain("mirrored", draw(mirrored), 0.3, 0.0155, true);
}

TEST_F(MetamorphicPictures, OtherOrdersAndAProbeTwice)
{
    Picture shuffled;
    Random random(7, 0, 0);
    for (size_t i = shuffled.scene.triangles.size(); i > 1; --i)
    {
        const size_t j = random.below(uint32_t(i));
        std::swap(shuffled.scene.triangles[i - 1], shuffled.scene.triangles[j]);
        std::swap(shuffled.scene.triangleMaterial[i - 1], shuffled.scene.triangleMaterial[j]);
    }
    for (uvec3& t : shuffled.scene.triangles) t = uvec3(t.y, t.z, t.x);
    expectLikePlain("vertices and triangles in another order", draw(shuffled), 0.03, 0.003);

    Picture reversed;
    std::ranges::reverse(reversed.probes);
    expectLikePlain("probes in another order", draw(reversed), kHardlyAPixel, kHardlyBrighter);

    Picture doubled;
    doubled.probes.push_back(doubled.probes[2]);
    expectLikePlain("a probe twice", draw(doubled), kHardlyAPixel, kHardlyBrighter);
}

} // namespace
} // namespace sconce
