#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"

// The frame's picture: direct light and the terms of indirect light that a pixel has and that are made; the image of a term is read where
// the pixel has the term, and nowhere else. Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kMadeId) const uint kMade = 15u;     // bit i: term i is made
layout(constant_id = kDiffuseLayerId) const bool kDiffuseLayer = true; // write the term's share of the picture, too
layout(constant_id = kGlossyLayerId) const bool kGlossyLayer = true;
layout(set = 1, binding = kComposeDirectBinding, rgba32f) readonly uniform image2D direct;
layout(set = 1, binding = kComposeDiffuseBinding, rgba32f) readonly uniform image2D diffuse; // cosine-weighted mean of the arriving radiance
layout(set = 1, binding = kComposeRoughBinding, rgba32f) readonly uniform image2D rough;   // these three: radiance reflected to the eye
layout(set = 1, binding = kComposeGlossyBinding, rgba32f) readonly uniform image2D glossy;
layout(set = 1, binding = kComposeMirrorBinding, rgba32f) readonly uniform image2D mirror;
layout(set = 1, binding = kComposeBeautyBinding, rgba32f) writeonly uniform image2D beauty;
layout(set = 1, binding = kComposeDiffuseLayerBinding, rgba32f) writeonly uniform image2D diffuseLayer; // rgb radiance to the eye
layout(set = 1, binding = kComposeGlossyLayerBinding, rgba32f) writeonly uniform image2D glossyLayer;  // of all reflections

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    vec3 light = imageLoad(direct, at).rgb;
    Pixel p = readPixel(at);
    uint terms = termsOf(p) & kMade;
    vec3 scattered = vec3(0.0), reflected = vec3(0.0);
    if ((terms & (1u << kTermDiffuse)) != 0u)
        scattered = imageLoad(diffuse, at).rgb * lobesAt(p.brdf, dot(p.normal, p.view)).diffuse;
    float rays = shareOfRays(p.brdf.roughness);
    if ((terms & (1u << kTermRough)) != 0u) reflected += (1.0 - rays) * imageLoad(rough, at).rgb;
    if ((terms & (1u << kTermGlossy)) != 0u) reflected += rays * imageLoad(glossy, at).rgb;
    if ((terms & (1u << kTermMirror)) != 0u) reflected += imageLoad(mirror, at).rgb;
    imageStore(beauty, at, vec4(light + scattered + reflected, 1.0));
    if (kDiffuseLayer) imageStore(diffuseLayer, at, vec4(scattered, 1.0));
    if (kGlossyLayer) imageStore(glossyLayer, at, vec4(reflected, 1.0));
}
