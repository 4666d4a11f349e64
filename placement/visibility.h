#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/result.h"
#include "scene/triangle_rays.h"

namespace sconce
{

/// What a ray meets first.
struct RayHit
{
    float t = 0.0f;
    uint32_t triangle = 0; // index into Scene::triangles
    vec3 normal{0.0f};     // geometric, unit, on the side the ray came from
    bool back = false;     // the ray met the back of a single-sided triangle
};

/// What placement asks of the triangles of a scene: what a ray hits, whether two points see each other, how near the surface is. Surfaces
/// are opaque from both sides; alpha-tested texels are looked through. Safe from many threads. The scene must outlive it.
class Visibility
{
public:
    /// Errors: badInput when the scene has no triangle that is there; those of TriangleRays::build.
    static Result<Visibility> build(const Scene& scene);

    bool cast(vec3 origin, vec3 direction, RayHit& hit) const; // direction unit; false on a miss
    /// Whether nothing lies between a probe and a surface point, which is lifted off its surface by epsilon() along its normal.
    bool sees(vec3 probe, vec3 surface, vec3 normal) const;
    bool unoccluded(vec3 from, vec3 to) const;
    /// As TriangleRays::unoccluded.
    void unoccluded(vec3 from, std::span<const vec3> to, std::span<uint8_t> seen) const { rays.unoccluded(from, to, seen); }
    /// As TriangleRays::nearest.
    float distance(vec3 point, float farthest) const { return rays.nearest(point, farthest); }

    const Bounds& bounds() const { return box; }                              // of the triangles that are there
    const std::vector<Presence>& presence() const { return rays.presence(); } // [triangles]
    float epsilon() const { return gap; } // metres, the resolution of the scene's coordinates with some to spare

private:
    Visibility(TriangleRays traced, const Bounds& ofTriangles, float epsilon) : rays(std::move(traced)), box(ofTriangles), gap(epsilon) {}

    TriangleRays rays;
    Bounds box;
    float gap;
};

} // namespace sconce
