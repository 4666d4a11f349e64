// Where rays meet the picture, against Embree: everything is a mirror, the field knows nothing, and the frame before was white, so that
// what a pixel reflects is how sure its ray is.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 240, kHeight = 135; // pixels

Scene mirrored(Scene scene)
{
    for (Material& material : scene.materials)
    {
        Material mirror;
        mirror.name = material.name;
        mirror.baseColor = vec4(1.0f);
        mirror.metallic = 1.0f;
        mirror.roughness = 0.0f;
        material = mirror;
    }
    scene.lights.clear();
    scene.sky = vec3(0.0f);
    return scene;
}

/// Of the same bounds, with nothing in them that a ray would meet.
Scene boundsOf(const Scene& scene)
{
    const vec3 low = scene.bounds().low, high = scene.bounds().high;
    Scene bounds;
    bounds.name = scene.name;
    MeshBuilder mesh(bounds);
    const uint32_t dust = mesh.material("dust", vec3(0.5f));
    const vec3 size = 1e-4f * (high - low);
    for (const vec3& corner : {low, high})
    {
        const vec3 inwards = corner == low ? size : -size;
        mesh.triangle(corner, corner + vec3(inwards.x, 0.0f, 0.0f), corner + vec3(0.0f, inwards.y, inwards.z), dust);
    }
    return bounds;
}

class ScreenRays : public testing_support::FrameTest
{
};

TEST_F(ScreenRays, WhatIsSureIsMetThere)
{
    struct Case
    {
        const char* scene;
        double answered, right; // at least, shares: of all rays; of those answered, but for what lies beyond the truth, which a field knows
    };
    for (const Case& asked :
         {Case{"cornell-glossy", 0.69, 0.99}, Case{"temple", 0.31, 0.97}, Case{"hall", 0.43, 0.965}, Case{"town", 0.21, 0.97}})
    {
        const Scene scene = mirrored(*makeBuiltinScene(asked.scene));
        const auto field = bakeField(boundsOf(scene), std::vector<vec3>{scene.cameras.front().eye}, 64, 0);
        ASSERT_TRUE(field) << field.error().message;
        const auto light = makeLightField(gpu(), *field);
        const auto device = DeviceScene::create(gpu(), scene, field->info);
        const auto rays = TriangleRays::build(scene);
        ASSERT_TRUE(light && device && rays);
        RenderSettings settings;
        settings.width = kWidth;
        settings.height = kHeight;
        settings.effects = {.diffuse = false, .rough = false, .glossy = false, .mirror = true, .denoise = false};
        const auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        ASSERT_TRUE(renderer) << renderer.error().message;
        const Camera& camera = scene.cameras.front();
        const auto frame = (*renderer)->render(camera);
        ASSERT_TRUE(frame);
        const FramePictures drawn = (*renderer)->pictures();
        const GpuImage white = image(std::vector<glm::vec4>(size_t(kWidth) * kHeight, glm::vec4(1.0f)), kWidth, "white picture");

        IndirectLight::Desc desc{.width = kWidth, .height = kHeight, .effects = settings.effects};
        desc.effects.screenTrace = true;
        auto indirect = makeIndirectLight(gpu(), *light, desc);
        ASSERT_TRUE(indirect) << indirect.error().message;
        indirect->setInputs({.depth = drawn.depth->view(),
                             .normalRoughness = drawn.normalRoughness->view(),
                             .baseColorMetallic = drawn.baseColorMetallic->view(),
                             .pictureBefore = white.view()});
        const vec3 forward = glm::normalize(camera.forward), right = glm::normalize(glm::cross(forward, camera.up)),
                   up = glm::cross(right, forward);
        const float tangent = std::tan(0.5f * camera.verticalFov), aspect = float(kWidth) / float(kHeight), scale = drawn.depthScale;
        gpu::FrameView view = light->frameView(kWidth, kHeight);
        view.worldFromClip =
            mat4(vec4(scale * tangent * aspect * right, 0), vec4(-scale * tangent * up, 0), vec4(camera.eye, 1), vec4(scale * forward, 0));
        view.clipFromWorldBefore = glm::inverse(view.worldFromClip);
        view.eye = view.eyeBefore = camera.eye;
        view.follows = 1;
        ASSERT_TRUE(gpu().submit([&](VkCommandBuffer cmd) { indirect->record(cmd, view); }));
        const std::vector<uint32_t> words = wordsOf(indirect->state().mirrored(), kWidth, kHeight);

        const float diagonal = light->info().diagonal * light->info().scale;
        size_t all = 0, answered = 0, met = 0, before = 0, beyond = 0;
        for (uint32_t i = 0; i < kWidth * kHeight; ++i)
        {
            if (!(frame->depth[i] > 0.0f)) continue;
            const vec2 ndc = (vec2(i % kWidth, i / kWidth) + 0.5f) / vec2(kWidth, kHeight) * 2.0f - 1.0f;
            const vec3 point = camera.eye + frame->depth[i] * (forward + ndc.x * tangent * aspect * right - ndc.y * tangent * up);
            const vec3 normal = glm::normalize(frame->normal[i]), direction = glm::reflect(glm::normalize(point - camera.eye), normal);
            const auto hit = rays->closest(point + view.normalOffset * normal, direction);
            ++all;
            const float sure = glm::unpackHalf2x16(words[2 * i]).x, t = glm::unpackHalf2x16(words[2 * i + 1]).y;
            if (sure < 0.5f) continue;
            ++answered;
            const float off = hit ? t - hit->t : -1e30f;
            (off < -0.002f * diagonal ? before : off > 0.002f * diagonal ? beyond : met) += 1;
        }
        ASSERT_GT(all, 1000u);
        const double share = double(answered) / double(all), found = double(met) / double(std::max<size_t>(answered - beyond, 1));
        RecordProperty(asked.scene,
                       fmt::format("answered {:.4f}, right {:.4f}, before the truth {:.4f}, beyond {:.4f}", share,
                                   double(met) / double(answered), double(before) / double(answered), double(beyond) / double(answered)));
        EXPECT_GT(share, asked.answered) << asked.scene;
        EXPECT_GT(found, asked.right) << asked.scene;
    }
}

} // namespace
} // namespace sconce
