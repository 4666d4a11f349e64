#pragma once

#include <cstdint>
#include <span>

#include "base/knobs.h"
#include "base/progress.h"
#include "base/result.h"
#include "shaders/shared/light_field.h"
#include "svo/octree.h"

namespace sconce
{

struct OctreeSettings
{
    // Finest voxels along the longest side of the bounds; time and memory grow with the square of it. 0: 128 up to 54 probes, then
    // growing with the root of their number to 256, so that the bytes a probe stay what they are.
    int voxels = knobs::octreeVoxels.value;
    int topShift = knobs::topShift.value; // levels below the top grid: a descent reads at most one texel more
};

/// The probes' cube-face distance maps, as the octree needs them. Word layout: shaders/shared/light_field.h.
struct ProbeMaps
{
    const gpu::LightFieldInfo& info;
    std::span<const gpu::ProbeHeader> probes;
    std::span<const uint32_t> distance;
};

/// Which probes see each voxel, ranked, collapsed and packed. A voxel's candidates are judged by what they see of it, by their own maps: 9
/// points of its free space and up to 16 of the surfaces in it, each from its own side. Each next rank prefers what the earlier ones
/// don't see; weights fall with distance and outside a probe's influence box. A voxel that no probe sees takes what makes it uniform with
/// its neighbours. This is the CPU twin of the passes that runtime/field/octree_builder.h runs, one text (shaders/shared/octree_rank.h):
/// the same bytes on every device and for any number of threads. Bounds: the box of what the probes see, without its outermost 1 % a side,
/// so that a ground plane far larger than the place that matters costs no voxels; a point outside asks the nearest voxel. Errors:
/// badArgument (no probes, more than 65,535, settings out of range), cancelled. Cost: voxels x min(probes, 256) x 9 to 25 map reads at
/// most, and 80 bytes of host memory a voxel; a search ends with the fourth probe that sees all of a voxel. Source: Wang et al. 2019,
/// section 4.1 (influence by visibility, up to four probes a voxel).
Result<Octree> buildOctree(const ProbeMaps& maps, const OctreeSettings& settings, const Progress& progress = {});

} // namespace sconce
