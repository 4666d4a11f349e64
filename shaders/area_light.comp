#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#ifdef SCONCE_FIELD_SHADOWS
#define SCONCE_FIELD_SET 2
#include "light_field.glsl"
#endif
#include "lights.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"

// Diffuse light straight from emitters and from the sky, by some of their samples, added to the light that surfaces reflect (the probes'
// irradiance). A sample is shadowed by its map or, with SCONCE_FIELD_SHADOWS, by a ray through the light field, so that the list of samples
// can be long. Each pixel takes another subset; the filter after it blends them.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = kAreaNormalBinding) uniform utexture2D gGeometricNormal;
layout(set = 1, binding = kAreaDiffuseBinding, rgba16f) uniform image2D diffuse; // rgb: cosine-weighted mean radiance
layout(scalar, push_constant) uniform Push { AreaPush push; };

#ifdef SCONCE_FIELD_SHADOWS
/// As lightAt() of lights.glsl.
LightSample tracedLightAt(uint kind, uint i, Pixel p, vec3 point, vec3 geometric)
{
    LightSample s = unshadowedLight(kind, i, point);
    if (dot(geometric, s.toLight) <= 0.0 || dot(p.normal, s.toLight) <= 0.0 || all(equal(s.irradiance, vec3(0.0))))
    {
        s.irradiance = vec3(0.0);
        return s;
    }
    float far = kind == kLightSky ? 1e30 : distance(lights[i].position, point) * push.scale;
    if (!lightReaches(p.position + frame.normalOffset * geometric, s.toLight, far, geometric)) s.irradiance = vec3(0.0);
    return s;
}
#endif

/// Mean over a subset of the lights [first, first + count), all of a kind, scaled to all of them, of their irradiance times the cosine.
vec3 someLights(uint kind, Pixel p, vec3 point, vec3 geometric, uint first, uint count, uint stream, ivec2 at)
{
    uint taken = min(push.samples, count);
    if (taken == 0u) return vec3(0.0);
    float start = pairOfFrame(uvec2(at), frame.seed, 1u, 0u, stream).x;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < taken; ++i)
    {
        uint pick = min(uint((float(i) + start) / float(taken) * float(count)), count - 1u);
#ifdef SCONCE_FIELD_SHADOWS
        LightSample s = tracedLightAt(kind, first + pick, p, point, geometric);
#else
        LightSample s = lightAt(kind, first + pick, point, geometric);
#endif
        sum += max(dot(p.normal, s.toLight), 0.0) * s.irradiance;
    }
    return sum * (float(count) / float(taken));
}

void main()
{
    ivec2 at;
    if (!findPixel(kTermDiffuse, at)) return;
    Pixel p = readPixel(at);
    if (!p.surface || isNotOf(kTermDiffuse, termsOf(p))) return;
    vec3 light = imageLoad(diffuse, at).rgb;
    vec3 point = (p.position - push.origin) / push.scale;
    vec3 geometric = directionFromOctahedral(unpackUnorm2x16(texelFetch(gGeometricNormal, at, 0).x));
    vec3 irradiance = someLights(kLightEmitter, p, point, geometric, lightsHeader.deltaCount, lightsHeader.emitterCount, 2u, at) +
                      someLights(kLightSky, p, point, geometric, lightsHeader.deltaCount + lightsHeader.emitterCount, lightsHeader.skyCount, 3u, at);
    imageStore(diffuse, at, storedLight(vec4(light + irradiance / kBrdfPi, 1.0)));
}
