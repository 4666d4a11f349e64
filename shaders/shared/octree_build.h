// What the passes that build the octree's lists share: GPU passes and their CPU twin run octree_rank.h on these.
#include "shared/light_field.h"
#ifndef SCONCE_OCTREE_BUILD_H
#define SCONCE_OCTREE_BUILD_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MapWords { uint word[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Probes { ProbeHeader probe[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Candidates { uvec2 candidate[]; };
#endif
SCONCE_STRUCTS_BEGIN

const uint kSurfelSlots = 16u; // surface samples a voxel keeps: one an octant of the voxel and side of the surface
const int kFreeSamples = 9;          // points of free space that a voxel is judged at: centre and 8 toward the corners
const int kBlock = 4;                // voxels a side of the blocks whose candidates are culled together; a region holds whole blocks
const uint kMostCandidates = 256u;   // of a region
const uint kSeesAll = 0x80000000u;   // of a candidate of a block: nothing is before any point there
const uint kNoSurfel = 0xffffffffu;
const uint kWithSurfelsId = 0u;  // specialization constant of the ranking: whether its blocks hold surface samples
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

/// What all passes read.
struct OctreeInputs
{
    OctreeBuild build;
    DeviceAddress distance;   // MapWords, as numbers: SCONCE_ADDRESS in gpu_types.h
    DeviceAddress probes;     // Probes
    DeviceAddress candidates; // Candidates: [region][build.candidates] probe, weight
};
SCONCE_CHECK_SIZE(OctreeInputs, 112);
#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Inputs { OctreeInputs inputs; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SurfelKeys { uint key[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Lists { uvec2 list[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Blocks { uint block[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Sights { uint word[]; };
#endif

struct OctreePush
{
    SCONCE_ADDRESS(Inputs) settings;
    SCONCE_ADDRESS(SurfelKeys) surfels; // [voxel][kSurfelSlots]
    SCONCE_ADDRESS(Lists) from;
    SCONCE_ADDRESS(Lists) to;
    SCONCE_ADDRESS(Blocks) blocks; // [block] 1 where it holds a surface sample; for the ranking the numbers of blocks
    SCONCE_ADDRESS(Sights) sights; // [block of this dispatch][1 + build.candidates]: how many follow, and places in its region's list, with kSeesAll
    uint first;  // of the samples, or of `blocks`, of this dispatch
    uint count;  // samples, or blocks
    ivec3 size;  // nodes of the level written
    uint unused; // to a multiple of 8
};
SCONCE_CHECK_SIZE(OctreePush, 72);

SCONCE_STRUCTS_END
#endif
