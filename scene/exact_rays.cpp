#include "scene/exact_rays.h"

#include <algorithm>

namespace sconce
{

ExactRays::~ExactRays() = default;

float rayOffset(const Scene& scene)
{
    const Bounds bounds = scene.bounds();
    if (bounds.empty()) return 0.0f;
    const vec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return 4e-6f * bounds.diagonal() + 1e-6f * std::max({reach.x, reach.y, reach.z});
}

} // namespace sconce
