#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sconce
{

/// Pixels by their priorities, at most `budget`, spread over the picture in proportion: error diffusion, there and back row by row (Floyd
/// and Steinberg 1976), as Walter, Drettakis, Parker 1999 ("Interactive Rendering using the Render Cache", section 4) choose theirs.
/// @param priority  [height][width], 0 or more; of 0 a pixel is never chosen
std::vector<uint32_t> chooseSamples(std::span<const float> priority, uint32_t width, size_t budget);

} // namespace sconce
