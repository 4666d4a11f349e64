// The path tracer with our filters: nothing but its noise goes.
#include <gtest/gtest.h>

#include "bench/opponents/traced_picture.h"
#include "bench/reference/metrics.h"
#include "bench/reference/reference.h"
#include "bench/sweep/picture_files.h"
#include "scene/mesh_builder.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 96, kHeight = 64, kPaths = 4;

/// Matt, glossy and mirroring boxes on a floor, under a lamp and a sky.
Scene boxes()
{
    Scene scene;
    scene.name = "boxes";
    MeshBuilder mesh(scene);
    mesh.box(vec3(-2, -0.2f, -2), vec3(2, 0, 2), mesh.material("floor", vec3(0.6f), 0.9f));
    mesh.box(vec3(-1.5f, 0, -1.5f), vec3(-0.5f, 1, -0.5f), mesh.material("glossy", vec3(0.8f, 0.3f, 0.2f), 0.4f));
    mesh.box(vec3(0.6f, 0, -1.5f), vec3(1.4f, 1.2f, -0.9f), mesh.material("mirror", vec3(0.9f), 0.0f, 1.0f));
    mesh.box(vec3(-1, 2.2f, -1), vec3(1, 2.3f, 1), mesh.emitter("lamp", vec3(6.0f)));
    mesh.camera("view", vec3(0.3f, 1.4f, 3.0f), vec3(0, 0.4f, -0.5f), 50.0f);
    scene.sky = vec3(0.3f, 0.4f, 0.5f);
    return scene;
}

ImageSet traced(const Scene& scene, uint32_t paths, uint64_t seed)
{
    ReferenceSettings settings;
    settings.bounces = 2;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.samples = paths;
    settings.seed = seed;
    settings.pixelCentre = true;
    settings.camera = scene.cameras.front();
    return std::move(renderReference(scene, settings)->images);
}

RenderedFrame shown(const Scene& scene, const ImageSet& paths)
{
    testing_support::ValidatedDevice device;
    const FieldData field = tracedPicture(scene, paths);
    RenderSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    showPaths(settings, kPaths);
    auto light = makeLightField(device.gpu(), field);
    auto uploaded = DeviceScene::create(device.gpu(), scene, field.info, sceneForFrames(settings.effects, field.info));
    EXPECT_TRUE(light && uploaded);
    auto renderer = SceneRenderer::create(device.gpu(), *uploaded, *light, settings);
    EXPECT_TRUE(renderer) << renderer.error().message;
    auto frame = (*renderer)->render(scene.cameras.front());
    EXPECT_TRUE(frame) << frame.error().message;
    return std::move(*frame);
}

TEST(TracedPicture, FiltersTakeNoiseAndKeepLightAndMirrors)
{
    const Scene scene = boxes();
    const ImageSet truth = traced(scene, 2048, 1), paths = traced(scene, kPaths, 2);
    const RenderedFrame frame = shown(scene, paths);
    const ImageSet filtered = lightLayers(frame);
    for (const auto& [layer, left] : {std::pair{"diffuse_indirect", 0.10}, {"glossy_indirect", 0.32}})
    {
        CompareSettings settings;
        settings.layer = layer;
        const auto before = compareImages(paths, truth, settings), after = compareImages(filtered, truth, settings);
        ASSERT_TRUE(before && after);
        EXPECT_LT(*after->relMse, left * *before->relMse) << layer; // found: 0.077 and 0.269
        EXPECT_NEAR(*after->mean, *before->mean, 0.008) << layer;
    }
    // A mirror is not filtered: what comes out of device, passes and composition is what went in, to half of a half float's step.
    size_t mirrors = 0;
    for (size_t i = 0; i < frame.depth.size(); ++i)
    {
        if (!(frame.depth[i] > 0.0f && frame.roughness[i] == 0.0f)) continue;
        ++mirrors;
        for (int c = 0; c < 3; ++c)
        {
            const float given = paths.find("glossy_indirect")->pixels[3 * i + size_t(c)];
            EXPECT_NEAR(frame.glossyIndirect[i][c], given, given / 2048.0f + 1e-7f) << i;
        }
    }
    EXPECT_GT(mirrors, 100u);
}

} // namespace
} // namespace sconce
