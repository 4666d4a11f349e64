#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace sconce
{

struct ClearedProbes
{
    std::vector<vec3> positions; // world, metres, in the order given
    uint32_t moved = 0;          // of them
    uint32_t tight = 0;          // of them, those that found no place: between surfaces nearer to each other than two clearances
};

/// Moves probes that stand nearer to a surface than `clearance` (metres) straight off it, on their side; off its front where they stand
/// exactly on it. A plane through a probe's centre lies in none of its directions, and what is nearer than the maps' near plane isn't
/// drawn: such a probe would see through the wall. Cost: O(triangles log probes) and the probes near each triangle, at most 16 times.
ClearedProbes clearedOfSurfaces(const Scene& scene, std::span<const vec3> probes, float clearance);

} // namespace sconce
