#pragma once

#include <optional>
#include <vector>

#include "base/knobs.h"
#include "runtime/scene/scene_mesh.h"
#include "scene/scene.h"
#include "shaders/shared/light_field.h"
#include "shaders/shared/lights.h"

namespace sconce
{

/// What light becomes a finite list of. Ranges and prices: base/knobs.h.
struct LightSettings
{
    uint32_t emitterSamples =
        knobs::emitterSamples.value;               // patches of emissive surfaces; bake time and shadow memory grow with it, noise falls
    uint32_t skySamples = knobs::skySamples.value; // directions of the sky; the same
    bool areaShadows = true; // maps for both, as many as a device has layers for; without, there may be 65,536 of either
    uint32_t sunShadow = knobs::sunShadow.value;         // texels a side of a directional light's map
    uint32_t pointShadow = knobs::pointShadow.value;     // texels a side of a point light's six faces
    uint32_t emitterShadow = knobs::emitterShadow.value; // the same for emitter samples
    uint32_t skyShadow = knobs::skyShadow.value;         // texels a side of a sky direction's map
    std::optional<vec3> eye = {};                        // metres: directional lights have finer maps about it, too, where a map's texels
                                                         // show and kShadowBytes have room for them beside all maps at their size
    std::vector<uint32_t> lamps = {}; // triangles, ascending, that are no emitters, though they shine: runtime/bake/lamps.h
};

/// A triangle that emits, as its samples stand for it.
struct EmittingTriangle
{
    uint32_t triangle;
    vec3 emission; // radiance of what is there of it: a ray that meets it has met that
    float patch;   // field units squared that a sample stands for
    int side;      // 1, -1: only the side of its normal by winding shines, or the other; 0: both
};

/// The scene's light as a list (order: shaders/shared/lights.h) and the views that its shadow maps are rendered with.
struct LightList
{
    gpu::LightsHeader header{};
    std::vector<gpu::GpuLight> lights;
    uint32_t sunLayers = 0, skyLayers = 0, pointLayers = 0, emitterLayers = 0;
    std::vector<EmittingTriangle> emitters; // by triangle
    bool shines = false;                    // some triangle does, be it an emitter or a lamp
    LightSettings settings;                 // with the sizes of maps halved until each kind takes at most kShadowBytes
};
inline constexpr uint32_t kSamplesOfLamps = 4; // times those asked for, at most
inline constexpr uint32_t kSamplesOfALamp =
    16;                                 // as far as that goes; with the two or three of 400 boxes rooms had 0.92 to 1.07 of their light
inline constexpr int kNoShadowMap = -1; // GpuLight::shadowLayer of a sample that rays shadow
inline constexpr uint64_t kShadowBytes = uint64_t(128) << 20;

/// Delta lights as they are. Emitters: stratified in the scene's order, so that the same scene gives the same list; half by power (area
/// times mean emission), half by area alone, so that a dim lamp that lights a room of its own has samples beside a bright one. The samples
/// of each lamp, triangles that hang together, carry its power. Where samples need no map, there are kSamplesOfALamp for each lamp, and one
/// more for each that got none, up to kSamplesOfLamps times what was asked for. Sky: a spherical Fibonacci set (Keinert et al. 2015) of
/// equal shares. Kinds the scene lacks have no entries.
LightList buildLightList(const Scene& scene, const gpu::LightFieldInfo& space, const LightSettings& settings);

/// A light of no extent in a field's space, without a shadow map.
gpu::GpuLight deltaLight(const Light& light, const gpu::LightFieldInfo& space);

/// The views of an entry's shadow maps, a layer each: one for the sky's, sunLevels for directional lights, six faces for the others.
std::vector<gpu::SceneView> shadowViews(const gpu::GpuLight& light, const gpu::LightsHeader& header);

/// A cube face about a point: clip = (U, V, near, W) with the face coordinates of shaders/shared/chart.h.
gpu::SceneView faceView(vec3 centre, int face, float nearPlane);

} // namespace sconce
