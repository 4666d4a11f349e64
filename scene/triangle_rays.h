#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "scene/exact_rays.h"

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

/// ExactRays answered by Embree: nothing else in the project includes it. The scene must outlive it.
class TriangleRays final : public ExactRays
{
public:
    /// A scene without triangles is allowed: every ray misses. Errors: deviceFailure when Embree can't be started, outOfMemory.
    static Result<TriangleRays> build(const Scene& scene);
    TriangleRays(TriangleRays&&) noexcept;
    TriangleRays& operator=(TriangleRays&&) noexcept;
    ~TriangleRays() override;

    std::optional<Hit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const override;
    bool occluded(vec3 origin, vec3 direction, float tFar) const override;
    /// seen[i] becomes whether nothing lies between `from` and to[i], for the i whose seen[i] is not 0 yet; the rest stays 0. Eight rays at
    /// a time: fastest when neighbours in `to` are neighbours in space.
    void unoccluded(vec3 from, std::span<const vec3> to, std::span<uint8_t> seen) const;
    /// Distances of many rays on all cores, as fast as Embree answers them: what tracers' rays a second are compared with. Infinity where
    /// nothing is hit. Misuse: spans of different length, a width that is neither 1 nor 8, assert.
    /// @param width  rays a call of Embree, 1 or 8
    void distances(std::span<const vec3> origins, std::span<const vec3> directions, int width, std::span<float> t) const;
    /// Metres to the nearest triangle, or `farthest` when none is nearer. Masked triangles count whole.
    float nearest(vec3 point, float farthest) const;

    const Scene& scene() const override;
    const std::vector<Presence>& presence() const; // [triangles]

private:
    struct State;
    explicit TriangleRays(std::unique_ptr<State> owned);
    std::unique_ptr<State> state;
};

} // namespace sconce
