// What the passes of a frame are told. Scalar layout.
#include "shared/gpu_types.h"
#ifndef SCONCE_FRAME_H
#define SCONCE_FRAME_H
SCONCE_STRUCTS_BEGIN

struct FrameView
{
    mat4 worldFromClip;  // of the camera the G-buffer was drawn with; its depth is reversed: 1 at the near plane, 0 at infinity
    vec3 eye;            // world, metres
    uint seed;           // changes from frame to frame
    uvec2 size;          // pixels
    uint glossyRays;     // rays a pixel, 1..64
    float normalOffset;  // metres a ray starts off its surface; 1e-4 of the scene's diagonal
};
SCONCE_CHECK_SIZE(FrameView, 96);

SCONCE_STRUCTS_END

#ifndef __cplusplus
/// Uniform in [0,1)^2 for a pixel, a sample and a frame. Hash: Jarzynski and Olano 2020, "Hash Functions for GPU Rendering" (PCG3D).
vec2 randomPair(uvec2 pixel, uint sampleIndex, uint seed)
{
    uvec3 v = uvec3(pixel, sampleIndex + seed * 0x9e3779b9u) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec2(v.xy >> 8) * (1.0 / 16777216.0);
}
#endif

#endif
