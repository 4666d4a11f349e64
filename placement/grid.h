#pragma once

#include <cstdint>

#include "scene/probe_grid.h"
#include "scene/scene.h"

namespace sconce
{

/// The grid of about `count` points (within 15 %) whose cells in the bounds are most nearly cubes.
glm::ivec3 gridShape(const Bounds& bounds, uint32_t count);

/// A grid at the centres of equal cells of the bounds.
ProbeGrid gridIn(const Bounds& bounds, glm::ivec3 count);

} // namespace sconce
