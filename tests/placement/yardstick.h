#pragma once

#include <cstdint>
#include <vector>

#include "placement/free_space.h"
#include "placement/visibility.h"

namespace sconce::test
{

/// The placement that ours is held against: plain greedy set cover by seen or not seen over `candidates` random free points, at least one
/// cell of the distance field away from surfaces, on `surfels` points that random rays hit. It shares no choice with placeProbes.
std::vector<vec3> yardstickProbes(const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed,
                                  size_t candidates = 1500, size_t surfels = 20000);

} // namespace sconce::test
