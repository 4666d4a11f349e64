#pragma once

#include <optional>

#include "runtime/bake/bake.h"
#include "runtime/scene/scene_renderer.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"

namespace sconce::testing_support
{

/// Draws frames of a scene with a light field that is baked for it.
class FrameTest : public DeviceTest
{
protected:
    static constexpr uint32_t kFewTexels = 26;

    static RenderSettings settingsOf(uint32_t side)
    {
        RenderSettings settings;
        settings.width = settings.height = side;
        return settings;
    }

    /// @param surfaceTexels  by default few, lit by few rays: most tests are about something else
    /// @param surfaceRays    none: few for few texels, else the bake's own
    static BakeSettings bakeOf(uint32_t resolution = 128, uint32_t bounces = 2, uint32_t surfaceTexels = kFewTexels,
                               std::optional<uint32_t> surfaceRays = {})
    {
        BakeSettings bake;
        bake.surfaceTexels = surfaceTexels;
        bake.surfaceRays = surfaceRays.value_or(surfaceTexels == kFewTexels ? 16 : bake.surfaceRays);
        bake.resolution = resolution;
        bake.bounces = bounces;
        return bake;
    }

    /// Lit through the field, as by a host that has no rays to triangles; with the settings of bakeOf().
    Result<FieldData> bakeField(const Scene& scene, std::span<const vec3> probes, uint32_t resolution = 128, uint32_t bounces = 2,
                                uint32_t surfaceTexels = kFewTexels, std::optional<uint32_t> surfaceRays = {})
    {
        BakeReport report;
        return bakeLightField(gpu().host, scene, probes, bakeOf(resolution, bounces, surfaceTexels, surfaceRays), {}, report);
    }

    /// Lit by rays to the scene's triangles, as `sconce bake` does by default.
    Result<FieldData> bakeByTriangles(const Scene& scene, std::span<const vec3> probes, BakeSettings bake)
    {
        const auto rays = TriangleRays::build(scene);
        if (!rays) return rays.error();
        bake.rays = &*rays;
        BakeReport report;
        return bakeLightField(gpu().host, scene, probes, bake, {}, report);
    }

    /// @param drawn  what is in the picture; it may differ from what the field was baked from
    Result<RenderedFrame> drawWith(const FieldData& field, const Scene& drawn, const RenderSettings& settings)
    {
        auto device = DeviceScene::create(gpu(), drawn, field.info);
        if (!device) return device.error();
        auto light = makeLightField(gpu(), field);
        if (!light) return light.error();
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        if (!renderer) return renderer.error();
        return (*renderer)->render(drawn.cameras.front());
    }
};

} // namespace sconce::testing_support
