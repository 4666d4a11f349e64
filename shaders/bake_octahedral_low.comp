#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"

// Bake: the octahedral map's low-resolution level, (minimum, maximum) of r over kLowFactor^2 texels; halves compare as their bits do.
// Dispatch: ceil(N/kLowFactor/8) twice.
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    uint width = push.size / kLowFactor;
    if (at.x >= width || at.y >= width) return;
    uint low = 0xffffu, high = 0u;
    for (uint child = 0u; child < kLowFactor * kLowFactor; ++child)
    {
        uvec2 texel = at * kLowFactor + uvec2(child % kLowFactor, child / kLowFactor);
        uint r = push.words.word[texel.y * push.size + texel.x] & 0xffffu;
        low = min(low, r);
        high = max(high, r);
    }
    push.words.word[push.size * push.size + at.y * width + at.x] = low | (high << 16);
}
