// The structs a light field consists of, as they lie in device memory and in the .sconce file.
//
// Field space: field = (world - origin) / scale, scale a power of two near the scene's diagonal, so that distances are about 1 whatever
// the unit of the scene, and scaling a scene by a power of two changes no bit of a trace.
//
// Chart "cube": probe map of 6 faces, face f looks along axis f>>1, negative when f&1. With p relative to the probe and a the axis,
//   W = +-p[a], U = p[(a+1)%3], V = p[(a+2)%3], pixel = N/2 * (U/W + 1, V/W + 1), q = 1/W. Straight lines stay straight and q is
//   linear along them and over planes.
// Words of a face: levels 0, 2, 4, ... topLevel one after another, then far bounds; see face_chain.h and texel.h.
// Chart "octahedral": one map of N x N words (level 0: radial distance r and normal), then (N/lowFactor)^2 words of (min r, max r).
#include "shared/gpu_types.h"
#ifndef SCONCE_LIGHT_FIELD_H
#define SCONCE_LIGHT_FIELD_H
SCONCE_STRUCTS_BEGIN

const uint kChartCube = 0u;
const uint kChartOctahedral = 1u;
const uint kNoProbe = 0xffffffffu;
const int kRanked = 4;             // ranked probes a voxel holds
const uint kIrradianceSize = 32u;  // texels a side of the octahedral irradiance and moments map
const uint kPrefilteredSize = 64u; // texels a side of the finest prefiltered radiance map, octahedral; each level has half of it
const int kPrefilteredLevels = 4;
const uint kPrefilteredWords = 5440u; // of a probe, all levels
const int kPatchSide = 6;          // patches a side of a cube face: what a probe sees, coarsely, for diffuse light
const uint kPatches = 216u;        // of a probe
const uint kCellWords = 7u;        // of a cell of light in the open: light_cells.h
const int kFineLog = 2;             // log2 of the finer texels a side of a surface texel that is refined: surface_light.h
const uint kHiddenShiftBits = 4u;
const int kHiddenTries = 16;          // slots of hidden_light.h that a key may be in
const uint kRefinedWord = 0xf8000000u; // its word, plus the number of its finer ones
const uint kFineWords = 17u;       // of a refined one: its mean, then the finer ones
const uint kCellKnown = 0x40000000u; // of a cell's place: there is one
const uint kLowFactor = 16u;       // texels of the octahedral map a texel of its low-resolution map covers, per axis

struct ProbeHeader
{
    vec3 centre;        // field space
    float freeRadius;   // field units; nothing is nearer to the centre than this
    vec3 influenceLow;  // half extents of the influence box toward -xyz, field units: median distance per cube face
    float farthest;     // field units; the largest finite distance in the map
    vec3 influenceHigh; // the same toward +xyz
    float harmonic;     // field units; harmonic mean of the distances over all directions, without sky; 0: not known (older files)
};
SCONCE_CHECK_SIZE(ProbeHeader, 48);

struct LightFieldInfo
{
    vec3 origin;  // world, metres
    float scale;  // metres per field unit, a power of two
    vec3 boundsLow; // field space: the box the octree covers
    float voxel;    // field units per finest octree voxel
    vec3 boundsHigh;
    float diagonal; // field units, of the scene's bounds
    ivec3 topCells; // cells of the top grid; each covers 2^topShift finest voxels a side
    int topShift;
    uvec3 bricks;   // 2x2x2-texel bricks along each axis of the octree's 3D texture
    uint marker;    // w of an interior texel: 255 for 8-bit indices, 65535 for 16-bit ones
    uint probeCount;
    uint chart;        // kChartCube or kChartOctahedral
    uint faceSize;     // texels a side of a cube face, or of the octahedral map
    uint topLevel;     // coarsest level of a face's chain; even
    uint wordsPerProbe; // distance words, all faces and levels
    uint gridX;         // uniform grid of probes, 0 when they are not one
    uint gridY;
    uint gridZ;
    vec3 gridOrigin; // field space, probe (0,0,0)
    uint surfaceSize; // texels a side of a face of the surface light; 0: there is none
    vec3 gridStep;   // field units
    int cellShift;   // a cell of light in the open is 2^cellShift finest voxels wide: light_cells.h
    vec3 sky;        // radiance where nothing is hit, W/(m^2 sr)
    uint surfaceDirections; // 1: surface light knows how it changes with the normal; 0: it doesn't
    vec3 sceneLow;   // field space: the scene's bounds
    uint refinedTexels; // of the surface light, of all probes
    vec3 sceneHigh;
    uint hidden; // light of hidden surfaces, hidden_light.h; 0: there is none
};
SCONCE_CHECK_SIZE(LightFieldInfo, 192);

/// The knobs of a trace. Defaults and prices: runtime/field/quality.h.
struct TraceQuality
{
    int ranked;        // probes of a leaf that are asked, 1..kRanked
    int maxHandoffs;   // probes a ray may change to, 0..64
    int startLevel;    // level of the chain a ray starts at in a probe; even, 0..topLevel
    int coarsestLevel; // coarsest level climbed to; even
    float tolerance;   // scale of the hit rule's thickness, 1: derived from the texel's footprint
    float epsilon;     // absolute slack, share of the scene's diagonal
    float opinion;     // a hit in a texel larger than this share of the diagonal is asked of a nearer probe; 0: never
    int farBounds;     // 1: read the far bounds, and end early where a ray is behind all of a cell; 0: leave them alone
    int order;         // kOrder...: which of a leaf's probes is asked first
    int unused;        // addresses that follow are at multiples of 8 bytes
};
SCONCE_CHECK_SIZE(TraceQuality, 40);

// Orders in which a leaf's probes are asked: as they are ranked; by how parallel the ray is to the way from the probe to the point it has come to, either
// sign or only away from the probe (Donow 2016, "Light Probe Selection Algorithms for Real-Time Rendering of Light Fields", sections 5.5 and 5.7); by
// how near a probe stands to the ray's line.
const int kOrderRanked = 0;
const int kOrderParallel = 1;
const int kOrderBehind = 2;
const int kOrderNearestLine = 3;

/// A ray and its answer, as `trace_rays.comp` reads and writes them; world space, metres.
struct Ray
{
    vec3 origin;
    vec3 direction; // unit
    vec3 normal;    // unit, of the surface that the ray starts on, on the side where it starts; 0: none known. It chooses the first probe
};
SCONCE_CHECK_SIZE(Ray, 36);

struct RayHit
{
    uint status;  // kMiss 0, kHit 1, kUnknown 2
    float t;      // metres; on miss and unknown the last point reached
    vec3 position;
    vec3 normal;  // of the surfel, unit, facing its probe; 0 where none
    vec3 radiance; // what shading uses: the hit's, the sky's, or on unknown that of the last surfel met (a counted fallback)
    uint probe;    // that answered, kNoProbe: none
    int handoffs;
    int distanceReads;
    int indexReads;
    float confidence; // [0,1]: about the chance that a hit is within 0.2 % of the diagonal of the truth, or that a miss is one; 0: unknown
};
SCONCE_CHECK_SIZE(RayHit, 64);

/// Push constants of trace_rays.comp.
struct TraceRaysPush
{
    DeviceAddress rays; // of Ray[count]
    DeviceAddress hits; // of RayHit[count]
    uint count;
    uint raysALane; // of a pass that refills its lanes: rays of a workgroup, over its size
};
SCONCE_CHECK_SIZE(TraceRaysPush, 24);

const uint kTraceRaysGroup = 64u; // rays a workgroup

SCONCE_STRUCTS_END
#endif
