#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "placement/coverage.h"
#include "placement/free_space.h"

namespace sconce
{

/// A picture of 3 linear floats a pixel, row 0 at the top.
struct Picture
{
    uint32_t width = 0, height = 0;
    std::vector<float> rgb;
};

/// A placement seen from above (plan, x to the right, z down) and below it from the side (section, x to the right, y up). Grey: reachable
/// space, the lighter the more of it along the line of sight. Dots: what rays from it hit, from yellow (seen badly) to green (seen well),
/// and on top of them red where no probe sees it. White discs with a black rim: probes.
Picture drawPlacement(const FreeSpace& space, std::span<const vec3> probes, const Coverage& coverage);

} // namespace sconce
