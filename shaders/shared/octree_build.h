// What the passes that build the octree's lists share: GPU passes and their CPU twin run octree_rank.h on these.
#include "shared/gpu_types.h"
#ifndef SCONCE_OCTREE_BUILD_H
#define SCONCE_OCTREE_BUILD_H
SCONCE_STRUCTS_BEGIN

const uint kSurfelSlots = 16u; // surface samples a voxel keeps: one an octant of the voxel and side of the surface
const int kBlock = 4;                // voxels a side of the blocks whose candidates are culled together; a region holds whole blocks
const uint kMostCandidates = 256u;   // of a region
const uint kNoSurfel = 0xffffffffu;
const uint kNoList = 0xffffffffu; // first word of a voxel that no probe sees (second word the same), or of a node whose children differ (0)

/// Where the voxels lie and whom they may ask. Field space.
struct OctreeBuild
{
    vec3 low;
    float voxel;
    ivec3 count;         // finest voxels
    float inverseVoxel;
    ivec3 regions;       // blocks of voxels that share one list of candidates
    int regionShift;     // a region has 2^regionShift voxels a side
    uint candidates;     // entries of a region's list
    uint probeCount;
    uint faceSize;
    uint wordsPerProbe;
    uint sampleStep;     // texels between the surface samples of a face, per axis
    uint sampleSide;     // samples a side of a face
    float texelWidth;    // 2 / faceSize
    float slack;         // of a visibility test, share of the distance
    uint topLevel;       // coarsest level of a face's chain
    uint unused;
};
SCONCE_CHECK_SIZE(OctreeBuild, 88);

SCONCE_STRUCTS_END
#endif
