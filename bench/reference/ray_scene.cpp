#include "bench/reference/ray_scene.h"

#include <algorithm>

#include "shaders/shared/pure.h"

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

/// The shading normal that the material's normal texture makes of the interpolated one.
vec3 mappedNormal(const Scene& scene, const SurfaceHit& hit, vec3 smooth)
{
    using Text = Pure<float>;
    const Material& material = scene.materials[hit.material];
    if (material.normalTexture.image < 0) return smooth;
    const uvec3 t = scene.triangles[hit.triangle];
    const glm::mat2& turned = material.normalTexture.uvScaleRotate;
    const auto along = Text::uvTangents(scene.positions[t.y] - scene.positions[t.x], scene.positions[t.z] - scene.positions[t.x],
                                        turned * (scene.uvs[t.y] - scene.uvs[t.x]), turned * (scene.uvs[t.z] - scene.uvs[t.x]));
    return Text::bentNormal(smooth, along, readNormalTexture(scene, hit.material, hit.uv), material.normalStrength);
}

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
    const vec3 smooth = length > 1e-6f ? normal / length : hit.geometricNormal;
    hit.shadingNormal = mappedNormal(scene, hit, smooth);
    if (glm::dot(smooth, hit.geometricNormal) < 0.0f) hit.shadingNormal = -hit.shadingNormal;
    return hit;
}

} // namespace sconce
