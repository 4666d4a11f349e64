#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "scene/result.h"
#include "scene/scene.h"

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
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;
    ~RayScene();

    std::optional<SurfaceHit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const;
    bool occluded(vec3 origin, vec3 direction, float tFar) const;
    /// Distances of many rays on all cores, as fast as Embree answers them: what tracers' rays a second are compared with. Infinity where
    /// nothing is hit. Misuse: spans of different length, a width that is neither 1 nor 8, assert.
    /// @param width  rays a call of Embree, 1 or 8
    void distances(std::span<const vec3> origins, std::span<const vec3> directions, int width, std::span<float> t) const;

    const Scene& scene() const;
    /// Half the gap by which rays start off a surface, metres: beyond the rounding of any position in the scene.
    float offset() const;

private:
    struct Impl;
    explicit RayScene(std::unique_ptr<Impl> state);
    std::unique_ptr<Impl> impl;
};

} // namespace sconce
