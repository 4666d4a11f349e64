#pragma once

#include "scene/scene.h"

namespace sconce
{

/// Point of triangle abc nearest to p; exact in every Voronoi region and for degenerate triangles.
/// Source: Ericson 2004, "Real-Time Collision Detection", section 5.1.5.
vec3 closestPointOnTriangle(vec3 p, vec3 a, vec3 b, vec3 c);

} // namespace sconce
