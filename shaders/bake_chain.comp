#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"

// Bake: one level of the (maximum, minimum) chain of q of six faces, from the level two below it. Conservative: a texel's bounds cover the
// surfel planes of all texels below it. After Wang et al. 2019, section 4.2. Dispatch: ceil((N >> level)/8) twice x 6.
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    uint width = size >> level, below = size >> (level - 2u);
    if (at.x >= width || at.y >= width) return;
    uint finer = at.z * faceWords;
    for (uint l = 0u; l + 2u < level; l += 2u) finer += (size >> l) * (size >> l);
    uint joined = 0xffff0000u; // maximum 0, minimum above any half
    for (uint child = 0u; child < 16u; ++child)
    {
        uint word = words.word[finer + (4u * at.y + child / 4u) * below + 4u * at.x + child % 4u];
        joined = joinBounds(joined, level == 2u ? texelBounds(word) : word);
    }
    words.word[finer + below * below + at.y * width + at.x] = joined;
}
