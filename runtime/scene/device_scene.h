#pragma once

#include <memory>

#include "base/knobs.h"
#include "base/progress.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/scene/lights.h"
#include "runtime/scene/scene_mesh.h"
#include "runtime/scene/scene_textures.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

struct DeviceSceneDesc
{
    uint32_t maxTextureSize = knobs::textureSize.value; // texels a side; larger images are filtered down
    LightSettings light;
};

inline constexpr uint32_t kTracedLightSamples =
    knobs::tracedLightSamples.value; // of the emitters, and of the sky, where rays shadow them: 112 bytes each, and no map

/// What frames with these effects need of a scene: without diffuse light, or where rays or surface light give it, no samples of emitters
/// and sky, and so no shadow maps of them; with `fieldShadows` more samples, without maps. A bake needs them always.
/// @param eye  metres, see LightSettings::eye
DeviceSceneDesc sceneForFrames(const IndirectEffects& effects, const gpu::LightFieldInfo& field, std::optional<vec3> eye = {});

/// A scene on the device: triangles, materials, textures, lights, and shadow maps, rendered once but for those about an eye. Move-only;
/// destroy it after the GPU has finished with it and before its Gpu.
class DeviceScene
{
public:
    /// Uploads the scene and renders its shadow maps (submits and waits, a few maps at a time).
    /// Errors: badInput (an empty or invalid scene: names the fault), badArgument (settings), outOfMemory, deviceFailure, cancelled.
    static Result<DeviceScene> create(Gpu& gpu, const Scene& scene, const gpu::LightFieldInfo& space, const DeviceSceneDesc& desc = {},
                                      const Progress& progress = {});

    /// After an eye that has moved: where it is near the border of the finest maps about it (LightSettings::eye), these are drawn anew
    /// about it (submits and waits, after all that was submitted to the queue before). Nothing to do for a scene without. Errors:
    /// badArgument (an eye that isn't finite), deviceFailure, outOfMemory; the maps are then about where they were.
    Status lookFrom(Gpu& gpu, vec3 eye);

    /// What shaders/scene.glsl declares; sampled by fragment and compute shaders.
    VkDescriptorSetLayout layout() const { return set.layout(); }
    VkDescriptorSet descriptorSet() const { return set.handle(); }
    const SceneMesh& mesh() const { return triangles; }
    const LightList& lights() const { return lightList; }
    uint64_t deviceBytes() const { return bytes; }
    struct DepthPipelines; // device_scene.cpp

private:
    explicit DeviceScene(SceneMesh mesh) : triangles(std::move(mesh)) {}
    Status makeShadowMaps(Gpu& gpu, const Progress& progress);
    SceneMesh triangles;
    TextureArray color, data;
    Buffer materials, lightBuffer;
    LightList lightList;
    vec3 origin{0.0f}; // of field space, metres
    float scale = 1.0f;
    GpuImage sunMaps, skyMaps, pointMaps, emitterMaps, noMaps;
    std::shared_ptr<const DepthPipelines> sunPipelines; // from the first time that finer maps are drawn anew
    Sampler textureSampler, smoothCompare, nearestCompare;
    DescriptorSet set;
    uint64_t bytes = 0;
};

} // namespace sconce
