#pragma once

#include <span>

#include "runtime/sconce.h"
#include "scene/scene.h"

namespace sconce
{

/// Adds shapes that move to a scene, as matt surfaces: what a host would draw of them, and what the truth is traced in. Round ones are
/// within 0.4 % of their radius.
void addShapes(Scene& scene, std::span<const MovingShape> shapes);

} // namespace sconce
