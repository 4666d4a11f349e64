#version 460
#extension GL_GOOGLE_include_directive : require
#include "octree_build.glsl"

// Octree pass 2: the list of every finest voxel, one thread a voxel, a block of voxels a workgroup, which first culls the block's
// candidates together. Writes `to`. Dispatch: blocks, `first` the first of them.
layout(local_size_x = kBlock, local_size_y = kBlock, local_size_z = kBlock) in;

shared uint mayBits[kMostCandidates / 32u], allBits[kMostCandidates / 32u];

void main()
{
    readSettings();
    uint number = push.first + gl_WorkGroupID.x;
    uvec3 blocks = uvec3((build.count + kBlock - 1) / kBlock);
    ivec3 block = ivec3(number % blocks.x, number / blocks.x % blocks.y, number / blocks.x / blocks.y);
    uint thread = gl_LocalInvocationIndex;
    if (thread < kMostCandidates / 32u) mayBits[thread] = allBits[thread] = 0u;
    barrier(); // no bit may be set before all are cleared
    uint list = regionOf(kBlock * block) * build.candidates;
    uint threads = uint(kBlock * kBlock * kBlock);
    for (uint i = thread; i < build.candidates; i += threads)
    {
        int sight = sightOf(candidates.candidate[list + i].x, block);
        if (sight != kSightNone) atomicOr(mayBits[i / 32u], 1u << (i % 32u));
        if (sight == kSightAll) atomicOr(allBits[i / 32u], 1u << (i % 32u));
    }
    barrier(); // a place in the list counts the bits of all candidates before it
    for (uint i = thread; i < build.candidates; i += threads)
    {
        uint place = bitCount(mayBits[i / 32u] & ((1u << (i % 32u)) - 1u));
        for (uint word = 0u; word < i / 32u; ++word) place += bitCount(mayBits[word]);
        bool keeps = (mayBits[i / 32u] >> (i % 32u) & 1u) != 0u;
        uint all_ = (allBits[i / 32u] >> (i % 32u) & 1u) != 0u ? kSeesAll : 0u;
        if (keeps) kept[place] = candidates.candidate[list + i] | uvec2(all_, 0u);
        if (i + 1u == build.candidates) keptCount = place + uint(keeps);
    }
    barrier(); // every voxel ranks the whole list
    ivec3 voxel = kBlock * block + ivec3(gl_LocalInvocationID);
    if (all(lessThan(voxel, build.count))) push.to.list[indexIn(voxel, build.count)] = rankVoxel(voxel);
}
