#include "bench/reference/ray_scene.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

struct Barycentric
{
    uvec3 corners;
    vec3 weights;

    Barycentric(const Scene& scene, uint32_t triangle, vec2 barycentrics)
        : corners(scene.triangles[triangle]), weights(1.0f - barycentrics.x - barycentrics.y, barycentrics)
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

/// By its triangle, place in it and `uv`.
vec3 shadingNormalOf(const Scene& scene, const SurfaceHit& hit)
{
    const vec3 normal = Barycentric(scene, hit.triangle, hit.barycentrics).of(scene.normals);
    const float length = glm::length(normal);
    const vec3 smooth = length > 1e-6f ? normal / length : hit.geometricNormal;
    const vec3 mapped = mappedNormal(scene, hit, smooth);
    return glm::dot(smooth, hit.geometricNormal) < 0.0f ? -mapped : mapped;
}

/// Where a ray meets a triangle's plane, as weights of its second and third vertex.
std::optional<vec2> onPlane(const Scene& scene, uint32_t triangle, vec3 origin, vec3 direction)
{
    const uvec3 t = scene.triangles[triangle];
    const glm::dvec3 a = scene.positions[t.x], ab = glm::dvec3(scene.positions[t.y]) - a, ac = glm::dvec3(scene.positions[t.z]) - a;
    const glm::dvec3 along = direction, from = glm::dvec3(origin) - a, across = glm::cross(along, ac);
    const double volume = glm::dot(ab, across);
    if (!(std::abs(volume) > 0.0)) return std::nullopt;
    const glm::dvec3 turned = glm::cross(from, ab);
    if (!(glm::dot(ac, turned) / volume > 0.0)) return std::nullopt; // behind the origin
    return vec2(glm::dot(from, across) / volume, glm::dot(along, turned) / volume);
}

} // namespace

Result<RayScene> RayScene::create(const Scene& scene)
{
    Result<TriangleRays> rays = TriangleRays::build(scene);
    if (!rays) return rays.error();
    return RayScene(std::move(*rays), rayOffset(scene));
}

std::optional<SurfaceHit> RayScene::closest(vec3 origin, vec3 direction, float tFar) const
{
    const auto met = rays.closest(origin, direction, tFar);
    if (!met) return std::nullopt;
    const Scene& scene = rays.scene();
    const Barycentric point(scene, met->triangle, met->barycentrics);
    SurfaceHit hit;
    hit.t = met->t;
    hit.triangle = met->triangle;
    hit.barycentrics = met->barycentrics;
    hit.position = point.of(scene.positions); // nearer to the surface than origin + t * direction
    hit.uv = point.of(scene.uvs);
    hit.material = scene.triangleMaterial[hit.triangle];
    hit.geometricNormal = geometricNormal(scene, hit.triangle);
    hit.shadingNormal = shadingNormalOf(scene, hit);
    return hit;
}

SurfaceHit RayScene::texturedBy(SurfaceHit hit, vec3 origin, vec3 direction) const
{
    const Scene& scene = rays.scene();
    const auto there = onPlane(scene, hit.triangle, origin, direction);
    if (!there) return hit;
    const vec3 place = Barycentric(scene, hit.triangle, *there).of(scene.positions);
    if (glm::distance(place, hit.position) > hit.t) return hit;
    const vec2 uv = Barycentric(scene, hit.triangle, *there).of(scene.uvs);
    if (!(coverage(scene, hit.material, uv) > 0.0f)) return hit; // a hole
    hit.uv = uv;
    hit.shadingNormal = shadingNormalOf(scene, hit);
    return hit;
}

} // namespace sconce
