#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "sparse.glsl"

// The pixels of a traced term that no ray was spent on (trace_glossy.comp marks them), from the traced ones about them. Reflections are
// interpolated as light before the surface's tint, so that a metal's texture stays sharp. Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(constant_id = kUntintedId) const bool kUntinted = false; // reflections are light before the surface's tint
layout(set = 1, binding = kFillLightBinding, rgba16f) uniform image2D light; // in place: a pixel is either read or written

void main()
{
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    uint terms;
    Pixel p = readPacked(at, terms);
    if ((terms & (1u << kTerm)) == 0u || imageLoad(light, at).a != kNotTraced) return;
    Surroundings about = surroundingsOf(p);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 9; ++i)
    {
        ivec2 tap = latticePixel(cellAbout(at, i));
        float weight = latticeWeight(about, at, tap, kTerm);
        if (weight <= 0.0) continue;
        vec4 value = imageLoad(light, tap);
        if (kTerm == kTermGlossy && !kUntinted) value.rgb /= tintOf(readPixel(tap));
        sum += weight * value;
        weights += weight;
    }
    sum /= weights; // not 0: the pixel would have been traced
    if (kTerm == kTermGlossy && !kUntinted) sum.rgb *= tintOf(readPixel(at));
    imageStore(light, at, storedLight(sum));
}
