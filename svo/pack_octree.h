#pragma once

#include <vector>

#include "svo/octree_plan.h"

namespace sconce
{

/// Lists of the nodes of all levels, the finest (the voxels) first, x fastest.
using LevelLists = std::vector<std::vector<glm::uvec2>>;

/// The tree in its texture. Equal bricks are stored once; a node without a list takes that of a sibling, a top cell that of a nearest one.
Octree packOctree(const OctreePlan& plan, const LevelLists& levels);

} // namespace sconce
