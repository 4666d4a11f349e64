#include "placement/visibility.h"

#include <algorithm>

#include <fmt/format.h>

namespace sconce
{

Result<Visibility> Visibility::build(const Scene& scene)
{
    Result<TriangleRays> rays = TriangleRays::build(scene);
    if (!rays) return rays.error();
    Bounds bounds;
    for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle)
        if (rays->presence()[triangle] != Presence::absent)
            for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[scene.triangles[triangle][corner]]);
    if (bounds.empty() || !(bounds.diagonal() > 0.0f))
        return Error{ErrorCode::badInput,
                     fmt::format("Scene '{}' has {} triangles and none with a visible surface; probes need something to see.", scene.name,
                                 scene.triangles.size())};
    const vec3 farthest = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    // The rounding of positions grows with their distance from the origin, not with the scene's size alone.
    const float epsilon = 1e-5f * (bounds.diagonal() + 0.1f * std::max({farthest.x, farthest.y, farthest.z}));
    return Visibility(std::move(*rays), bounds, epsilon);
}

bool Visibility::cast(vec3 origin, vec3 direction, RayHit& hit) const
{
    const auto met = rays.closest(origin, direction);
    if (!met) return false;
    const Scene& scene = rays.scene();
    hit.t = met->t;
    hit.triangle = met->triangle;
    hit.normal = geometricNormal(scene, hit.triangle);
    const bool fromBack = glm::dot(hit.normal, direction) > 0.0f;
    if (fromBack) hit.normal = -hit.normal;
    hit.back = fromBack && !scene.materials[scene.triangleMaterial[hit.triangle]].doubleSided;
    return true;
}

bool Visibility::unoccluded(vec3 from, vec3 to) const
{
    return !rays.occluded(from, to - from, 1.0f);
}

bool Visibility::sees(vec3 probe, vec3 surface, vec3 normal) const
{
    return unoccluded(probe, surface + gap * normal);
}

} // namespace sconce
