#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sconce
{

/// LDR-FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"): perceived difference per pixel, in [0,1].
/// Inputs are linear RGB in [0,1], [height][width][3]; they are compared as shown in sRGB at `pixelsPerDegree` (67: a 0.7 m wide
/// 3840-pixel screen from 0.7 m).
std::vector<float> flipLdr(std::span<const float> test, std::span<const float> reference, uint32_t width, uint32_t height,
                           float pixelsPerDegree = 67.0f);

/// HDR-FLIP (Andersson et al. 2021, "Visualizing and Communicating Errors in Rendered Images"): the largest LDR-FLIP over a sweep of
/// exposures that is chosen from the reference. Inputs are linear RGB, any non-negative range.
std::vector<float> flipHdr(std::span<const float> test, std::span<const float> reference, uint32_t width, uint32_t height,
                           float pixelsPerDegree = 67.0f);

} // namespace sconce
