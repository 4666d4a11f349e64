#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"
uint chainWord(uint index) { return push.words.word[index]; }
#include "shared/face_chain_build.h"

// Bake: one level of the chain of six faces, or with level 0 their far bounds. `push.level` is the level written.
// Dispatch: ceil(chainWidth/8) twice x 6; far bounds: a square of threads that has one for each word, x 6.
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uint first = gl_GlobalInvocationID.z * push.faceWords;
    if (push.level == 0u)
    {
        int top = chainTop(push.size);
        uint k = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 8u + gl_GlobalInvocationID.x;
        uint near = chainNearWords(push.size, top);
        if (k < chainWords(push.size, top) - near) push.words.word[first + near + k] = farBoundPair(first, push.size, top, k);
        return;
    }
    uvec2 at = gl_GlobalInvocationID.xy;
    uint width = chainWidth(push.size, int(push.level));
    if (at.x >= width || at.y >= width) return;
    push.words.word[first + chainOffset(push.size, int(push.level)) + at.y * width + at.x] = boundingPlane(first, push.size, int(push.level), at.x, at.y);
}
