#pragma once

#include <array>
#include <vector>

#include "scene/scene.h"

namespace sconce
{

/// Where a plane cuts a scene's triangles: the ends of a piece each, world, metres, in the order of the triangles. One that only touches
/// the plane from its normal's side is not cut.
/// @param point   of the plane
/// @param normal  its normal, of any length
std::vector<std::array<vec3, 2>> sectionOf(const Scene& scene, vec3 point, vec3 normal);

} // namespace sconce
