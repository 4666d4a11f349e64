#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 4: a voxel that no probe sees takes a neighbour's list. `from` -> `to`. Dispatch: ceil(size / 4) thrice.
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main()
{
    ivec3 voxel = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(voxel, push.size))) push.to.list[indexIn(voxel, push.size)] = filledList(voxel, push.size);
}
