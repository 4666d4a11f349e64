#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "surface_texels.glsl"

// Bake: one bounce at a probe's texels of the surface light: what arrives is what comes straight from emitters and sky, and what the texels send
// that the gathering rays have found. With no rays (0): the first, which has no bounce in it.
// Dispatch: ceil(surfaceSize/8) twice x 6.

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index)) return;
    vec3 sum = vec3(0.0);
    float ended = 0.0, surfaces = 0.0, known = 0.0;
    for (uint i = 0u; i < push.rays; ++i)
    {
        uint link = push.links.word[i * texelsOfProbe() + ofProbe];
        if (link == kLinkNone) continue;
        ended += 1.0;
        if (link == kLinkSky) continue;
        surfaces += 1.0;
        if (link == kLinkSurface) continue;
        known += 1.0;
        sum += unpackSharedExponent(push.sentBefore.word[link]);
    }
    // Surfaces whose light isn't known send what the others send.
    vec3 light = push.first.value[index].xyz + sum / max(known, 1.0) * (surfaces / max(ended, 1.0));
    push.light.value[index].xyz = light;
    SurfaceTexel own = push.texels.value[index];
    push.sent.word[index] = packSharedExponent(unpackRootOfColor(own.albedo) * light + unpackSharedExponent(own.sent));
}
