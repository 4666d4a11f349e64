#pragma once

#include "bench/sweep/settings.h"
#include "placement/place.h"

namespace sconce
{

/// Where a point's probes go, with what placing them cost.
struct BenchProbes
{
    std::string name; // optimised-54, grid-64 (powers of two: grid2-64)
    ProbeSet set;
    Json report; // method, seconds, coverage
};

/// The probes that these settings ask for: by our placement, without its refinement (skeleton), from ball shrinking, or on a uniform grid
/// in the reachable space, in the shape and pose that see most; b0's has counts that are powers of two, the nearest to what was asked.
/// Errors: as placeProbes(); badArgument names the placement.
Result<BenchProbes> placeFor(const Scene& scene, const PointSettings& settings, const Progress& progress);

/// The name alone, as results call the set.
std::string probeSetName(const PointSettings& settings);

} // namespace sconce
