#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SCENE_SET 1
#include "light_field.glsl"
#include "surface_texels.glsl"

#include "surface_rays.glsl"

// Bake: what a texel of the surface light gets straight from emitters and sky, and where its other light comes from. See shared/surface_gather.h.
// Dispatch: ceil(surfaceSize/8) twice x 6.

// Share of the rays that may end within their first texels: where more do, a map this coarse doesn't tell a texel from its surroundings.
const float kMostNearby = 0.75;
uint ownTexel; // of the probe
float nearby = 0.0;

uint endOfRay(vec3 point, vec3 direction, vec3 plane, vec2 lots, out float t, out vec3 emitted)
{
    emitted = vec3(0.0);
    TraceResult hit;
    if (!meetsNearby(push.probe, point - probeHeader(push.probe).centre, direction, hit)) return endThroughField(point, direction, plane, lots, t);
    nearby += 1.0;
    t = hit.t;
    return linkOf(hit, lots.x);
}
void keepLink(uint i, uint link) { push.links.word[i * texelsOfProbe() + ownTexel] = link; }
#include "shared/surface_gather.h"

void main()
{
    uvec3 texel;
    uint index;
    if (!findTexel(texel, ownTexel, index)) return;
    SurfacePoint surface = surfacePointAt(push.probe, int(texel.z), int(texel.x), int(texel.y));
    vec3 normal = normalOfTexel(index, surface);
    // Off the surface by what the distance of its texel is packed to, besides.
    vec3 point = probeHeader(push.probe).centre + surface.at + (push.offset + 5e-4 * length(surface.at)) * surface.normal;
    Gathered got = gatherAt(point, normal, surface.normal, pixelOfTexel(texel), unpackGrazing(push.texels.value[index].normal));
    push.light.value[index].w = got.variance;
    if (field.surfaceDirections != 0u) push.tilts.value[index] = vec4(alongPlane(got.tilt, normal), vec2(0.0));
    push.first.value[index] = vec4(got.light, knowsTooLittle(got.ends, got.asked) || nearby > kMostNearby * got.asked ? kNotKnown : got.reach);
}
