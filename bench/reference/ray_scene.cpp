#include "bench/reference/ray_scene.h"

#include <algorithm>

namespace sconce
{
namespace
{

struct Barycentric
{
    uvec3 corners;
    vec3 weights;

    Barycentric(const Scene& scene, const TriangleRays::Hit& hit)
        : corners(scene.triangles[hit.triangle]), weights(1.0f - hit.barycentrics.x - hit.barycentrics.y, hit.barycentrics)
    {
    }
    template <class T> T of(const std::vector<T>& values) const
    {
        return values[corners.x] * weights.x + values[corners.y] * weights.y + values[corners.z] * weights.z;
    }
};

} // namespace

Result<RayScene> RayScene::create(const Scene& scene)
{
    Result<TriangleRays> rays = TriangleRays::build(scene);
    if (!rays) return rays.error();
    Bounds bounds;
    for (const uvec3& triangle : scene.triangles)
        for (int corner = 0; corner < 3; ++corner) bounds.add(scene.positions[triangle[corner]]);
    float offset = 0.0f;
    if (!bounds.empty())
    {
        const vec3 reach = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
        offset = 4e-6f * bounds.diagonal() + 1e-6f * std::max({reach.x, reach.y, reach.z});
    }
    return RayScene(std::move(*rays), offset);
}

std::optional<SurfaceHit> RayScene::closest(vec3 origin, vec3 direction, float tFar) const
{
    const auto met = rays.closest(origin, direction, tFar);
    if (!met) return std::nullopt;
    const Scene& scene = rays.scene();
    const Barycentric point(scene, *met);
    SurfaceHit hit;
    hit.t = met->t;
    hit.triangle = met->triangle;
    hit.barycentrics = met->barycentrics;
    hit.position = point.of(scene.positions); // nearer to the surface than origin + t * direction
    hit.uv = point.of(scene.uvs);
    hit.material = scene.triangleMaterial[hit.triangle];
    hit.geometricNormal = geometricNormal(scene, hit.triangle);
    const vec3 normal = point.of(scene.normals);
    const float length = glm::length(normal);
    hit.shadingNormal = length > 1e-6f ? normal / length : hit.geometricNormal;
    if (glm::dot(hit.shadingNormal, hit.geometricNormal) < 0.0f) hit.shadingNormal = -hit.shadingNormal;
    return hit;
}

} // namespace sconce
