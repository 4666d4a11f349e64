#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

// The viewer's picture: one of a frame's, as colours of 8 bits. Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2D beauty; // radiance to the eye, as the next three
layout(set = 0, binding = 1, rgba16f) readonly uniform image2D direct; // over its a
layout(set = 0, binding = 2, rgba16f) readonly uniform image2D diffuseLayer;
layout(set = 0, binding = 3, rgba16f) readonly uniform image2D glossyLayer;
layout(set = 0, binding = 4) uniform texture2D normalRoughness;
layout(set = 0, binding = 5) uniform texture2D baseColorMetallic;
layout(set = 0, binding = 6) uniform texture2D depthImage; // near / W; 0: nothing
layout(set = 0, binding = 7, rgba32ui) readonly uniform uimage2D counts; // probe, hand-offs, reads, unknown rays
layout(set = 0, binding = 8, rgba32f) readonly uniform image2D reference;
layout(set = 0, binding = 9, rgba8) writeonly uniform image2D picture;
layout(push_constant) uniform Push
{
    uint view;         // kViews of show.h
    uint compare;      // 0 off, 1 split, 2 difference
    uint made;         // bit i: view i has an image
    float exposure;
    float split;       // share of the width
    float depthScale;  // metres times what depthImage holds
    float depthMiddle; // metres that are half of white
};
const uint kNoProbe = 0xffffffffu;

/// Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with its customary exposure of 0.6: toneMapAces() of bench/reference/image_io.h.
float toneMapAces(float v)
{
    v = 0.6 * v;
    if (!(v > 0.0)) return 0.0;
    if (v > 1e6) return 1.0;
    return min(1.0, (v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14));
}
vec3 toneMapped(vec3 v) { return vec3(toneMapAces(exposure * v.r), toneMapAces(exposure * v.g), toneMapAces(exposure * v.b)); }

/// IEC 61966-2-1.
vec3 srgbFromLinear(vec3 v)
{
    v = clamp(v, vec3(0.0), vec3(1.0));
    return mix(1.055 * pow(max(v, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}

/// From black over blue and red to yellow and white, for numbers of [0,1].
vec3 heat(float t)
{
    t = clamp(t, 0.0, 1.0);
    return clamp(vec3(3.0 * t - 0.8, 3.0 * t - 1.7, t < 0.4 ? 2.5 * t : (t < 0.7 ? 1.0 - (t - 0.4) / 0.3 : (t - 0.7) / 0.3)), 0.0, 1.0);
}

/// A colour for a number, unlike its neighbours': hues go round by the golden ratio.
vec3 colourOf(uint n)
{
    vec3 hue = abs(fract(float(n & 0xffffu) * 0.618034 + vec3(0.0, 1.0 / 3.0, 2.0 / 3.0)) * 6.0 - 3.0) - 1.0;
    return mix(vec3(1.0), clamp(hue, 0.0, 1.0), 0.85) * ((n & 1u) == 0u ? 0.8 : 0.35);
}

vec3 linearView(ivec2 at)
{
    if ((made & (1u << view)) == 0u) return vec3(0.0);
    uvec4 n = imageLoad(counts, view >= 8u ? at : ivec2(0));
    float w = texelFetch(depthImage, at, 0).r;
    switch (view)
    {
    case 0u: return toneMapped(imageLoad(beauty, at).rgb);
    case 1u: return toneMapped(imageLoad(direct, at).rgb * imageLoad(direct, at).a);
    case 2u: return toneMapped(imageLoad(diffuseLayer, at).rgb);
    case 3u: return toneMapped(imageLoad(glossyLayer, at).rgb);
    case 5u: return texelFetch(baseColorMetallic, at, 0).rgb;
    case 6u: return w > 0.0 ? vec3(depthMiddle / (depthMiddle + depthScale / w)) : vec3(0.0);
    case 8u: return n.x == kNoProbe || n.z == 0u ? vec3(0.0) : colourOf(n.x);
    case 9u: return heat(float(n.y) / 8.0);
    case 10u: return heat(float(n.z) / 64.0);
    case 11u: return n.w > 0u ? vec3(1.0, 0.05, 0.02) : vec3(n.z > 0u ? 0.05 : 0.0);
    }
    return vec3(0.0);
}

/// Views that are numbers as they are, without the curve of sRGB.
vec3 encodedView(ivec2 at)
{
    float w = texelFetch(depthImage, at, 0).r;
    if (view == 4u) return w > 0.0 ? 0.5 + 0.5 * texelFetch(normalRoughness, at, 0).rgb : vec3(0.0);
    if (view == 7u) return w > 0.0 ? vec3(roughnessOf(texelFetch(normalRoughness, at, 0).a)) : vec3(0.0);
    return srgbFromLinear(linearView(at));
}

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(picture);
    if (any(greaterThanEqual(at, size))) return;
    vec3 colour = encodedView(at);
    if (compare == 1u)
    {
        float edge = split * float(size.x);
        if (float(at.x) >= edge) colour = srgbFromLinear(toneMapped(imageLoad(reference, at).rgb));
        if (abs(float(at.x) + 0.5 - edge) < 1.0) colour = vec3(1.0, 0.8, 0.2);
    }
    else if (compare == 2u)
    {
        // Red: ours is brighter; blue: darker; by what the eye sees, four times over.
        const vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
        float off = 4.0 * dot(luminance, srgbFromLinear(toneMapped(imageLoad(beauty, at).rgb)) -
                                             srgbFromLinear(toneMapped(imageLoad(reference, at).rgb)));
        colour = off > 0.0 ? vec3(off, 0.25 * off, 0.0) : vec3(0.0, -0.35 * off, -off);
        colour = clamp(colour + 0.04, 0.0, 1.0);
    }
    imageStore(picture, at, vec4(colour, 1.0));
}
