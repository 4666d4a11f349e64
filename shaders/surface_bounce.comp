#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "surface_texels.glsl"
#include "gathered_rays.glsl"

// Bake: one bounce at a probe's texels of the surface light: what arrives is what comes straight from emitters and sky, and what the texels send
// that the gathering rays have found. With no rays (0): the first, which has no bounce in it.
// Dispatch: ceil(surfaceSize/8) twice x 6.

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index)) return;
    vec3 sum = vec3(0.0);
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.rays; ++i)
    {
        uint link = push.links.word[i * texelsOfProbe() + ofProbe];
        if (countEnd(ends, link)) sum += broughtBy(link);
    }
    vec3 reflected = vec3(0.0);
    for (uint i = 0u; i < min(push.bounce, kReflectionsCounted); ++i) reflected += unpackSharedExponent(push.reflected.word[i * push.texelCount + index]);
    vec3 light = push.first.value[index].xyz + reflected + perRay(ends) * sum;
    push.light.value[index].xyz = light;
    SurfaceTexel own = push.texels.value[index];
    push.sent.word[index] = packSharedExponent(unpackRootOfColor(own.albedo) * light + unpackSharedExponent(own.sent));
}
