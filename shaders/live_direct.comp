#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "live_texels.glsl"
#include "shared/delta_light.h"

// Live light: what a probe's texels get straight from lights, shadowed by rays through the light field. Where more lights give some than there are rays,
// rays go to lights drawn by how much each gives unshadowed, systematically along the list, by the same number in every frame: still light is still.
// Dispatch: see live_texels.glsl.

const uint kLightStream = 9u;

vec3 given(uint i, vec3 point, vec3 normal, vec3 plane, float grazing, out DeltaLight light)
{
    GpuLight of = LiveLights(push.live.data.lights).light[i];
    light = deltaLightAt(of, of.type, point, 2.0 * field.diagonal);
    float cosine = max(dot(normal, light.toLight), 0.0);
    return dot(plane, light.toLight) > 0.0 ? cosine * takenAlong(cosine, grazing) * light.irradiance : vec3(0.0);
}

/// Irradiance at a point, as much as reaches it.
/// @param at  of its finer texel: what lights are drawn by
vec3 directAt(vec3 point, vec3 normal, vec3 plane, float grazing, uvec2 at)
{
    DeltaLight light;
    float total = 0.0;
    uint giving = 0u;
    for (uint i = 0u; i < push.lights; ++i)
    {
        float bright = luminance(given(i, point, normal, plane, grazing, light));
        total += bright;
        giving += bright > 0.0 ? 1u : 0u;
    }
    bool all = giving <= kLiveShadowRays;
    float each = total / float(kLiveShadowRays), passed = 0.0, next = randomPair(at, 0u, kLightStream, 0u).x * each;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < push.lights && total > 0.0; ++i)
    {
        vec3 some = given(i, point, normal, plane, grazing, light);
        float bright = luminance(some), times = bright > 0.0 ? 1.0 : 0.0;
        if (!all)
        {
            passed += bright;
            times = passed > next ? floor((passed - next) / each) + 1.0 : 0.0;
            next += times * each;
            times *= bright > 0.0 ? each / bright : 0.0;
        }
        if (times > 0.0 && lightReaches(field.origin + field.scale * point, light.toLight, light.distance * field.scale, plane)) sum += times * some;
    }
    return sum;
}

void main()
{
    Texel t = texelOfInvocation();
    if (!t.inside) return;
    LiveTexel known = LiveTexels(push.live.data.texels).value[t.index];
    vec3 sum = vec3(0.0);
    float points = 0.0;
    if ((known.normal & kSurfaceKnown) != 0u)
    {
        SurfacePoint own = surfacePointAt(t.probe, t.at.z, t.at.x, t.at.y);
        // At points spread over the texel, so that the edge of a shadow is where it is, as far as they show its surface.
        for (uint i = 0u; i < kLivePoints * kLivePoints; ++i)
        {
            ivec2 at = int(kLivePoints) * t.at.xy + ivec2(i % kLivePoints, i / kLivePoints);
            SurfacePoint surface = surfacePointOf(t.probe, t.at.z, at.x, at.y, kLivePoints * field.surfaceSize);
            if (!isSameSurface(own.at, own.normal, surface, kSurfaceBend)) continue;
            // Off the surface by what the distance of its texel is packed to, besides.
            vec3 point = probeHeader(t.probe).centre + surface.at + (push.offset + 5e-4 * length(surface.at)) * surface.normal;
            sum += directAt(point, unpackNormal8(known.normal), surface.normal, unpackGrazing(known.normal), uvec2(at.x + kLivePoints * field.surfaceSize * uint(t.at.z), at.y));
            points += 1.0;
        }
    }
    BakeWords(push.live.data.direct).word[t.index] = packSharedExponent(min(sum / (kBrdfPi * max(points, 1.0)), vec3(kMostStored)));
}
