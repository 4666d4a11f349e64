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
    maps = push.settings.inputs.distance;
    probes = push.settings.inputs.probes;
    candidates = push.settings.inputs.candidates;
}
uint distanceWord(uint index) { return maps.word[index]; }
vec3 probeCentre(uint probe) { return probes.probe[probe].centre; }
uint surfelKey(uint slot) { return push.surfels.key[slot]; }
uint indexIn(ivec3 at, ivec3 extent) { return uint(at.x) + uint(extent.x) * (uint(at.y) + uint(extent.y) * uint(at.z)); }
uvec2 listOf(ivec3 node, ivec3 extent) { return push.from.list[indexIn(node, extent)]; }
shared uvec2 kept[kMostCandidates]; // candidates of the workgroup's block
shared uint keptCount;
uint candidateCount() { return keptCount; }
uvec2 candidateOf(uint i) { return kept[i]; }
#include "shared/octree_rank.h"
