#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_FIELD_SET 0
#include "light_field.glsl"

#ifdef SURFACE_LIGHT
#include "shared/bake_passes.h"
#include "lamps.glsl"
#define SCONCE_BOUNCE_PUSH
layout(scalar, push_constant) uniform Push { BakePush push; };

/// By the probe's own texels; where they don't show the point, as a pixel finds its light.
vec3 bounceIrradiance(vec3 point, vec3 normal, vec3 viewer)
{
    vec3 fromLamps = lampCount > 0u ? lampIrradiance(point, normal, -normalize(planeSeen(push.probe, point - viewer))) / kBrdfPi : vec3(0.0);
    SurfaceTaps own = surfaceTaps(push.probe, point - viewer, normal);
    if (own.weight > kSurfaceLeast) return own.light / own.weight + fromLamps;
    int reads = 0;
    return surfaceLightAt(point, normal, normal, point + 0.5 * field.voxel * normal, reads).light + fromLamps;
}
#else
/// The leaf is asked half a voxel off the surface, on the side that the probe sees.
vec3 bounceIrradiance(vec3 point, vec3 normal, vec3 viewer)
{
    int reads = 0;
    return irradianceAt(point, normal, point + 0.5 * field.voxel * normal, reads);
}
#endif
#include "bake_bounce.glsl"
