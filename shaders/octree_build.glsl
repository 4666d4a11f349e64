// What the passes that build the octree's lists share.
#include "shared/octree_build.h"
#include "shared/texel.h"
#include "shared/chart.h"
#include "shared/face_chain.h"

layout(scalar, push_constant) uniform Push { OctreePush push; };

OctreeBuild build; // a copy, read once: the passes that use it begin with readSettings()
void readSettings() { build = push.settings.inputs.build; }
uint distanceWord(uint index) { return push.settings.inputs.distance.word[index]; }
vec3 probeCentre(uint probe) { return push.settings.inputs.probes.probe[probe].centre; }
uint surfelKey(uint slot) { return push.surfels.key[slot]; }
uint indexIn(ivec3 at, ivec3 extent) { return uint(at.x) + uint(extent.x) * (uint(at.y) + uint(extent.y) * uint(at.z)); }
uvec2 listOf(ivec3 node, ivec3 extent) { return push.from.list[indexIn(node, extent)]; }
shared uvec2 kept[kMostCandidates]; // candidates of the workgroup's block
shared uint keptCount;
uint candidateCount() { return keptCount; }
uvec2 candidateOf(uint i) { return kept[i]; }
#include "shared/octree_rank.h"
