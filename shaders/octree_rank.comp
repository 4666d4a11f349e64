#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 2: the list of every finest voxel, one thread a voxel, a block of 4x4x4 voxels a workgroup. Writes `to`.
// Dispatch: blocks, `first` the first of them.
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main()
{
    uint block = first + gl_WorkGroupID.x;
    uvec3 blocks = uvec3((build.count + 3) / 4);
    ivec3 voxel = 4 * ivec3(block % blocks.x, block / blocks.x % blocks.y, block / blocks.x / blocks.y) + ivec3(gl_LocalInvocationID);
    if (any(greaterThanEqual(voxel, build.count))) return;
    to.list[indexIn(voxel, build.count)] = rankVoxel(voxel);
}
