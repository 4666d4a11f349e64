#pragma once

#include <cstdint>
#include <vector>

#include "scene/probe_grid.h"
#include "scene/scene.h"

namespace sconce
{

inline constexpr size_t kGridShapes = 4;                     // that a fitted grid is chosen among, in each of these poses:
inline constexpr float kGridMargins[] = {0.5f, 0.25f, 0.0f}; // of a step, from the bounds

/// The grids of about `count` points (within 15 %), those first whose cells in the bounds are most nearly cubes; at most `most` of them.
std::vector<glm::ivec3> gridShapes(const Bounds& bounds, uint32_t count, size_t most);

/// The same of powers of two along each axis, up to 64: all of the product that is nearest to the count in ratio.
std::vector<glm::ivec3> powerOfTwoShapes(const Bounds& bounds, uint32_t count, size_t most);

/// A grid in the bounds, whose outermost points are `margin` of a step from them: 0.5, the centres of equal cells; 0, points on the bounds
/// themselves. A single point along an axis is in its middle.
ProbeGrid gridIn(const Bounds& bounds, glm::ivec3 count, float margin = 0.5f);

} // namespace sconce
