#pragma once

#include <vector>

#include "shaders/shared/octree_build.h"
#include "svo/build_octree.h"

namespace sconce
{

/// What is settled before the voxels are ranked, and the same for the device and the host: where the voxels lie, and which probes each
/// region of them may list, heaviest first. A candidate's weight falls with the root of its distance and is lower where the region lies
/// outside its influence box (median distance per cube face; Wang et al. 2019, section 4.1). Of probes in one spot only the first is a
/// candidate.
struct OctreePlan
{
    Octree tree; // its bounds and grid; no texels yet
    gpu::OctreeBuild build{};
    std::vector<glm::uvec2> candidates; // [region][build.candidates] probe, weight
    uint32_t samples = 0;               // surface samples of all maps

    size_t voxels() const { return size_t(build.count.x) * size_t(build.count.y) * size_t(build.count.z); }
};

/// Errors: as buildOctree.
Result<OctreePlan> planOctree(const ProbeMaps& maps, const OctreeSettings& settings);

constexpr int kFillSteps = 2; // voxels that lists spread into what no probe sees; beyond that, nodes take what makes them uniform. Even

} // namespace sconce
