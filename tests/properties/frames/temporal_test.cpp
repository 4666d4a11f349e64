// The filter over time: still pictures converge, moving ones neither flicker nor ghost, a cut forgets.
#include <cmath>

#include <gtest/gtest.h>

#include "runtime/bake/group_bake.h"
#include "runtime/field/light_groups.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 72; // pixels
const std::vector<vec3> kProbes = {{0.0f, 1.5f, 0.5f}, {-0.8f, 0.5f, 0.6f}, {0.8f, 0.5f, -0.4f}, {-0.75f, 1.0f, -0.8f}};

class TemporalTest : public FrameTest
{
protected:
    void SetUp() override
    {
        auto baked = bakeField(scene, kProbes);
        ASSERT_TRUE(baked) << baked.error().message;
        device.emplace(std::move(*DeviceScene::create(gpu(), scene, baked->info)));
        field.emplace(std::move(*makeLightField(gpu(), *baked)));
    }
    void TearDown() override
    {
        field.reset();
        device.reset();
    }
    std::unique_ptr<SceneRenderer> renderer(bool temporal, uint32_t rays = 1)
    {
        RenderSettings settings = settingsOf(kSide);
        settings.effects.temporal = temporal;
        settings.glossyRays = rays;
        settings.areaSamples = 8 * rays;
        auto made = SceneRenderer::create(gpu(), *device, *field, settings);
        EXPECT_TRUE(made);
        return std::move(*made);
    }
    /// The camera after a number of steps of a tenth of a pixel to the side, by turning.
    Camera turned(float steps) const
    {
        Camera camera = scene.cameras.front();
        const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
        const float pixel = 2.0f * std::tan(0.5f * camera.verticalFov) / float(kSide);
        camera.forward = glm::normalize(camera.forward + 0.1f * pixel * steps * right);
        return camera;
    }
    static double difference(const RenderedFrame& a, const RenderedFrame& b)
    {
        double sum = 0.0;
        for (size_t i = 0; i < a.beauty.size(); ++i)
            for (int c = 0; c < 3; ++c)
                sum += std::abs(std::min(a.beauty[i][c], 2.0f) - std::min(b.beauty[i][c], 2.0f)); // the lamp's edge moves in both alike
        return sum / double(3 * a.beauty.size());
    }

    const Scene scene = *makeBuiltinScene("cornell-glossy");
    std::optional<DeviceScene> device;
    std::optional<LightField> field;
};

TEST_F(TemporalTest, AStillPictureConverges)
{
    const auto truth = renderer(false, 64)->render(scene.cameras.front());
    const auto many = renderer(true);
    Result<RenderedFrame> frame = many->render(scene.cameras.front(), 0);
    const double first = difference(*frame, *truth);
    for (uint32_t i = 1; i < 24; ++i) frame = many->render(scene.cameras.front(), i);
    ASSERT_TRUE(frame && truth);
    EXPECT_LT(difference(*frame, *truth), 0.6 * first);
}

// Told that light has changed, a history forgets what was in eight frames; untold, it holds on to it.
TEST_F(TemporalTest, ASwitchedLightIsThereWithinEightFrames)
{
    Scene lit = scene;
    lit.sky = vec3(0.4f);
    BakeSettings bake;
    bake.resolution = 64;
    bake.bounces = 2;
    bake.surfaceTexels = kFewTexels;
    BakeReport report;
    const std::vector<vec3> probes = {{0.0f, 1.5f, 0.5f}, {-0.8f, 0.5f, 0.6f}};
    const auto baked = bakeLightGroups(gpu(), lit, probes, bake, {{"lamp", {"emitters"}}, {"sky", {"sky"}}}, {}, report);
    ASSERT_TRUE(baked) << baked.error().message;
    field.emplace(std::move(*makeLightField(gpu(), *baked)));
    auto groups = makeLightGroups(gpu(), *field, *baked);
    ASSERT_TRUE(groups);
    const auto lightBy = [&](float lamp)
    {
        EXPECT_TRUE(groups->set(std::vector<vec3>{vec3(lamp), vec3(1.0f)}));
        EXPECT_TRUE(gpu().submit([&](VkCommandBuffer cmd) { groups->record(cmd); }));
    };
    const Camera& camera = scene.cameras.front();
    const auto glossyOf = [](const RenderedFrame& frame)
    {
        double sum = 0.0;
        for (const vec3& light : frame.glossyIndirect) sum += double(light.g);
        return sum;
    };
    lightBy(0.0f);
    const double off = glossyOf(*renderer(false, 64)->render(camera));
    for (const bool told : {true, false})
    {
        lightBy(1.0f);
        const auto blended = renderer(true, 4);
        double on = 0.0, left = 0.0;
        for (uint32_t i = 0; i < 32; ++i) on = glossyOf(*blended->render(camera, i));
        lightBy(0.0f);
        if (told) blended->lightChanged();
        for (uint32_t i = 0; i < gpu::kChangeFrames; ++i) left = glossyOf(*blended->render(camera, 32 + i));
        const double share = (left - off) / (on - off); // of the lamp's light
        EXPECT_GT(on, 1.5 * off) << "there is something to tell";
        if (told)
            EXPECT_LT(std::abs(share), 0.06) << "(2/3)^8 and the noise of a frame";
        else
            EXPECT_GT(share, 0.3);
    }
}

TEST_F(TemporalTest, AMovingPictureFlickersAtMostHalfMoreThanTheScene)
{
    const auto baked = bakeByTriangles(scene, kProbes, bakeOf(128, 2, knobs::surfaceTexels.value));
    ASSERT_TRUE(baked) << baked.error().message;
    field.emplace(std::move(*makeLightField(gpu(), *baked)));
    const auto blended = renderer(true), alone = renderer(false), many = renderer(false, 64);
    double flicker = 0.0, without = 0.0, own = 0.0;
    std::optional<RenderedFrame> before, beforeAlone, beforeMany;
    constexpr uint32_t kFrames = 64, kCounted = 16; // history has settled when counting starts
    for (uint32_t i = 0; i < kFrames; ++i)
    {
        auto now = blended->render(turned(float(i)), i);
        ASSERT_TRUE(now);
        if (i + kCounted >= kFrames)
        {
            auto nowAlone = alone->render(turned(float(i)), i), nowMany = many->render(turned(float(i)));
            if (beforeMany)
            {
                flicker += difference(*now, *before);
                without += difference(*nowAlone, *beforeAlone);
                own += difference(*nowMany, *beforeMany);
            }
            beforeAlone = std::move(*nowAlone);
            beforeMany = std::move(*nowMany);
        }
        before = std::move(*now);
    }
    RecordProperty("without", std::to_string(without / own));
    expectAtMost("camera turning by a tenth of a pixel a frame: change from frame to frame, times the noiseless picture's",
                 size_t(kCounted - 1) * kSide * kSide, flicker / own, 1.5);
}

// A lobe's tail finds the lamp with few rays of many, and what these bring is spread over the frames that follow, not cut off.
TEST_F(TemporalTest, ReflectionsKeepTheLightThatFewRaysFind)
{
    Scene room;
    MeshBuilder mesh(room);
    const uint32_t white = mesh.material("white", vec3(0.7f)), board = mesh.material("board", vec3(0.9f), 0.2f, 1.0f);
    mesh.box({-1.1f, -0.1f, -1.1f}, {1.1f, 0, 1.1f}, white);
    mesh.box({-1.1f, 2, -1.1f}, {1.1f, 2.1f, 1.1f}, white);
    mesh.box({-1.1f, 0, -1.1f}, {-1, 2, 1.1f}, white);
    mesh.box({1, 0, -1.1f}, {1.1f, 2, 1.1f}, white);
    mesh.box({-1, 0, 1}, {1, 2, 1.1f}, white);
    mesh.box({-1, 0, -1.1f}, {1, 2, -1}, board);
    mesh.quad({-0.1f, 1.98f, -0.1f}, {0.1f, 1.98f, -0.1f}, {0.1f, 1.98f, 0.1f}, {-0.1f, 1.98f, 0.1f}, mesh.emitter("lamp", vec3(60.0f)));
    mesh.camera("board", {0.4f, 1.0f, 0.8f}, {-0.1f, 1.0f, -1.0f}, 50.0f);
    const auto baked = bakeByTriangles(room, std::vector<vec3>{{0.5f, 1.5f, 0.5f}, {-0.6f, 0.6f, -0.3f}}, bakeOf(256));
    ASSERT_TRUE(baked) << baked.error().message;
    device.emplace(std::move(*DeviceScene::create(gpu(), room, baked->info)));
    field.emplace(std::move(*makeLightField(gpu(), *baked)));
    const auto lightOf = [](const RenderedFrame& frame)
    {
        double sum = 0.0;
        for (const vec3& light : frame.glossyIndirect) sum += double(light.g);
        return sum;
    };
    for (const float step : {0.0f, 0.02f}) // metres a frame
    {
        const auto blended = renderer(true), alone = renderer(false), many = renderer(false, 64);
        double ours = 0.0, theirs = 0.0, error = 0.0, errorAlone = 0.0;
        constexpr uint32_t kFrames = 48;
        for (uint32_t i = 0; i < kFrames; ++i)
        {
            Camera camera = room.cameras.front();
            camera.eye.x -= step * float(i);
            const auto now = blended->render(camera, i);
            ASSERT_TRUE(now);
            if (i % 8 != 7 || i < 16) continue;
            const auto truth = many->render(camera), fresh = alone->render(camera, i);
            ASSERT_TRUE(truth && fresh);
            ours += lightOf(*now);
            theirs += lightOf(*truth);
            error += difference(*now, *truth);
            errorAlone += difference(*fresh, *truth);
        }
        const std::string what = step > 0.0f ? "moving" : "still";
        RecordProperty(what + ": light, error times a frame's", std::to_string(ours / theirs) + " " + std::to_string(error / errorAlone));
        EXPECT_NEAR(ours / theirs, 1.0, 0.04) << what
                                              << ": a clamp to what is about a pixel leaves 0.80 of it"; // the noise of four frames is 0.03
        EXPECT_LT(error, errorAlone) << what;
    }
}

// A room of stripes about a smooth metal, whose reflections go another way than what is mirrored in a plane: of a retroreflective wall they
// lie behind the eye, in a ball just beneath its surface. Blended over time they are nearer to the truth than one frame's.
TEST_F(TemporalTest, ReflectionsAreFollowedWhereTheyGo)
{
    for (const bool ball : {false, true})
    {
        Scene room;
        MeshBuilder mesh(room);
        const uint32_t grey = mesh.material("grey", vec3(0.5f)), metal = mesh.material("metal", vec3(0.9f), 0.15f, 1.0f),
                       stripe = mesh.emitter("stripe", vec3(2.0f));
        mesh.box({-3.1f, -0.1f, -2.1f}, {3.1f, 0, 4.1f}, grey);
        mesh.box({-3.1f, 2, -2.1f}, {3.1f, 2.1f, 4.1f}, grey);
        mesh.box({-3.1f, 0, -2.1f}, {-3, 2, 4.1f}, grey);
        mesh.box({3, 0, -2.1f}, {3.1f, 2, 4.1f}, grey);
        mesh.box({-3, 0, 4}, {3, 2, 4.1f}, grey);
        mesh.box({-3, 0, -2.1f}, {3, 2, -2}, ball ? grey : metal);
        if (ball) mesh.sphere({0.2f, 1, -1}, vec3(0.6f), 64, 32, metal);
        for (float x = -2.75f; x < 2.5f; x += 0.5f)
            mesh.quad({x + 0.25f, 0, 3.99f}, {x, 0, 3.99f}, {x, 2, 3.99f}, {x + 0.25f, 2, 3.99f}, stripe);
        mesh.camera("metal", {0, 1, 0.5f}, {0, 1, -2}, 40.0f);
        room.materials[metal].retroreflective = !ball;
        const auto baked = bakeByTriangles(room, std::vector<vec3>{{-1.5f, 1.0f, 1.0f}, {1.5f, 1.0f, 1.0f}}, bakeOf(256));
        ASSERT_TRUE(baked) << baked.error().message;
        device.emplace(std::move(*DeviceScene::create(gpu(), room, baked->info)));
        field.emplace(std::move(*makeLightField(gpu(), *baked)));
        const auto aside = [&](uint32_t steps)
        {
            Camera camera = room.cameras.front();
            camera.eye.x += (ball ? 0.02f : 0.04f) * float(steps);
            return camera;
        };
        const auto blended = renderer(true), alone = renderer(false), many = renderer(false, 64);
        constexpr uint32_t kSteps = 12;
        for (uint32_t i = 0; i < kSteps; ++i) ASSERT_TRUE(blended->render(aside(i), i));
        const auto after = blended->render(aside(kSteps), kSteps), fresh = alone->render(aside(kSteps), kSteps),
                   truth = many->render(aside(kSteps));
        ASSERT_TRUE(after && fresh && truth);
        const double error = difference(*after, *truth) / difference(*fresh, *truth);
        RecordProperty(ball ? "ball: error of one frame's, times" : "sign: error of one frame's, times", std::to_string(error));
        EXPECT_LT(error, ball ? 0.7 : 1.0) << (ball ? "followed as in a plane 1.3" : "a sign");
    }
}

TEST_F(TemporalTest, WhatWasHiddenIsNotBlendedWithWhatHidIt)
{
    const auto blended = renderer(true), alone = renderer(false), many = renderer(false, 64);
    for (uint32_t i = 0; i < 12; ++i) ASSERT_TRUE(blended->render(scene.cameras.front(), i));
    Camera aside = scene.cameras.front();
    aside.eye.x += 0.4f; // the boxes move before the walls by many pixels
    const auto after = blended->render(aside, 12), fresh = alone->render(aside, 12), truth = many->render(aside);
    ASSERT_TRUE(after && fresh && truth);
    EXPECT_LT(difference(*after, *truth), 1.1 * difference(*fresh, *truth));
}

TEST_F(TemporalTest, AfterACutNothingIsLeftOfTheFramesBefore)
{
    const auto cut = renderer(true), fresh = renderer(true);
    for (uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(cut->render(turned(200.0f), i));
    cut->cut();
    const auto a = cut->render(scene.cameras.front(), 7), b = fresh->render(scene.cameras.front(), 7);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->beauty, b->beauty);
}

} // namespace
} // namespace sconce
