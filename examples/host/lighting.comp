#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#define GI_BINDING 6
#include "sconce_gi.glsl"

// Dispatch: ceil(width / 8) x ceil(height / 8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 0) uniform Block
{
    mat4 worldFromClip;
    mat4 mapFromWorld; // of the shadow map
    vec3 eye;
    float shadowTexel; // metres
    vec3 toSun;
    uint made; // terms of indirect light
    float raysBelow; // of its frames
    vec3 sunIrradiance;
    vec3 sky;
};
layout(set = 0, binding = 1) uniform texture2D depths;
layout(set = 0, binding = 2) uniform texture2D normalsRoughness;
layout(set = 0, binding = 3) uniform texture2D baseColorsMetallic;
layout(set = 0, binding = 4) uniform texture2D emissions;
layout(set = 0, binding = 5) uniform sampler2DShadow sunShadow;
layout(set = 0, binding = 10, rgba32f) writeonly uniform image2D directPicture;
layout(set = 0, binding = 11, rgba32f) writeonly uniform image2D scatteredPicture;
layout(set = 0, binding = 12, rgba32f) writeonly uniform image2D reflectedPicture;
layout(set = 0, binding = 13, rgba32f) writeonly uniform image2D picture;

/// Share of the sun that reaches a point. It is moved off its surface by what that rises over the filter's two texels.
float sunSeen(vec3 point, vec3 normal)
{
    float cosine = dot(normal, toSun);
    if (cosine <= 0.0) return 0.0;
    vec3 off = point + (1.5 * sqrt(1.0 - min(cosine * cosine, 1.0)) + 0.1) * shadowTexel * normal;
    vec3 at = (mapFromWorld * vec4(off, 1.0)).xyz;
    return textureLod(sunShadow, vec3(at.xy, at.z - 1e-6), 0.0);
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(picture);
    if (any(greaterThanEqual(at, size))) return;
    float depth = texelFetch(depths, at, 0).r;
    vec3 direct = sky, scattered = vec3(0.0), reflected = vec3(0.0);
    if (depth > 0.0)
    {
        vec4 world = worldFromClip * vec4((vec2(at) + 0.5) / vec2(size) * 2.0 - 1.0, depth, 1.0);
        vec3 point = world.xyz / world.w, view = normalize(eye - point);
        vec4 normalRoughness = texelFetch(normalsRoughness, at, 0), base = texelFetch(baseColorsMetallic, at, 0);
        vec3 normal = normalRoughness.xyz;
        SconceBrdfSurface surface = SconceBrdfSurface(base.rgb, base.a, normalRoughness.w);
        float nv = dot(normal, view);
        // The library's reflection model, so that a surface answers the sun as it answers all other light.
        SconceBrdfValue value = sconceEvaluateLobes(sconceLobesAt(surface, nv), surface.roughness, normal, view, toSun);
        float nl = max(dot(normal, toSun), 0.0);
        direct = texelFetch(emissions, at, 0).rgb + nl * sunSeen(point, normal) * sunIrradiance * (value.diffuse + value.specular);
        indirectLight(at, surface, nv, made, raysBelow, scattered, reflected);
    }
    imageStore(directPicture, at, vec4(direct, 1.0));
    imageStore(scatteredPicture, at, vec4(scattered, 1.0));
    imageStore(reflectedPicture, at, vec4(reflected, 1.0));
    imageStore(picture, at, vec4(direct + scattered + reflected, 1.0));
}
