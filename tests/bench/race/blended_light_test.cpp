#include "bench/race/blended_light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/live_light.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

/// A closed room with a point light, baked with live links.
class BlendedLightTest : public testing::Test
{
protected:
    void SetUp() override
    {
        Scene scene;
        scene.name = "closed box";
        MeshBuilder mesh(scene);
        mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("grey", vec3(0.5f)));
        scene.lights.push_back(test::light(LightType::point, {0.3f, 0.4f, -0.2f}, {0, -1, 0}, 3.0f));
        const auto rays = TriangleRays::build(scene);
        ASSERT_TRUE(rays);
        BakeSettings settings;
        settings.resolution = 64;
        settings.surfaceTexels = 26;
        settings.surfaceRefined = 0.0f;
        settings.octree.voxels = 16;
        settings.liveLinks = 16;
        settings.rays = &*rays;
        BakeReport report;
        auto baked = bakeLightGroups(device.gpu(), scene, std::vector<vec3>{{-0.1f, 0.1f, 0.2f}}, settings, {}, {}, report);
        ASSERT_TRUE(baked) << baked.error().message;
        field = std::move(*baked);
        auto onDevice = makeLightField(device.gpu(), field);
        ASSERT_TRUE(onDevice);
        auto live = makeLiveLight(device.gpu(), *onDevice, field);
        ASSERT_TRUE(live) << live.error().message;
        while (!live->settled()) ASSERT_TRUE(device.gpu().submit([&](VkCommandBuffer cmd) { live->record(cmd, {}); }));
        for (const auto& [buffer, words] : {std::pair{&live->state().direct, &direct}, {&live->state().bounced, &settled}})
        {
            words->resize(field.live.texels.size());
            ASSERT_TRUE(device.gpu().download(*buffer, 0, std::as_writable_bytes(std::span(*words))));
        }
    }
    static double mean(std::span<const vec3> light)
    {
        double sum = 0.0;
        for (const vec3& one : light) sum += double(one.g) / double(light.size());
        return sum;
    }
    std::vector<double> means(const BlendSettings& settings, int frames) const
    {
        BlendedLight light(field, direct, settings);
        std::vector<double> found;
        for (int frame = 0; frame < frames; ++frame)
        {
            light.frame();
            found.push_back(mean(light.bounced()));
        }
        return found;
    }

    testing_support::ValidatedDevice device;
    FieldData field;
    std::vector<uint32_t> direct, settled;
};

// Without blending a frame is a bounce, and it ends where the device's light does.
TEST_F(BlendedLightTest, EndsAtTheLightOfTheDevice)
{
    std::vector<vec3> light;
    for (const uint32_t word : settled) light.push_back(Text::unpackSharedExponent(word));
    ASSERT_GT(mean(light), 0.0);
    EXPECT_NEAR(means({0.0, 1.0}, 40).back(), mean(light), 0.01 * mean(light));
    EXPECT_NEAR(means({0.5, 5.0}, 80).back(), mean(light), 0.01 * mean(light)) << "whatever the blending";
}

// Light is linear: what is there after a frame is a binomial sum of what single bounces bring.
TEST_F(BlendedLightTest, FollowsTheRecurrenceOfItsHysteresis)
{
    constexpr int kFrames = 60;
    constexpr double kKept = 0.9;
    const std::vector<double> bounces = means({0.0, 1.0}, kFrames);
    std::vector<double> counted(kFrames + 1,
                                0.0); // of each bounce, the share that is there; the first is of direct light, which is all there
    const std::vector<double> blended = means({kKept, 1.0}, kFrames);
    for (int frame = 0; frame < kFrames; ++frame)
    {
        for (int bounce = kFrames; bounce > 0; --bounce)
            counted[size_t(bounce)] = kKept * counted[size_t(bounce)] + (1.0 - kKept) * (bounce == 1 ? 1.0 : counted[size_t(bounce) - 1]);
        double expected = 0.0;
        for (int bounce = 1; bounce <= kFrames; ++bounce)
            expected += counted[size_t(bounce)] * (bounces[size_t(bounce) - 1] - (bounce > 1 ? bounces[size_t(bounce) - 2] : 0.0));
        EXPECT_NEAR(blended[size_t(frame)], expected, 1e-3 * bounces.back()) << frame;
    }
    EXPECT_LT(blended[9], 0.7 * bounces.back()) << "ten frames are too few";
}

// What is black is replaced at once, as far as it isn't much brighter than that; then by more than its hysteresis says.
TEST_F(BlendedLightTest, DetectsChangesAsShipped)
{
    const double hysteresis = 0.97, gamma = 5.0;
    BlendedLight first(field, direct, {0.0, 1.0}), blended(field, direct, {hysteresis, gamma, true});
    first.frame(), blended.frame();
    for (size_t i = 0; i < first.bounced().size(); ++i)
    {
        const double arrived = std::pow(double(first.bounced()[i].g), 1.0 / gamma);
        const double expected = std::pow((arrived > 0.1 ? 0.25 : 1.0) * arrived, gamma); // of grey light luminance is any channel's
        EXPECT_NEAR(blended.bounced()[i].g, expected, 1e-3 * expected + 1e-9);
    }
    const std::vector<double> detected = means({hysteresis, gamma, true}, 100), plain = means({hysteresis, gamma}, 100);
    EXPECT_GT(detected[30], 2.0 * plain[30]);
    std::vector<vec3> light;
    for (const uint32_t word : settled) light.push_back(Text::unpackSharedExponent(word));
    EXPECT_NEAR(means({0.5, gamma, true}, 120).back(), mean(light), 0.01 * mean(light));
}

} // namespace
} // namespace sconce
