// What passes that go over the picture's neighbours ask of a pixel, in two words: one read of 8 bytes in place of the G-buffer's three. classify_tiles.comp,
// which reads the G-buffer for all, writes them. After gbuffer_read.glsl.
#include "shared/texel.h"
#include "shared/chart.h"
#ifdef SCONCE_PACKS
layout(set = 1, binding = kPackedBinding, rg32ui) writeonly uniform uimage2D packedPixels;
#else
layout(set = 1, binding = kPackedBinding, rg32ui) readonly uniform uimage2D packedPixels;
#endif

// Depth as it is; from the lowest bit on those of its terms, the normal as kNormalBits of each side of the octahedral map, within 0.2 degrees, whether
// it is retroreflective, and kRoughnessBits.
const uint kNormalBits = 10u, kRetroBit = kTermCount + 2u * kNormalBits, kRoughnessBits = 31u - kRetroBit;
const float kNormalSteps = float((1u << kNormalBits) - 2u); // even: axes are exact
const float kRoughnessSteps = float((1u << kRoughnessBits) - 1u);

#ifdef SCONCE_PACKS
/// @param terms  termsOf(p): 0 where there is no surface
uvec2 packedOf(Pixel p, uint terms)
{
    if (terms == 0u) return uvec2(0u);
    uvec2 uv = uvec2(octahedralFromDirection(p.normal) * kNormalSteps + 0.5);
    uint roughness = uint(clamp(p.brdf.roughness, 0.0, 1.0) * kRoughnessSteps + 0.5);
    return uvec2(floatBitsToUint(p.clip.z), terms | (uv.x << kTermCount) | (uv.y << (kTermCount + kNormalBits)) | (p.retro ? 1u << kRetroBit : 0u) | (roughness << (32u - kRoughnessBits)));
}

#else
/// As readPixel(), but for view and reflection model, of which there is the roughness alone.
/// @param terms  termsOf() of it
Pixel readPacked(ivec2 at, out uint terms)
{
    uvec2 word = imageLoad(packedPixels, at).xy;
    terms = bitfieldExtract(word.y, 0, int(kTermCount));
    Pixel p;
    p.surface = terms != 0u;
    p.clip = vec4((vec2(at) + 0.5) / vec2(frame.size) * 2.0 - 1.0, uintBitsToFloat(word.x), 1.0);
    vec4 world = frame.worldFromClip * p.clip;
    p.position = world.xyz / world.w;
    p.normal = directionFromOctahedral(vec2(bitfieldExtract(word.y, int(kTermCount), int(kNormalBits)), bitfieldExtract(word.y, int(kTermCount + kNormalBits), int(kNormalBits))) / kNormalSteps);
    p.view = vec3(0.0);
    p.retro = bitfieldExtract(word.y, int(kRetroBit), 1) != 0u;
    p.brdf = BrdfSurface(vec3(0.0), 0.0, float(word.y >> (32u - kRoughnessBits)) / kRoughnessSteps);
    return p;
}
Pixel readPacked(ivec2 at)
{
    uint terms;
    return readPacked(at, terms);
}
#endif
