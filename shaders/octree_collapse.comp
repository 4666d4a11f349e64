#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 5: the lists of one level's nodes from those of their children, one thread a node. `from` -> `to`.
// Dispatch: ceil(size / 4) thrice.
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

void main()
{
    ivec3 node = ivec3(gl_GlobalInvocationID);
    if (all(lessThan(node, push.size))) push.to.list[indexIn(node, push.size)] = joinedList(node, push.size);
}
