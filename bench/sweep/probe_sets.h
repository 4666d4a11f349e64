#pragma once

#include <functional>

#include "bench/sweep/settings.h"
#include "placement/place.h"

namespace sconce
{

/// Where a point's probes go, with what placing them cost.
struct BenchProbes
{
    std::string name; // optimised-54; of a grid, which a method has to itself: grid-b0-64
    ProbeSet set;
    Json report; // method, seconds, coverage
};

/// How much is wrong with what a method makes of a grid; the least is the best.
using GridJudge = std::function<Result<double>(const ProbeGrid&)>;

/// How a point's probes are placed, by the name of PointSettings::placement. Errors: badArgument.
Status applyPlacement(PlaceSettings& settings, const std::string& placement);

/// The probes that these settings ask for: by our placement, without its refinement (skeleton), from ball shrinking, or on a uniform grid
/// in the reachable space, of the shapes and poses of gridPoses() in the one that is judged best; b0's has counts that are powers of two,
/// the nearest to what was asked.
/// @param judge  of grids; none: what their cells' corners see
/// Errors: as placeProbes(), and the judge's; badArgument names the placement.
Result<BenchProbes> placeFor(const Scene& scene, const PointSettings& settings, const Progress& progress, const GridJudge& judge = {});

/// The name alone, as results call the set.
std::string probeSetName(const PointSettings& settings);

} // namespace sconce
