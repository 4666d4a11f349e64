#include "scene/exact_rays.h"

#include <algorithm>

namespace sconce
{

ExactRays::~ExactRays() = default;

float rayOffset(const Scene& scene)
{
    Bounds bounds;
    for (const uvec3& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[triangle[corner]]);
    if (bounds.empty()) return 0.0f;
    const vec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    return 4e-6f * bounds.diagonal() + 1e-6f * std::max({reach.x, reach.y, reach.z});
}

} // namespace sconce
