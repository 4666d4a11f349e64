#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 1: every surface sample of the probes' maps goes to its voxel's slot; the smallest key stays, whatever the order of the
// threads. Dispatch: ceil(samples / 64).
layout(local_size_x = 64) in;

void main()
{
    readSettings();
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint number = push.first + gl_GlobalInvocationID.x;
    vec3 position, normal;
    if (!surfelOf(number, position, normal)) return;
    uint slot = surfelSlot(position, normal);
    if (slot == kNoSurfel) return;
    atomicMin(push.surfels.key[slot], number * kKeyFactor);
    uint index = slot / kSurfelSlots;
    uvec3 count = uvec3(build.count);
    ivec3 voxel = ivec3(index % count.x, index / count.x % count.y, index / count.x / count.y);
    atomicOr(push.blocks.block[indexIn(voxel / kBlock, (build.count + kBlock - 1) / kBlock)], 1u);
}
