// Only the effects that a scene calls for, on the tiles that need them, and the same picture to the bit.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "runtime/frame/effect_plan.h"
#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

using namespace testing_support;

class EffectsTest : public FrameTest
{
protected:
    struct Drawn
    {
        RenderedFrame frame;
        uint64_t bytes = 0;
    };
    Drawn draw(const Scene& scene, const FieldData& field, std::string_view wanted, uint32_t width, uint32_t height, bool traced = false)
    {
        RenderSettings settings;
        settings.width = width;
        settings.height = height;
        settings.effects = planEffects(checkScene(scene), wanted)->indirect();
        settings.effects.tracedDiffuse = traced;
        auto device = DeviceScene::create(gpu(), scene, field.info);
        auto light = makeLightField(gpu(), field);
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        EXPECT_TRUE(renderer);
        auto frame = (*renderer)->render(scene.cameras.front());
        EXPECT_TRUE(frame);
        return {std::move(*frame), (*renderer)->deviceBytes()};
    }
    static std::set<std::string> passesOf(const RenderedFrame& frame)
    {
        std::set<std::string> names;
        for (const auto& scope : frame.times) names.insert(scope.name);
        return names;
    }
};

/// A room with a floor whose roughness crosses every border, a mirror and a metal.
Scene mixedRoom()
{
    Scene scene;
    scene.name = "mixed";
    MeshBuilder mesh(scene);
    mesh.box(vec3(-2, -0.2f, -2), vec3(2, 0, 2), mesh.material("floor", vec3(0.6f), 0.6f));
    mesh.box(vec3(-1.5f, 0, -1.5f), vec3(-0.5f, 1, -0.5f), mesh.material("glossy", vec3(0.8f, 0.3f, 0.2f), 0.2f));
    mesh.box(vec3(-0.4f, 0, -1.5f), vec3(0.4f, 1, -0.9f), mesh.material("between", vec3(0.3f, 0.8f, 0.2f), 0.4f));
    mesh.box(vec3(0.6f, 0, -1.5f), vec3(1.4f, 1.2f, -0.9f), mesh.material("mirror", vec3(0.9f), 0.0f, 1.0f));
    mesh.box(vec3(0.2f, 0, 0), vec3(0.8f, 0.6f, 0.5f), mesh.material("rough metal", vec3(0.9f, 0.7f, 0.3f), 0.7f, 1.0f));
    mesh.box(vec3(-1, 2.2f, -1), vec3(1, 2.3f, 1), mesh.emitter("lamp", vec3(6.0f)));
    mesh.camera("view", vec3(0.3f, 1.4f, 3.0f), vec3(0, 0.4f, -0.5f), 50.0f);
    scene.sky = vec3(0.3f, 0.4f, 0.5f);
    return scene;
}

const std::vector<vec3> kProbes = {{0.0f, 1.5f, 0.5f}, {-1.0f, 0.6f, 0.6f}, {1.2f, 0.7f, -0.4f}, {0.0f, 1.4f, -1.2f}};

TEST_F(EffectsTest, AutoIsAllToTheBit)
{
    for (const Scene& scene : {*makeBuiltinScene("cornell"), *makeBuiltinScene("cornell-glossy"), mixedRoom()})
    {
        const auto field = bakeField(scene, kProbes);
        ASSERT_TRUE(field) << field.error().message;
        for (const auto& [width, height] : {std::pair{96u, 64u}, {61u, 45u}})
        {
            const Drawn some = draw(scene, *field, "auto", width, height), all = draw(scene, *field, "all", width, height);
            EXPECT_EQ(some.frame.beauty, all.frame.beauty) << scene.name;
            EXPECT_EQ(some.frame.diffuseIndirect, all.frame.diffuseIndirect) << scene.name;
            EXPECT_EQ(some.frame.glossyIndirect, all.frame.glossyIndirect) << scene.name;
            EXPECT_EQ(some.frame.counts, all.frame.counts) << scene.name;
            EXPECT_TRUE(scene.name == "mixed" || some.bytes < all.bytes) << scene.name << " does not call for mirrors";
        }
    }
}

TEST_F(EffectsTest, TracedDiffuseLightTakesThePlaceOfIrradianceAndOfAreaLight)
{
    const Scene scene = mixedRoom();
    const auto field = bakeField(scene, kProbes);
    ASSERT_TRUE(field) << field.error().message;
    const Drawn some = draw(scene, *field, "auto", 61, 45, true), all = draw(scene, *field, "all", 61, 45, true);
    EXPECT_TRUE(some.frame.beauty == all.frame.beauty && some.frame.counts == all.frame.counts) << "to the bit";
    EXPECT_FALSE(some.frame.diffuseIndirect == draw(scene, *field, "auto", 61, 45).frame.diffuseIndirect);
    const std::set<std::string> passes = passesOf(some.frame);
    EXPECT_TRUE(passes.contains("diffuse trace"));
    EXPECT_FALSE(passes.contains("area light")) << "rays see emitters and sky";
    EXPECT_TRUE(passes.contains("gather light")) << "of the rough reflections";
    EXPECT_FALSE(passesOf(draw(scene, *field, "diffuse", 61, 45, true).frame).contains("gather light"));
}

TEST_F(EffectsTest, WhatIsNotCalledForHasNoPassAndNoBytes)
{
    const Scene scene = *makeBuiltinScene("cornell"); // nothing smoother than roughness 1
    BakeSettings bake;
    bake.resolution = 64;
    const EffectPlan plan = *planEffects(checkScene(scene));
    bake.radiance = plan.needsRadiance();
    bake.prefiltered = plan.needsPrefiltered();
    const auto field = bakeOnce(scene, kProbes, bake);
    ASSERT_TRUE(field);
    EXPECT_TRUE(field->radiance.empty());
    EXPECT_FALSE(field->prefiltered.empty());
    const std::set<std::string> passes = passesOf(draw(scene, *field, "auto", 64, 64).frame);
    for (const char* pass : {"glossy trace", "glossy denoise", "mirror trace"}) EXPECT_FALSE(passes.contains(pass)) << pass;
    EXPECT_TRUE(passes.contains("gather light"));
    const std::set<std::string> none = passesOf(draw(scene, *field, "none", 64, 64).frame);
    EXPECT_EQ(none, (std::set<std::string>{"G-buffer", "direct light", "compose"}));
}

// Shadow maps of emitters and sky were made for frames without diffuse light, too: 192 MiB.
TEST_F(EffectsTest, FramesWithoutAreaLightHaveNoShadowMapsOfIt)
{
    const Scene scene = mixedRoom();
    const auto field = bakeField(scene, kProbes, 64, 0);
    ASSERT_TRUE(field) << field.error().message;
    RenderSettings settings = settingsOf(32);
    settings.effects.diffuse = false;
    const auto light = makeLightField(gpu(), *field);
    std::vector<vec3> pictures[2];
    uint64_t bytes[2] = {};
    for (int bare = 0; bare < 2; ++bare)
    {
        gpu().releaseStaging(); // the scene's bytes are what the device has more than before
        const auto device =
            DeviceScene::create(gpu(), scene, field->info, bare ? sceneForFrames(settings.effects, field->info) : DeviceSceneDesc{});
        ASSERT_TRUE(device) << device.error().message;
        if (bare)
        {
            EXPECT_TRUE(device->lights().lights.empty());
        }
        bytes[bare] = device->deviceBytes();
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        ASSERT_TRUE(renderer);
        pictures[bare] = (*renderer)->render(scene.cameras.front())->beauty;
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    const LightSettings maps;
    const uint64_t emitters = uint64_t(maps.emitterSamples) * 6 * maps.emitterShadow * maps.emitterShadow * 4,
                   sky = uint64_t(maps.skySamples) * maps.skyShadow * maps.skyShadow * 2;
    EXPECT_GT(bytes[0] - bytes[1], emitters + sky - 1024);
    settings.effects.diffuse = settings.effects.tracedDiffuse = true;
    EXPECT_EQ(sceneForFrames(settings.effects, field->info).light.emitterSamples, 0u) << "rays see emitters";
}

TEST_F(EffectsTest, ShadowRaysThroughTheFieldNeedNoMapsAndGiveTheSameLight)
{
    const Scene scene = *makeBuiltinScene("cornell-glossy");
    const auto field = bakeField(scene, kProbes, 128, 0, 0);
    ASSERT_TRUE(field) << field.error().message;
    const auto light = makeLightField(gpu(), *field);
    RenderSettings settings = settingsOf(64);
    settings.areaSamples = 64;
    double means[2] = {};
    uint64_t bytes[2] = {};
    for (const bool traced : {false, true})
    {
        settings.effects.fieldShadows = traced;
        const auto device = DeviceScene::create(gpu(), scene, field->info, sceneForFrames(settings.effects, field->info));
        ASSERT_TRUE(device) << device.error().message;
        bytes[traced] = device->deviceBytes();
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        ASSERT_TRUE(renderer) << renderer.error().message;
        const auto frame = (*renderer)->render(scene.cameras.front());
        ASSERT_TRUE(frame) << frame.error().message;
        for (const vec3& pixel : frame->diffuseIndirect) means[traced] += pixel.g;
        if (!traced) continue;
        settings.effects.fieldShadows = false;
        const auto refused = SceneRenderer::create(gpu(), *device, *light, settings);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message.find("no shadow maps"), std::string::npos);
    }
    EXPECT_NEAR(means[1] / means[0], 1.0, 0.03);
    const LightSettings maps;
    EXPECT_GT(bytes[0] - bytes[1], uint64_t(maps.emitterSamples) * 6 * maps.emitterShadow * maps.emitterShadow * 4 / 2)
        << "less 1024 entries of the list";
}

TEST_F(EffectsTest, AnEffectWhoseMapsAreNotThereIsRefusedWithASentence)
{
    const Scene scene = *makeBuiltinScene("cornell");
    auto field = bakeField(scene, std::span(kProbes).first(1), 64);
    ASSERT_TRUE(field);
    field->prefiltered.clear();
    const auto frame = drawWith(*field, scene, settingsOf(32));
    ASSERT_FALSE(frame);
    EXPECT_NE(frame.error().message.find("'rough'"), std::string::npos);
}

TEST_F(EffectsTest, RaysAreTracedWhereGlossyPixelsAreAndNowhereElse)
{
    const Scene scene = mixedRoom();
    const auto field = bakeField(scene, kProbes);
    ASSERT_TRUE(field);
    const RenderedFrame frame = draw(scene, *field, "auto", 96, 64).frame;
    size_t traced = 0, wrong = 0;
    for (size_t i = 0; i < frame.counts.size(); ++i)
    {
        const bool smooth = frame.depth[i] > 0.0f && frame.roughness[i] < gpu::kRaysBelow + gpu::kRaysBlend;
        traced += frame.counts[i].z > 0;
        wrong += !smooth && frame.counts[i].z > 0;
    }
    EXPECT_GT(traced, 300u);
    EXPECT_LT(traced, frame.counts.size() / 2);
    EXPECT_EQ(wrong, 0u);
}

} // namespace
} // namespace sconce
