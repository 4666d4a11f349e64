#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// Whether a triangle is there at all, by its material's alpha.
enum class Presence : uint8_t
{
    absent, // clear glass and the like: alpha is below the cutoff everywhere
    solid,
    masked, // the base colour texture decides point by point
};
std::vector<Presence> trianglePresence(const Scene& scene);

/// Exact questions to the triangles of a scene, answered by Embree: nothing else in the project includes it. Surfaces are met from both
/// sides; points whose alpha is below their material's cutoff are not there. Safe from many threads. The scene must outlive it.
class TriangleRays
{
public:
    struct Hit
    {
        float t = 0.0f;          // in lengths of the direction
        uint32_t triangle = 0;   // index into Scene::triangles
        vec2 barycentrics{0.0f}; // weights of the second and third vertex
    };

    /// A scene without triangles is allowed: every ray misses. Errors: deviceFailure when Embree can't be started, outOfMemory.
    static Result<TriangleRays> build(const Scene& scene);
    TriangleRays(TriangleRays&&) noexcept;
    TriangleRays& operator=(TriangleRays&&) noexcept;
    ~TriangleRays();

    std::optional<Hit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const;
    bool occluded(vec3 origin, vec3 direction, float tFar) const;
    /// seen[i] becomes whether nothing lies between `from` and to[i], for the i whose seen[i] is not 0 yet; the rest stays 0. Eight rays at
    /// a time: fastest when neighbours in `to` are neighbours in space.
    void unoccluded(vec3 from, std::span<const vec3> to, std::span<uint8_t> seen) const;
    /// Distances of many rays on all cores, as fast as Embree answers them: what tracers' rays a second are compared with. Infinity where
    /// nothing is hit. Misuse: spans of different length, a width that is neither 1 nor 8, assert.
    /// @param width  rays a call of Embree, 1 or 8
    void distances(std::span<const vec3> origins, std::span<const vec3> directions, int width, std::span<float> t) const;
    /// Metres to the nearest triangle, or `farthest` when none is nearer. Masked triangles count whole.
    float nearest(vec3 point, float farthest) const;

    const Scene& scene() const;
    const std::vector<Presence>& presence() const; // [triangles]

private:
    struct State;
    explicit TriangleRays(std::unique_ptr<State> owned);
    std::unique_ptr<State> state;
};

/// Half the gap by which rays must start off a surface, metres: beyond the rounding of any position in the scene.
float rayOffset(const Scene& scene);

} // namespace sconce
