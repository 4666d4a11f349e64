#pragma once

#include <cstdint>

#include "base/result.h"
#include "runtime/vulkan/vulkan_functions.h"

namespace sconce
{

inline constexpr uint32_t kMostRaysALane = 16;

/// How many rays of a list a lane takes, one when the last has ended: answers are the same, and the time is not. 1: each lane has one,
/// which is best on processors, whose lanes do all work together anyhow (bench/results/tried.json, tracer__lanes, gpu__refill).
/// @param ballots  whether lanes can ask each other who waits; else 1
/// The environment's SCONCE_RAYS_A_LANE says otherwise, to measure it: 1, 2, 4, 8 or 16. Errors: badArgument, of another value;
/// missingFeature, where more than 1 are asked for without ballots.
Result<uint32_t> raysALane(VkPhysicalDeviceType kind, bool ballots);

} // namespace sconce
