#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"

// The frame's picture: direct light and the terms of indirect light that a pixel has and that are made; the image of a term is read where
// the pixel has the term, and nowhere else. What is read is sampled: some devices let a pass have four images to store into and no more.
// Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kMadeId) const uint kMade = 15u;     // bit i: term i is made
layout(constant_id = kDiffuseLayerId) const bool kDiffuseLayer = true; // write the term's share of the picture, too
layout(constant_id = kGlossyLayerId) const bool kGlossyLayer = true;
layout(set = 1, binding = kComposeDirectBinding) uniform texture2D direct; // storedBright()
layout(set = 1, binding = kComposeDiffuseBinding) uniform texture2D diffuse; // cosine-weighted mean of the arriving radiance
layout(set = 1, binding = kComposeRoughBinding) uniform texture2D rough;   // these three: radiance reflected to the eye
layout(set = 1, binding = kComposeGlossyBinding) uniform texture2D glossy;
layout(set = 1, binding = kComposeMirrorBinding) uniform texture2D mirror;
layout(set = 1, binding = kComposeBeautyBinding, rgba32f) writeonly uniform image2D beauty; // a: 0 where a term was brighter than its image holds
layout(set = 1, binding = kComposeDiffuseLayerBinding, rgba16f) writeonly uniform image2D diffuseLayer; // rgb radiance to the eye
layout(set = 1, binding = kComposeGlossyLayerBinding, rgba16f) writeonly uniform image2D glossyLayer;  // of all reflections

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    vec3 light = brightLight(texelFetch(direct, at, 0));
    Pixel p = readPixel(at);
    uint terms = termsOf(p) & kMade;
    const vec3 none = vec3(0.0);
    vec3 d = (terms & (1u << kTermDiffuse)) != 0u ? texelFetch(diffuse, at, 0).rgb : none, r = (terms & (1u << kTermRough)) != 0u ? texelFetch(rough, at, 0).rgb : none,
         g = (terms & (1u << kTermGlossy)) != 0u ? texelFetch(glossy, at, 0).rgb : none, m = (terms & (1u << kTermMirror)) != 0u ? texelFetch(mirror, at, 0).rgb : none;
    IndirectSent sent = IndirectSent(none, none);
    if (terms != 0u) sent = composeIndirect(p.brdf, dot(p.normal, p.view), frame.raysBelow, terms, d, r, g, m);
    bool whole = all(lessThan(max(max(d, r), max(g, m)), vec3(kMostLight)));
    imageStore(beauty, at, vec4(light + sent.scattered + sent.reflected, whole ? 1.0 : 0.0));
    if (kDiffuseLayer) imageStore(diffuseLayer, at, storedLight(vec4(sent.scattered, 1.0)));
    if (kGlossyLayer) imageStore(glossyLayer, at, storedLight(vec4(sent.reflected, 1.0)));
}
