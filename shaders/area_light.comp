#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lights.glsl"
#include "gbuffer_read.glsl"

// Diffuse light straight from emitters and from the sky, by some of their samples and these samples' shadow maps, added to the light that
// surfaces reflect (the probes' irradiance). Each pixel takes another subset; the filter after it blends them.
// Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 4) uniform texture2D gGeometricNormal;
layout(set = 1, binding = 5, rgba32f) readonly uniform image2D reflected; // rgb: cosine-weighted mean radiance
layout(set = 1, binding = 6, rgba32f) writeonly uniform image2D total;
layout(scalar, push_constant) uniform Push
{
    vec3 origin;  // of field space, world metres
    float scale;  // metres per field unit
    uint samples; // of the emitters, and as many of the sky, a pixel
};

/// Mean over a subset of the lights [first, first + count), scaled to all of them, of their irradiance times the cosine.
vec3 someLights(Pixel p, vec3 point, vec3 geometric, uint first, uint count, uint stream, ivec2 at)
{
    uint taken = min(samples, count);
    if (taken == 0u) return vec3(0.0);
    float start = randomPair(uvec2(at), 0u, stream, frame.seed).x;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < taken; ++i)
    {
        uint pick = min(uint((float(i) + start) / float(taken) * float(count)), count - 1u);
        LightSample s = lightAt(first + pick, point, geometric);
        sum += max(dot(p.normal, s.toLight), 0.0) * s.irradiance;
    }
    return sum * (float(count) / float(taken));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    Pixel p = readPixel(at);
    vec3 light = imageLoad(reflected, at).rgb;
    if (p.surface && p.brdf.metallic < 1.0)
    {
        vec3 point = (p.position - origin) / scale;
        vec3 geometric = texelFetch(gGeometricNormal, at, 0).xyz;
        vec3 irradiance = someLights(p, point, geometric, lightsHeader.deltaCount, lightsHeader.emitterCount, 2u, at) +
                          someLights(p, point, geometric, lightsHeader.deltaCount + lightsHeader.emitterCount, lightsHeader.skyCount, 3u, at);
        light += irradiance / SCONCE_BRDF_PI;
    }
    imageStore(total, at, vec4(light, 1.0));
}
