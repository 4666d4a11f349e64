#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "bake_probe.glsl"
#include "lights.glsl"

// Bake: a probe's rasterised faces become distance words, radiance under direct light, and what a bounce needs of the surface.
// Reflectance = diffuse part + specular reflectance at normal incidence: glossy lobes are baked as diffuse ones of the same strength.
// Dispatch: ceil(N/8) x ceil(N/8) x 6.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 0) uniform utexture2D surfaceImage; // [6 N][N], faces below each other; layout: bake_gbuffer.frag
layout(set = 1, binding = 1) uniform texture2D depthImage;    // near / W, 0: sky

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= size || at.y >= size) return;
    ivec2 pixel = ivec2(at.x, at.z * size + at.y);
    uint wordIndex = at.z * faceWords + at.y * size + at.x;
    uint index = (at.z * size + at.y) * size + at.x;
    float depth = texelFetch(depthImage, pixel, 0).x;
    if (depth <= 0.0)
    {
        words.word[wordIndex] = 0u;
        radiance.word[index] = packRadiance(sky);
        surface.word[index] = 0u;
        if (!isNull(emitted)) emitted.word[index] = 0u;
        return;
    }
    uvec4 seen = texelFetch(surfaceImage, pixel, 0);
    vec4 base = unpackUnorm4x8(seen.x);
    vec3 baseColor = base.rgb * base.rgb;
    vec3 shading = directionFromOctahedral(unpackUnorm2x16(seen.y));
    vec3 geometric = directionFromOctahedral(unpackUnorm2x16(seen.z));
    vec3 emission = unpackRadiance(seen.w);

    float q = depth / nearPlane;
    vec3 uvw = vec3(texelOnFace(at.xy, size), 1.0);
    vec3 p = centre + faceDirection(int(at.z), uvw) / q;

    // The surfel's plane n.x = D: q = n.(u, v, 1) / D, so its relative change a texel is (n_U, n_V) / n.(u, v, 1) * 2 / N.
    vec3 n = faceCoordinates(int(at.z), geometric);
    float facing = dot(n, uvw);
    vec2 gradient = abs(facing) > 1e-6 ? n.xy / facing * (2.0 / float(size)) : vec2(0.0);
    words.word[wordIndex] = packTexel(q, gradient.x, gradient.y);

    vec3 albedo = baseColor * (1.0 - base.a) * 0.96 + mix(vec3(0.04), baseColor, base.a);
    vec3 irradiance = directLight(p, shading, geometric);
    radiance.word[index] = packRadiance(emission + albedo * irradiance / SCONCE_BRDF_PI);
    if (!isNull(emitted)) emitted.word[index] = seen.w;
    surface.word[index] = max(packAlbedo(albedo, ditherOf(index)) | (packNormal8(shading) << 16), 1u); // 0 is the sky's
}
