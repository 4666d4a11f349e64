#pragma once

#include <vector>

#include "runtime/scene/scene_mesh.h"
#include "scene/scene.h"
#include "shaders/shared/light_field.h"
#include "shaders/shared/lights.h"

namespace sconce
{

/// What light becomes a finite list of.
struct LightSettings
{
    uint32_t emitterSamples = 64; // patches of emissive surfaces, 0..340; bake time and shadow memory grow with it, noise falls
    uint32_t skySamples = 48;     // directions of the sky, 0..1024; the same
    bool areaShadows = true;      // maps for both; without, they cost no memory, and there may be 65,536 of either
    uint32_t sunShadow = 4096;    // texels a side of a directional light's map, 256..8192
    uint32_t pointShadow = 512;   // texels a side of a point light's six faces, 64..2048
    uint32_t emitterShadow = 256; // the same for emitter samples, 32..1024
    uint32_t skyShadow = 1024;    // texels a side of a sky direction's map, 128..4096
};

/// The scene's light as a list (order: shaders/shared/lights.h) and the views that its shadow maps are rendered with.
struct LightList
{
    gpu::LightsHeader header{};
    std::vector<gpu::GpuLight> lights;
    uint32_t sunLayers = 0, skyLayers = 0, pointLayers = 0, emitterLayers = 0;
    LightSettings settings; // with the sizes of maps halved until each kind takes at most kShadowBytes
};
inline constexpr int kNoShadowMap = -1; // GpuLight::shadowLayer of a sample that rays shadow
inline constexpr uint64_t kShadowBytes = uint64_t(128) << 20;

/// Delta lights as they are. Emitters: stratified in the scene's order, so that the same scene gives the same list; half by power (area
/// times mean emission), half by area alone, so that a dim lamp that lights a room of its own has samples beside a bright one. Sky: a
/// spherical Fibonacci set (Keinert et al. 2015) of equal shares. Kinds the scene lacks have no entries.
LightList buildLightList(const Scene& scene, const gpu::LightFieldInfo& space, const LightSettings& settings);

/// The views of an entry's shadow map: one for directional lights, six faces for the others.
std::vector<gpu::SceneView> shadowViews(const gpu::GpuLight& light, float pointNear);

/// A cube face about a point: clip = (U, V, near, W) with the face coordinates of shaders/shared/chart.h.
gpu::SceneView faceView(vec3 centre, int face, float nearPlane);

} // namespace sconce
