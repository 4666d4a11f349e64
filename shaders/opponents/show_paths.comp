#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "opponents/path_picture.h"

// In place of trace_glossy.comp: light that a path tracer has found already, pixel by pixel, for our filters to work on. The light field's
// radiance is that picture (path_picture.h). Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(constant_id = kUntintedId) const bool kUntinted = false; // as in trace_glossy.glsl
layout(set = 1, binding = kTraceLightBinding, rgba16f) writeonly uniform image2D reflected;

vec3 pathLight(ivec2 at, uint part)
{
    uint word = kPathWords * (uint(at.y) * frame.size.x + uint(at.x)) + 3u * part;
    return uintBitsToFloat(uvec3(radianceWord(word), radianceWord(word + 1u), radianceWord(word + 2u)));
}

void main()
{
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    Pixel p = readPixel(at);
    if (!p.surface || isNotOf(kTerm, termsOf(p))) return;
    vec3 light = pathLight(at, kTerm == kTermDiffuse ? 0u : 1u);
    // A filter works on what arrives: composition gives the texture back.
    if (kTerm == kTermDiffuse) light /= max(lobesAt(p.brdf, dot(p.normal, p.view)).diffuse, vec3(1e-4));
    if (kUntinted) light /= tintOf(p);
    imageStore(reflected, at, storedLight(vec4(light, 1.0)));
}
