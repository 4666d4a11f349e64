#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 3: the list of every finest voxel, one thread a voxel, a block of voxels a workgroup. Reads `sights`, writes `to`.
// Dispatch: as many of `blocks`, from `first` on: most hold no surface, and are ranked without looking for one.
layout(local_size_x = kBlock, local_size_y = kBlock, local_size_z = kBlock) in;

void main()
{
    readSettings();
    ivec3 block = blockOf(push.first + gl_WorkGroupID.x);
    candidateList = regionOf(kBlock * block) * build.candidates;
    sightRow = gl_WorkGroupID.x * (build.candidates + 1u);
    ivec3 voxel = kBlock * block + ivec3(gl_LocalInvocationID);
    if (all(lessThan(voxel, build.count))) push.to.list[indexIn(voxel, build.count)] = rankVoxel(voxel);
}
