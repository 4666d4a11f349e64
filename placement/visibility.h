#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/result.h"
#include "scene/scene.h"

namespace sconce
{

/// Whether a triangle is there at all (Material: a point is there when alpha >= alphaCutoff).
enum class Presence : uint8_t
{
    absent, // clear glass and the like: alpha is below the cutoff everywhere
    solid,
    masked, // the base colour texture decides point by point
};
std::vector<Presence> trianglePresence(const Scene& scene);

/// What a ray meets first.
struct RayHit
{
    float t = 0.0f;
    uint32_t triangle = 0; // index into Scene::triangles
    vec3 normal{0.0f};     // geometric, unit, on the side the ray came from
    bool back = false;     // the ray met the back of a single-sided triangle
};

/// Exact questions to the triangles of a scene: what a ray hits, whether two points see each other, how near the surface is. The only
/// file of placement that knows Embree. Surfaces are opaque from both sides; alpha-tested texels are looked through. Safe from many
/// threads. The scene must outlive it.
class Visibility
{
public:
    /// Errors: badInput when the scene has no triangle that is there; deviceFailure when Embree can't be started.
    static Result<Visibility> build(const Scene& scene);
    Visibility(Visibility&&) noexcept;
    Visibility& operator=(Visibility&&) noexcept;
    ~Visibility();

    bool cast(vec3 origin, vec3 direction, RayHit& hit) const; // direction unit; false on a miss
    /// Whether nothing lies between a probe and a surface point, which is lifted off its surface by epsilon() along its normal.
    bool sees(vec3 probe, vec3 surface, vec3 normal) const;
    bool unoccluded(vec3 from, vec3 to) const;
    /// seen[i] = unoccluded(from, to[i]) for the i whose seen[i] is not 0 yet; the rest stays 0. Eight rays at a time: fastest when
    /// neighbours in `to` are neighbours in space.
    void unoccluded(vec3 from, std::span<const vec3> to, std::span<uint8_t> seen) const;
    /// Metres to the nearest triangle, or `farthest` when none is nearer. Masked triangles count whole.
    float distance(vec3 point, float farthest) const;

    const Bounds& bounds() const;                  // of the triangles that are there
    const std::vector<Presence>& presence() const; // [triangles]
    float epsilon() const;                         // metres, the resolution of the scene's coordinates with some to spare

private:
    struct State;
    explicit Visibility(std::unique_ptr<State> owned);
    std::unique_ptr<State> state;
};

} // namespace sconce
