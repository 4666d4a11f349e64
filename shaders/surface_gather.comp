#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SCENE_SET 1
#include "light_field.glsl"
#include "surface_texels.glsl"
#include "surface_rays.glsl"

// Bake: what a texel of the surface light gets straight from emitters and sky, and where its other light comes from. Cosine-weighted rays go from
// its surface through the light field: the sky's light is that of those that leave the scene; of the others the texel where each ended is kept,
// so that bounces need no ray. Emitters are sampled by shadow rays to samples drawn by how much they would give unshadowed (resampled importance
// sampling, Talbot et al. 2005), systematically along the list.
// Dispatch: ceil(surfaceSize/8) twice x 6.

// Share of the rays that may end within their first texels: where more do, a map this coarse doesn't tell a texel from its surroundings.
const float kMostNearby = 0.75;

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index)) return;
    SurfacePoint surface = surfacePointAt(push.probe, int(texel.z), int(texel.x), int(texel.y));
    vec3 normal = normalOfTexel(index, surface);
    // Off the surface by what the distance of its texel is packed to, besides.
    vec3 point = probeHeader(push.probe).centre + surface.at + (push.offset + 5e-4 * length(surface.at)) * surface.normal;
    uvec2 pixel = pixelOfTexel(texel);
    TangentFrame tangents = tangentFrame(normal);
    vec3 sky = vec3(0.0), slopes = vec3(0.0);
    float asked = 0.0, nearby = 0.0, nearness = 0.0;
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.rays; ++i)
    {
        vec3 direction = gatherDirection(tangents, pixel, i);
        uint link = kLinkNone;
        if (dot(direction, surface.normal) > 0.0)
        {
            asked += 1.0;
            vec2 lots = pairOfRay(pixel, i, kLinkStream);
            float t;
            TraceResult hit;
            if (meetsNearby(push.probe, point - probeHeader(push.probe).centre, direction, hit))
            {
                nearby += 1.0;
                t = hit.t;
                link = linkOf(hit, lots.x);
            }
            else link = endOfRay(point, direction, surface.normal, lots, t);
            nearness += 1.0 / max(t, 1e-6);
        }
        push.links.word[i * texelsOfProbe() + ofProbe] = link;
        countEnd(ends, link);
        if (link != kLinkSky) continue;
        sky += field.sky;
        slopes += slopeOf(direction, normal);
    }
    vec3 light = sky / max(ends.all, 1.0);
    float luminousSky = luminance(field.sky), variance = 0.0;
    if (luminousSky > 0.0) variance = luminousSky * luminousSky * varianceOfShare(luminance(sky) / luminousSky, ends.all);
    vec3 tilt = luminousSky * slopes / max(ends.all, 1.0);
    if (lightsHeader.emitterCount > 0u)
    {
        float ofEmitters;
        vec3 theirs;
        light += emittersAt(point, normal, surface.normal, pixel, ofEmitters, theirs);
        variance += ofEmitters;
        tilt += theirs;
    }
    push.light.value[index].w = variance;
    if (field.surfaceDirections != 0u) push.tilts.value[index] = vec4(alongPlane(tilt, normal), vec2(0.0));
    float known = ends.all - ends.surfaces + ends.known;
    push.first.value[index] = vec4(light, known < kLeastKnown * asked || nearby > kMostNearby * asked ? kNotKnown : float(push.rays) / max(nearness, 1e-6));
}
