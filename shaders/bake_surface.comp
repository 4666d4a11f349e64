#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "bake_probe.glsl"
#include "probe_face.glsl"
#include "lights.glsl"

// Bake: a probe's rasterised faces become distance words, radiance under direct light, and what a bounce needs of the surface: all lobes are
// baked as one diffuse lobe that reflects as much light (hemisphericalAlbedo).
// Dispatch: ceil(N/8) x ceil(N/8) x 6.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = kBakeSurfaceBinding) uniform utexture2D surfaceImage; // [6 N][N], faces below each other; layout: probe_face.glsl
layout(set = 1, binding = kBakeDepthBinding) uniform texture2D depthImage;    // near / W, 0: sky

layout(constant_id = kBakeAreaLightId) const bool kAreaLight = true;
layout(constant_id = kBakeCoatsId) const bool kCoatsByRays = false;

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= push.size || at.y >= push.size) return;
    ivec2 pixel = ivec2(at.x, at.z * push.size + at.y);
    uint wordIndex = at.z * push.faceWords + at.y * push.size + at.x;
    uint index = (at.z * push.size + at.y) * push.size + at.x;
    float depth = texelFetch(depthImage, pixel, 0).x;
    if (depth <= 0.0)
    {
        push.words.word[wordIndex] = 0u;
        push.radiance.word[index] = packRadiance(push.sky);
        push.surface.word[index] = 0u;
        if (!isNull(push.emitted)) push.emitted.word[index] = 0u;
        return;
    }
    uvec4 seen = texelFetch(surfaceImage, pixel, 0);
    vec3 shading = seenNormal(seen.y);
    vec3 geometric = directionFromOctahedral(unpackUnorm2x16(seen.z));
    vec3 emission = unpackRadiance(seen.w);

    float q = depth / push.nearPlane;
    vec3 uvw = vec3(texelOnFace(at.xy, push.size), 1.0);
    vec3 p = push.centre + faceDirection(int(at.z), uvw) / q;

    // The surfel's plane n.x = D: q = n.(u, v, 1) / D, so its relative change a texel is (n_U, n_V) / n.(u, v, 1) * 2 / N.
    vec3 n = faceCoordinates(int(at.z), geometric);
    float facing = dot(n, uvw);
    vec2 gradient = abs(facing) > 1e-6 ? n.xy / facing * (2.0 / float(push.size)) : vec2(0.0);
    push.words.word[wordIndex] = packTexel(q, gradient.x, gradient.y);

    vec3 albedo = unpackRootOfColor(seen.x);
    float straight = seenTogether(seen.y) * (kCoatsByRays ? seenToAllSides(seen.y) : 1.0);
    float grazing = seenGrazing(seen.y);
    vec3 irradiance = straight * deltaLight(p, shading, geometric, kCoatsByRays ? grazing : min(grazing, 0.0)); // a metal's lean needs no rays
    if (kAreaLight) irradiance += areaLight(p, shading, geometric);
    push.radiance.word[index] = packRadiance(emission + albedo * irradiance / kBrdfPi);
    if (!isNull(push.emitted)) push.emitted.word[index] = seen.w;
    push.surface.word[index] = max(packAlbedo(albedo, ditherOf(index)) | (packNormal8(shading) << 16), 1u); // 0 is the sky's
}
