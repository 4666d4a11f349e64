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

vec3 given(uint i, vec3 point, vec3 normal, vec3 plane, out DeltaLight light)
{
    GpuLight of = push.live.data.lights.light[i];
    light = deltaLightAt(of, of.type, point, 2.0 * field.diagonal);
    return dot(plane, light.toLight) > 0.0 ? max(dot(normal, light.toLight), 0.0) * light.irradiance : vec3(0.0);
}

void main()
{
    Texel t = texelOfInvocation();
    if (!t.inside) return;
    LiveTexel known = push.live.data.texels.value[t.index];
    vec3 sum = vec3(0.0);
    if ((known.normal & kSurfaceKnown) != 0u)
    {
        SurfacePoint surface = surfacePointAt(t.probe, t.at.z, t.at.x, t.at.y);
        vec3 normal = unpackNormal8(known.normal);
        // Off the surface by what the distance of its texel is packed to, besides.
        vec3 point = probeHeader(t.probe).centre + surface.at + (push.offset + 5e-4 * length(surface.at)) * surface.normal;
        DeltaLight light;
        float total = 0.0;
        uint giving = 0u;
        for (uint i = 0u; i < push.lights; ++i)
        {
            float bright = luminance(given(i, point, normal, surface.normal, light));
            total += bright;
            giving += bright > 0.0 ? 1u : 0u;
        }
        bool all = giving <= kLiveShadowRays;
        float each = total / float(kLiveShadowRays), passed = 0.0;
        float next = randomPair(uvec2(t.at.x + field.surfaceSize * t.at.z, t.at.y), 0u, kLightStream, 0u).x * each;
        for (uint i = 0u; i < push.lights && total > 0.0; ++i)
        {
            vec3 some = given(i, point, normal, surface.normal, light);
            float bright = luminance(some), times = bright > 0.0 ? 1.0 : 0.0;
            if (!all)
            {
                passed += bright;
                times = floor(max(passed - next, 0.0) / each);
                if (passed > next) times += 1.0;
                next += times * each;
                times *= bright > 0.0 ? each / bright : 0.0;
            }
            if (times > 0.0 && lightReaches(field.origin + field.scale * point, light.toLight, light.distance * field.scale, surface.normal)) sum += times * some;
        }
    }
    push.live.data.direct.word[t.index] = packSharedExponent(min(sum / kBrdfPi, vec3(kMostStored)));
}
