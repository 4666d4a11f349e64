#pragma once

#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/result.h"
#include "scene/triangle_rays.h"

namespace sconce
{

struct SurfaceHit
{
    float t = 0.0f; // metres when the direction is unit
    uint32_t triangle = 0;
    vec2 barycentrics{0.0f}; // weights of the second and third vertex
    vec3 position{0.0f};
    vec3 geometricNormal{0.0f}; // by winding, unit
    vec3 shadingNormal{0.0f};   // interpolated, unit, on the geometric normal's side
    vec2 uv{0.0f};
    uint32_t material = 0;
};

/// A Scene that answers rays on the CPU: the truth that tracers and pictures are measured against. Points whose alpha is below their
/// material's cutoff are not there. Safe from many threads. The scene must outlive it.
class RayScene
{
public:
    static Result<RayScene> create(const Scene& scene);

    std::optional<SurfaceHit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const;
    /// A hit whose textures are read where another ray from the same origin meets its plane: many such rays, spread over a pixel, filter
    /// the textures of the surface that the pixel's centre sees (Pharr, Wronski, Salvi, Fajardo 2024, "Filtering After Shading with
    /// Stochastic Texture Filtering"). As it was where that is far from it, as at a horizon, or in a hole of the material.
    SurfaceHit texturedBy(SurfaceHit hit, vec3 origin, vec3 direction) const;
    bool occluded(vec3 origin, vec3 direction, float tFar) const { return rays.occluded(origin, direction, tFar); }
    /// As TriangleRays::distances.
    void distances(std::span<const vec3> origins, std::span<const vec3> directions, int width, std::span<float> t) const
    {
        rays.distances(origins, directions, width, t);
    }

    const Scene& scene() const { return rays.scene(); }
    /// Half the gap by which rays start off a surface, metres: beyond the rounding of any position in the scene.
    float offset() const { return gap; }

private:
    RayScene(TriangleRays traced, float offset) : rays(std::move(traced)), gap(offset) {}

    TriangleRays rays;
    float gap;
};

} // namespace sconce
