// What the passes that build the octree's lists share.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shared/gpu_types.h"
#include "shared/light_field.h"
#include "shared/octree_build.h"
#include "shared/texel.h"
#include "shared/chart.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MapWords { uint word[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Probes { ProbeHeader probe[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Candidates { uvec2 candidate[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SurfelKeys { uint key[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Lists { uvec2 list[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Inputs
{
    OctreeBuild settings;
    MapWords distance;
    Probes probes;
    Candidates candidates; // [region][build.candidates] probe, weight
};

layout(scalar, push_constant) uniform Push
{
    Inputs inputs;
    SurfelKeys surfels; // [voxel][kSurfelSlots]
    Lists from;
    Lists to;
    uint first; // of the samples, or blocks of voxels, of this dispatch
    uint count; // samples
    ivec3 size; // nodes of the level written
};

OctreeBuild build; // a copy, read once: the passes that use it begin with readSettings()
void readSettings() { build = inputs.settings; }
uint distanceWord(uint index) { return inputs.distance.word[index]; }
vec3 probeCentre(uint probe) { return inputs.probes.probe[probe].centre; }
uint surfelKey(uint slot) { return surfels.key[slot]; }
uint indexIn(ivec3 at, ivec3 extent) { return uint(at.x) + uint(extent.x) * (uint(at.y) + uint(extent.y) * uint(at.z)); }
uvec2 listOf(ivec3 node, ivec3 extent) { return from.list[indexIn(node, extent)]; }
shared uvec2 kept[kMostCandidates]; // candidates of the workgroup's block
shared uint keptCount;
uint candidateCount() { return keptCount; }
uvec2 candidateOf(uint i) { return kept[i]; }
#include "shared/octree_rank.h"
