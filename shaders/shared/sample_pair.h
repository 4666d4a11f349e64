// The random numbers of a pixel's samples.
#include "shared/gpu_types.h"
#ifndef SCONCE_SAMPLE_PAIR_H
#define SCONCE_SAMPLE_PAIR_H
SCONCE_STRUCTS_BEGIN

const uint kSampleBits = 6u; // of a sample's index: 64 samples a pixel and frame; noise that is left falls over frames

SCONCE_FN uint spreadBits(uint v) // bit i to bit 2 i, of the lower 8
{
    v = (v | (v << 4u)) & 0x0f0fu;
    v = (v | (v << 2u)) & 0x3333u;
    return (v | (v << 1u)) & 0x5555u;
}

/// Two numbers uniform in [0,1)^2 for a sample (0..63) of a pixel: the R2 sequence (Roberts 2018, "The Unreasonable Effectiveness of
/// Quasirandom Sequences") along a Morton curve over the picture, so that neighbouring pixels take well-spread samples and a filter over
/// them converges faster than over independent ones. Streams and seeds are shifted against each other (PCG hash).
SCONCE_FN vec2 randomPair(uvec2 pixel, uint sampleIndex, uint stream, uint seed)
{
    uint n = ((spreadBits(pixel.x & 255u) | (spreadBits(pixel.y & 255u) << 1u)) << kSampleBits) | sampleIndex;
    uint state = (stream * 747796405u + seed * 2891336453u) ^ ((pixel.x >> 8u) * 0x9e3779b9u + (pixel.y >> 8u) * 0x85ebca6bu);
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    word = (word >> 22u) ^ word;
    uvec2 u = uvec2(n * 3242174889u + word, n * 2447445414u + word * 2654435769u); // 2^32 / p and 2^32 / p^2, p^3 = p + 1
    return vec2(u >> 8u) * (1.0f / 16777216.0f);
}

/// Of any number of samples, the i-th; beyond those of one sequence others follow.
SCONCE_FN vec2 pairOfRay(uvec2 pixel, uint i, uint stream)
{
    return randomPair(pixel, i & ((1u << kSampleBits) - 1u), stream, 2654435769u * (i >> kSampleBits));
}

/// Of the i-th of a frame's samples of a pixel: a pixel's frames go along one sequence, so that what is blended over time is spread as well as
/// what one frame takes.
SCONCE_FN vec2 pairOfFrame(uvec2 pixel, uint frameNumber, uint samples, uint i, uint stream)
{
    return pairOfRay(pixel, frameNumber * samples + i, stream);
}

SCONCE_STRUCTS_END
#endif
