#pragma once

#include "runtime/vulkan/paced_work.h"
#include "svo/build_octree.h"

namespace sconce
{

/// buildOctree by compute passes: surface samples, one thread each; lists, one thread a voxel; collapse, one thread a node of each level.
/// The bounds, the regions' candidates and the packing are the host's. Gives the bytes of its CPU twin, svo/build_octree.h.
/// @param work  that its passes are done by, with progress between submissions while voxels are ranked
/// Needs the maps, 80 bytes a voxel and the candidates on the device. Errors: as buildOctree; outOfMemory with the numbers, deviceFailure.
Result<Octree> buildOctreeOnDevice(Gpu& gpu, PacedWork& work, const ProbeMaps& maps, const OctreeSettings& settings,
                                   const Progress& progress = {});

} // namespace sconce
