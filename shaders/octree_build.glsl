// What the passes that build the octree's lists share.
#include "shared/octree_build.h"
#include "shared/texel.h"
#include "shared/chart.h"
#include "shared/face_chain.h"

layout(scalar, push_constant) uniform Push { OctreePush push; };

OctreeBuild build; // copies, read once: the passes that use them begin with readSettings()
MapWords maps;
Probes probes;
Candidates candidates;
void readSettings()
{
    build = push.settings.inputs.build;
    maps = MapWords(push.settings.inputs.distance);
    probes = Probes(push.settings.inputs.probes);
    candidates = Candidates(push.settings.inputs.candidates);
}
uint distanceWord(uint index) { return maps.word[index]; }
vec3 probeCentre(uint probe) { return probes.probe[probe].centre; }
uint surfelKey(uint slot) { return push.surfels.key[slot]; }
uint indexIn(ivec3 at, ivec3 extent) { return uint(at.x) + uint(extent.x) * (uint(at.y) + uint(extent.y) * uint(at.z)); }
uvec2 listOf(ivec3 node, ivec3 extent) { return push.from.list[indexIn(node, extent)]; }
layout(constant_id = kWithSurfelsId) const bool kWithSurfels = true;
bool holdsSurfels() { return kWithSurfels; }
uint candidateList, sightRow; // of the workgroup's block: where its region's candidates begin, and its row of `sights`
uint candidateCount() { return push.sights.word[sightRow]; }
uvec2 candidateOf(uint i)
{
    uint word = push.sights.word[sightRow + 1u + i];
    return candidates.candidate[candidateList + (word & ~kSeesAll)] | uvec2(word & kSeesAll, 0u);
}
#include "shared/octree_rank.h"

ivec3 blockOf(uint place)
{
    uint number = push.blocks.block[place];
    uvec3 blocks = uvec3((build.count + kBlock - 1) / kBlock);
    return ivec3(number % blocks.x, number / blocks.x % blocks.y, number / blocks.x / blocks.y);
}
