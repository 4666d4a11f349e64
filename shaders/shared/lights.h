// The list of lights as it lies in device memory: the scene's delta lights first, then samples of its emitters, then directions of its
// sky. Field space: positions relative to the field's origin, lengths in field units; intensities are scaled to match.
#include "shared/gpu_types.h"
#ifndef SCONCE_SHARED_LIGHTS_H
#define SCONCE_SHARED_LIGHTS_H
SCONCE_STRUCTS_BEGIN

const uint kLightDirectional = 0u; // as LightType
const uint kLightPoint = 1u;
const uint kLightSpot = 2u;
const uint kLightEmitter = 3u; // a patch of an emissive surface
const uint kLightSky = 4u;     // a share of the sphere, as a directional light

struct GpuLight
{
    vec3 position;  // point, spot, emitter
    uint type;
    vec3 direction; // the way the light travels; emitter: the patch's normal, outward
    float range;    // field units, 0: unlimited
    vec3 intensity; // directional, sky: irradiance on a facing surface; point, spot: W/sr over field units; emitter: radiance
    float area;     // emitter: of the patch, field units squared
    float innerCone;   // of an emitter: 1: its back is inside of what is closed; 0: it is seen from both sides
    float outerCone;
    int shadowLayer;   // first layer in the array of its kind: sunLevels (directional), 1 (sky) or 6 (the others)
    float shadowTexel; // directional, sky: field units a texel; the others: tangent a texel
    vec4 shadowX;      // directional, sky: dot(row, (p, 1)) is the map's x in [0,1], y, and depth, 1 nearest the light
    vec4 shadowY;
    vec4 shadowDepth;
};
SCONCE_CHECK_SIZE(GpuLight, 112);

struct LightsHeader
{
    uint deltaCount; // lights [0, deltaCount)
    uint emitterCount;
    uint skyCount;
    float pointNear; // W of depth 1 in the maps of point-like lights, field units
    vec3 eye;        // field space, that the finer maps of directional lights lie about
    uint sunLevels;  // maps of a directional light: the whole scene's, then each of a kFinerSun-th of the width of the one before
};
SCONCE_CHECK_SIZE(LightsHeader, 32);

const float kFinerSun = 6.0;

SCONCE_STRUCTS_END
#endif
