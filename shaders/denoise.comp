#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"
#include "packed_pixel.glsl"
#include "tiles.glsl"

// One step of a cross-bilateral filter over the G-buffer: 3x3 taps, `stride` pixels apart; steps of stride 1, 2, 4, 8 reach 15 pixels (Dammertz
// et al. 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering", with 5x5 taps in 3 steps: twice the reads).
// McGuire et al. 2017, section 5.1, filter glossy light narrowly and diffuse light widely: here a glossy pixel's reach follows its roughness.
// Only pixels that have the term are read. Reflections are filtered before the surface's tint, so that a metal's texture stays; the last step gives it back.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(constant_id = kBlendedId) const bool kBlended = false; // the light's a is the number of frames blended into it (temporal.comp)
layout(set = 1, binding = kFilterFromBinding, rgba16f) readonly uniform image2D noisy;
layout(set = 1, binding = kFilterToBinding, rgba16f) writeonly uniform image2D smooth_;
layout(scalar, push_constant) uniform Push { DenoisePush push; };

const float kHat[2] = float[](1.0 / 2.0, 1.0 / 4.0);

void main()
{
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    uint terms;
    Pixel p = readPacked(at, terms);
    if (isNotOf(kTerm, terms)) return;
    vec4 own = imageLoad(noisy, at);
    float reach = push.followRoughness != 0 ? filterReach(p.brdf.roughness) : kFilterReach;
    reach *= inversesqrt(float(frame.glossyRays)); // as the noise falls
    if (kBlended) reach = max(reach * inversesqrt(max(own.a, 1.0)), min(reach, 3.0));
    vec3 tint = kTerm == kTermGlossy && push.last != 0 && p.surface ? tintOf(readPixel(at)) : vec3(1.0);
    if (!p.surface || reach < float(push.stride))
    {
        imageStore(smooth_, at, storedLight(vec4(own.rgb * tint, own.a)));
        return;
    }
    Surroundings about = surroundingsOf(p);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
        {
            ivec2 tap = at + push.stride * ivec2(dx, dy);
            if (float(push.stride * push.stride * (dx * dx + dy * dy)) > reach * reach || any(lessThan(tap, ivec2(0))) ||
                any(greaterThanEqual(tap, ivec2(frame.size)))) continue;
            Pixel q = readPacked(tap, terms);
            if ((terms & (1u << kTerm)) == 0u) continue;
            float weight = kHat[abs(dx)] * kHat[abs(dy)] * likeness(about, q);
            sum += weight * imageLoad(noisy, tap).rgb;
            weights += weight;
        }
    imageStore(smooth_, at, storedLight(vec4((weights > 0.0 ? sum / weights : own.rgb) * tint, own.a)));
}
