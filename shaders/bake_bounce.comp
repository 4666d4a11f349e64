#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_FIELD_SET 0
#include "light_field.glsl"
#include "shared/bake_passes.h"

// Bake: one more bounce. Every texel's radiance is its direct one plus what it reflects of the light field's own irradiance (Jacobi
// iteration of the light transport over the probes' texels). That irradiance leaves out emission and sky: they are in the direct one. With
// surface light, what it reflects of that. Dispatch: ceil(N/8) twice x 6 (cube) or 1 (octahedral).
layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, push_constant) uniform Push { BakePush push; };

#ifdef SURFACE_LIGHT
#include "lamps.glsl"

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

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= push.size || at.y >= push.size) return;
    uint index = (at.z * push.size + at.y) * push.size + at.x;
    uint material = push.surface.word[index];
    uint word = push.words.word[(push.chart == kChartCube ? at.z * push.faceWords : 0u) + at.y * push.size + at.x];
    uint far = push.chart == kChartCube ? 0u : 0x7c00u;
    uint own = push.extra.word[index];
    if ((word & 0xffffu) == far)
    {
        push.radiance.word[index] = own;
        return;
    }
    vec2 uv = (vec2(at.xy) + 0.5) / float(push.size);
    vec3 relative = push.chart == kChartCube ? faceDirection(int(at.z), vec3(2.0 * uv - 1.0, 1.0)) / halfToReal(word)
                                        : directionFromOctahedral(uv) * halfToReal(word);
    vec3 albedo = unpackAlbedo(material);
    vec3 normal = unpackNormal8(material >> 16);
    vec3 p = push.centre + relative;
    vec3 gathered = bounceIrradiance(p, normal, push.centre), straight = unpackRadiance(own);
#ifdef SURFACE_LIGHT
    if (isOfLamp(p, length(relative), length(relative) * 2.0 / float(push.size))) straight = vec3(0.0);
#endif
    // Rounded to nearest, the last bounces would all be rounded away, in every texel alike.
    push.radiance.word[index] = packRadianceDithered(straight + albedo * gathered, ditherOf(index));
}
