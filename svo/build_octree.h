#pragma once

#include <cstdint>
#include <span>

#include "scene/progress.h"
#include "scene/result.h"
#include "shaders/shared/light_field.h"
#include "svo/octree.h"

namespace sconce
{

struct OctreeSettings
{
    int voxels = 128; // finest voxels along the longest side of the bounds, 8..1024; time and memory grow with the square of it
    int topShift = 3; // levels below the top grid, 1..6
};

/// The probes' cube-face distance maps, as the octree needs them. Word layout: shaders/shared/light_field.h.
struct ProbeMaps
{
    const gpu::LightFieldInfo& info;
    std::span<const gpu::ProbeHeader> probes;
    std::span<const uint32_t> distance;
};

/// Which probes see each voxel, ranked, collapsed and packed. A voxel's candidates are judged by the share of sample points in it that
/// the probe sees (by its own maps) and its distance; each next rank prefers what the earlier ones do not see. Voxels that no probe sees
/// take the lists of their nearest seen neighbours.
/// Bounds: the box of what the probes see, without its outermost 1 % a side, so that a ground plane far larger than the place that
/// matters costs no voxels; a point outside asks the nearest voxel.
/// Errors: badArgument (no probes, more than 65,535, settings out of range), cancelled. Cost: voxels x probes x 9 map reads.
/// Source: Wang et al. 2019, section 4.1 (influence by visibility, up to four probes a voxel).
Result<Octree> buildOctree(const ProbeMaps& maps, const OctreeSettings& settings, const Progress& progress = {});

} // namespace sconce
