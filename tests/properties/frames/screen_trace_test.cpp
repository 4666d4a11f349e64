// Rays that meet what the picture of the frame before shows: what no field knows is reflected, and what it knows no worse.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "runtime/scene/shape_meshes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSide = 96; // pixels

/// A room with a lamp over most of its ceiling and a mirror on its floor. @param roughness  of the mirror
Scene room(float roughness = 0.0f)
{
    Scene scene;
    scene.name = "room with a mirroring floor";
    MeshBuilder mesh(scene);
    mesh.box({-2.0f, 0.0f, -2.0f}, {2.0f, 3.0f, 2.0f}, mesh.material("white", vec3(0.6f)));
    mesh.quad({-1.2f, 2.9f, -1.2f}, {1.2f, 2.9f, -1.2f}, {1.2f, 2.9f, 1.2f}, {-1.2f, 2.9f, 1.2f}, mesh.emitter("lamp", vec3(3.0f)));
    mesh.quad({-1.8f, 0.02f, 1.8f}, {1.8f, 0.02f, 1.8f}, {1.8f, 0.02f, -1.8f}, {-1.8f, 0.02f, -1.8f},
              mesh.material("mirror", vec3(0.9f), roughness, 1.0f));
    mesh.camera("view", {0.0f, 1.3f, 1.9f}, {0.0f, 0.6f, -1.0f}, 75.0f);
    return scene;
}

const std::vector<vec3> kProbes = {{0.0f, 1.5f, 1.2f}, {-1.2f, 1.0f, 0.3f}, {1.2f, 2.0f, 0.0f}, {0.3f, 1.2f, -1.3f}, {-0.8f, 2.2f, -1.0f}};

/// A crate that no field knows.
MovingShape crate()
{
    MovingShape made;
    made.kind = MovingShape::Kind::box;
    made.centre = vec3(0.3f, 0.45f, -0.7f);
    made.half = vec3(0.35f, 0.42f, 0.3f);
    made.turn = glm::angleAxis(0.5f, vec3(0.0f, 1.0f, 0.0f));
    made.albedo = vec3(0.6f, 0.2f, 0.1f);
    return made;
}

double luminance(const float* rgb)
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

class ScreenTrace : public testing_support::FrameTest
{
protected:
    static RenderSettings settings(bool asks)
    {
        RenderSettings made = settingsOf(kSide);
        made.effects.screenTrace = asks;
        return made;
    }
    FieldData fieldOf(const Scene& scene, const std::vector<vec3>& probes = kProbes)
    {
        auto baked = bakeByTriangles(scene, probes, bakeOf(128, 4));
        EXPECT_TRUE(baked) << baked.error().message;
        return std::move(*baked);
    }
    /// A renderer with what it needs to stay.
    struct Drawing
    {
        std::unique_ptr<Result<DeviceScene>> scene; // whose address the renderer keeps
        Result<LightField> light;
        Result<std::unique_ptr<SceneRenderer>> renderer;
    };
    Drawing start(const FieldData& field, const Scene& drawn, const RenderSettings& made)
    {
        auto scene = std::make_unique<Result<DeviceScene>>(DeviceScene::create(gpu(), drawn, field.info));
        auto light = makeLightField(gpu(), field);
        EXPECT_TRUE(*scene && light);
        auto renderer = SceneRenderer::create(gpu(), **scene, *light, made);
        EXPECT_TRUE(renderer) << renderer.error().message;
        return {std::move(scene), std::move(light), std::move(renderer)};
    }
    /// The last of some frames of a camera that stands still.
    RenderedFrame draw(const FieldData& field, const Scene& drawn, const RenderSettings& made, uint32_t frames)
    {
        const Drawing drawing = start(field, drawn, made);
        for (uint32_t i = 1; i < frames; ++i) EXPECT_TRUE((*drawing.renderer)->draw(drawn.cameras.front()));
        auto frame = (*drawing.renderer)->render(drawn.cameras.front());
        EXPECT_TRUE(frame);
        return std::move(*frame);
    }
    static std::vector<float> reflectionsOf(const Scene& scene)
    {
        ReferenceSettings reference;
        reference.width = reference.height = kSide;
        reference.samples = 192;
        reference.bounces = 8;
        reference.pixelCentre = true;
        reference.guides = false;
        reference.camera = scene.cameras.front();
        auto traced = renderReference(scene, reference);
        EXPECT_TRUE(traced) << traced.error().message;
        return traced->images.find("glossy_indirect")->pixels;
    }
};

TEST_F(ScreenTrace, WhatNoFieldKnowsIsReflected)
{
    const Scene empty = room();
    Scene furnished = room();
    const MovingShape untold = crate();
    addShapes(furnished, std::span(&untold, 1));
    const FieldData field = fieldOf(empty);
    const std::vector<float> truth = reflectionsOf(furnished), before = reflectionsOf(empty);
    const RenderedFrame asks = draw(field, furnished, settings(true), 3), none = draw(field, furnished, settings(false), 1);
    double left = 0.0, whole = 0.0;
    size_t pixels = 0;
    for (size_t i = 0; i < asks.depth.size(); ++i)
    {
        // A mirror's pixels whose reflection is another with the crate in the room: its front, seen in the floor before it.
        if (std::abs(luminance(&truth[3 * i]) - luminance(&before[3 * i])) < 0.2 * luminance(&before[3 * i]) || asks.roughness[i] > 0.0f)
            continue;
        ++pixels;
        left += std::abs(luminance(&asks.glossyIndirect[i].x) - luminance(&truth[3 * i]));
        whole += std::abs(luminance(&none.glossyIndirect[i].x) - luminance(&truth[3 * i]));
    }
    ASSERT_GT(pixels, 100u);
    RecordProperty("share_of_the_error_left", std::to_string(left / whole));
    EXPECT_LT(left, 0.3 * whole) << left / whole << " of the error, " << pixels << " pixels";
}

// Where the field knows all, the picture adds no fault: errors over the whole mirror.
TEST_F(ScreenTrace, WhatTheFieldKnowsIsNoWorse)
{
    for (const float roughness : {0.0f, 0.2f})
    {
        const Scene scene = room(roughness);
        const FieldData field = fieldOf(scene);
        const std::vector<float> truth = reflectionsOf(scene);
        const RenderedFrame asks = draw(field, scene, settings(true), 3), none = draw(field, scene, settings(false), 1);
        double with = 0.0, without = 0.0, light = 0.0, alone = 0.0, asked = 0.0;
        for (size_t i = 0; i < asks.depth.size(); ++i)
        {
            if (asks.roughness[i] > 0.3f) continue;
            const double right = luminance(&truth[3 * i]);
            with += std::abs(luminance(&asks.glossyIndirect[i].x) - right);
            without += std::abs(luminance(&none.glossyIndirect[i].x) - right);
            light += luminance(&asks.glossyIndirect[i].x);
            alone += luminance(&none.glossyIndirect[i].x);
            asked += right;
        }
        RecordProperty(roughness > 0.0f ? "rough_error_over_without" : "error_over_without", std::to_string(with / without));
        RecordProperty(roughness > 0.0f ? "rough_light" : "light",
                       std::to_string(light / asked) + ", without " + std::to_string(alone / asked));
        EXPECT_LT(with, without) << roughness << ": " << with / without;
        EXPECT_LT(std::abs(light - asked), std::abs(alone - asked)) << roughness;
    }
}

// There is no frame before the first one, nor after a cut.
TEST_F(ScreenTrace, AFirstFrameIsThatOfTheFieldAlone)
{
    const Scene scene = room();
    const FieldData field = fieldOf(scene);
    const RenderedFrame none = draw(field, scene, settings(false), 1);
    const Drawing drawing = start(field, scene, settings(true));
    const auto beauty = [&] { return (*drawing.renderer)->render(scene.cameras.front())->beauty; };
    EXPECT_EQ(beauty(), none.beauty);
    EXPECT_NE(beauty(), none.beauty);
    (*drawing.renderer)->cut();
    EXPECT_EQ(beauty(), none.beauty);
}

// The picture of the frame before is of another camera: what is shown is found where that saw it.
TEST_F(ScreenTrace, AMovingCameraFindsWhatTheFrameBeforeSaw)
{
    Scene furnished = room();
    const MovingShape untold = crate();
    addShapes(furnished, std::span(&untold, 1));
    const FieldData field = fieldOf(room());
    const Camera there = furnished.cameras.front();
    Camera before = there;
    before.eye += vec3(0.12f, 0.05f, 0.0f);
    before.forward = glm::normalize(before.forward + vec3(0.04f, 0.02f, 0.0f));
    const Drawing drawing = start(field, furnished, settings(true));
    ASSERT_TRUE((*drawing.renderer)->draw(before));
    const auto moved = (*drawing.renderer)->render(there);
    ASSERT_TRUE(moved);
    const RenderedFrame stood = draw(field, furnished, settings(true), 2), none = draw(field, furnished, settings(false), 1);
    double off = 0.0, shown = 0.0;
    for (size_t i = 0; i < stood.depth.size(); ++i)
    {
        if (stood.roughness[i] > 0.0f) continue;
        off += std::abs(luminance(&moved->glossyIndirect[i].x) - luminance(&stood.glossyIndirect[i].x));
        shown += std::abs(luminance(&none.glossyIndirect[i].x) - luminance(&stood.glossyIndirect[i].x));
    }
    RecordProperty("off", std::to_string(off / shown));
    EXPECT_LT(off, 0.25 * shown) << off / shown;
}

// Mirrors that face each other show what they showed before: each gives on less than it got.
TEST_F(ScreenTrace, FacingMirrorsNeitherBrightenNorDarken)
{
    Scene scene = room(1.0f);
    scene.cameras.clear();
    MeshBuilder mesh(scene);
    const uint32_t mirror = mesh.material("mirror of a wall", vec3(0.98f), 0.0f, 1.0f);
    mesh.quad({-1.95f, 0.1f, 1.5f}, {-1.95f, 0.1f, -1.9f}, {-1.95f, 2.6f, -1.9f}, {-1.95f, 2.6f, 1.5f}, mirror);
    mesh.quad({1.95f, 0.1f, -1.9f}, {1.95f, 0.1f, 1.5f}, {1.95f, 2.6f, 1.5f}, {1.95f, 2.6f, -1.9f}, mirror);
    mesh.camera("view", {0.0f, 1.3f, 1.9f}, {0.0f, 1.2f, -1.0f}, 90.0f);
    const FieldData field = fieldOf(scene);
    const std::vector<float> truth = reflectionsOf(scene);
    const Drawing drawing = start(field, scene, settings(true));
    double asked = 0.0;
    const auto light = [&]
    {
        const auto frame = (*drawing.renderer)->render(scene.cameras.front());
        EXPECT_TRUE(frame);
        double sum = 0.0;
        asked = 0.0;
        for (size_t i = 0; i < frame->depth.size(); ++i)
        {
            if (frame->roughness[i] > 0.0f) continue;
            sum += luminance(&frame->glossyIndirect[i].x);
            asked += luminance(&truth[3 * i]);
        }
        return sum;
    };
    const double alone = light();
    for (int i = 0; i < 10; ++i) light();
    const double soon = light();
    for (int i = 0; i < 60; ++i) light();
    const double later = light();
    RecordProperty("of_the_truth",
                   std::to_string(alone / asked) + " " + std::to_string(soon / asked) + " " + std::to_string(later / asked));
    EXPECT_NE(alone, soon);
    EXPECT_NEAR(later / soon, 1.0, 1e-3);
    EXPECT_NEAR(later / asked, 1.0, 0.05);
}

// A lamp is evaluated where its light falls; what the picture shows of it is in no reflection once more.
TEST_F(ScreenTrace, LampsAreNotReflectedTwice)
{
    Scene scene; // a shining floor under a square that is small from there, both in view
    MeshBuilder mesh(scene);
    mesh.quad({-7, 0, 7}, {7, 0, 7}, {7, 0, -7}, {-7, 0, -7}, mesh.material("floor", vec3(0.9f), 0.15f, 1.0f));
    mesh.quad({-0.25f, 6, -0.25f}, {0.25f, 6, -0.25f}, {0.25f, 6, 0.25f}, {-0.25f, 6, 0.25f}, mesh.emitter("lamp", vec3(100.0f)));
    mesh.camera("view", {0.0f, 1.2f, 6.8f}, {0.0f, 0.6f, 0.0f}, 100.0f);
    const FieldData field = fieldOf(scene, {{0.0f, 2.0f, 0.0f}, {3.0f, 3.0f, 3.0f}, {-3.0f, 1.5f, 2.0f}});
    ASSERT_EQ(field.lamps.size(), 1u);
    const std::vector<float> truth = reflectionsOf(scene);
    const RenderedFrame asks = draw(field, scene, settings(true), 3), none = draw(field, scene, settings(false), 1);
    double light = 0.0, without = 0.0, asked = 0.0;
    for (size_t i = 0; i < asks.depth.size(); ++i)
    {
        if (asks.roughness[i] > 0.3f) continue;
        light += luminance(&asks.glossyIndirect[i].x);
        without += luminance(&none.glossyIndirect[i].x);
        asked += luminance(&truth[3 * i]);
    }
    RecordProperty("of_the_truth", std::to_string(light / asked) + " " + std::to_string(without / asked));
    EXPECT_NEAR(light / without, 1.0, 0.02);
}

} // namespace
} // namespace sconce
