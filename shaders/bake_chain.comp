#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"
uint chainWord(uint index) { return words.word[index]; }
#define SCONCE_BUILDS_CHAINS
#include "shared/face_chain.h"

// Bake: one level of the chain of six faces, or with level 0 their far bounds. `level` is the level written.
// Dispatch: ceil(chainWidth/8) twice x 6; far bounds: a square of threads that has one for each word, x 6.
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    uint first = gl_GlobalInvocationID.z * faceWords;
    if (level == 0u)
    {
        int top = chainTop(size);
        uint k = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 8u + gl_GlobalInvocationID.x;
        uint near = chainNearWords(size, top);
        if (k < chainWords(size, top) - near) words.word[first + near + k] = farBoundPair(first, size, top, k);
        return;
    }
    uvec2 at = gl_GlobalInvocationID.xy;
    uint width = chainWidth(size, int(level));
    if (at.x >= width || at.y >= width) return;
    words.word[first + chainOffset(size, int(level)) + at.y * width + at.x] = boundingPlane(first, size, int(level), at.x, at.y);
}
