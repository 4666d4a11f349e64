#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 2: which of its region's candidates may see something of a block of voxels, in their order; one thread a block. Writes `sights`.
// Dispatch: ceil(count / 64), of `blocks` from `first` on.
layout(local_size_x = 64) in;

void main()
{
    readSettings();
    if (gl_GlobalInvocationID.x >= push.count) return;
    ivec3 block = blockOf(push.first + gl_GlobalInvocationID.x);
    uint list = regionOf(kBlock * block) * build.candidates;
    uint row = gl_GlobalInvocationID.x * (build.candidates + 1u);
    uint kept = 0u;
    for (uint i = 0u; i < build.candidates; ++i)
    {
        int sight = sightOf(candidates.candidate[list + i].x, block);
        if (sight == kSightNone) continue;
        ++kept;
        push.sights.word[row + kept] = i | (sight == kSightAll ? kSeesAll : 0u);
    }
    push.sights.word[row] = kept;
}
