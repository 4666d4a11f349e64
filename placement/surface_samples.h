#pragma once

#include <cstdint>
#include <vector>

#include "placement/free_space.h"
#include "placement/visibility.h"

namespace sconce
{

/// A sample of the surface, on the side that reachable space sees.
struct Surfel
{
    vec3 position{0.0f};
    vec3 normal{0.0f}; // geometric, unit, toward reachable space
    uint32_t triangle = 0;
    bool back = false; // the back of a single-sided triangle
};

inline constexpr float kLeastCosine = 0.05f; // a point seen flatter than this is not seen: its texel would smear over metres

/// Where random rays from points spread evenly over the reachable space hit: what a traced ray needs to find in some probe. Fewer than
/// `count` when most rays meet nothing.
std::vector<Surfel> raySurfels(const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed);

/// Evenly spread over the area of the reachable surface: sides of triangles that have a reachable cell before them, in plain view.
std::vector<Surfel> areaSurfels(const Scene& scene, const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed);

/// Share of the scene's surface, by area, that has no reachable space on either side: what a placement doesn't answer for. Within 1 %.
float shareLeftOut(const Scene& scene, const Visibility& visibility, const FreeSpace& space, uint64_t seed);

/// How well a probe sees a surfel that nothing hides, in (0,1]: cosine, times 1/2 at `spacing` metres and falling with distance; 0 when it
/// can't be seen for its cosine. Texels per metre of surface fall with both. Source: the terms of Wang et al. 2019, section 3.2.
float viewQuality(const Surfel& surfel, vec3 probe, float spacing);

} // namespace sconce
