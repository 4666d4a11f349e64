#include "bench/sweep/probe_sets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace sconce
{
namespace
{

bool wantsPowersOfTwo(const PointSettings& settings)
{
    return settings.opponent() == Baseline::b0;
}

} // namespace

std::string probeSetName(const PointSettings& settings)
{
    return fmt::format("{}{}{}", settings.placement, wantsPowersOfTwo(settings) ? "2-" : "-", settings.probes);
}

Result<BenchProbes> placeFor(const Scene& scene, const PointSettings& settings, const Progress& progress)
{
    PlaceSettings place;
    place.count = settings.probes;
    if (settings.placement == "skeleton")
        place.refine = Refine::none;
    else if (settings.placement == "balls")
        place.method = PlaceSettings::Method::balls;
    else if (settings.placement == "grid")
    {
        place.method = PlaceSettings::Method::grid;
        place.fitGrid = true; // opponents at their best
        place.powersOfTwo = wantsPowersOfTwo(settings);
    }
    else if (settings.placement != "optimised")
        return Error{ErrorCode::badArgument,
                     fmt::format("Placement '{}' is not known; there are optimised, skeleton, balls and grid.", settings.placement)};
    PlaceReport report;
    Result<ProbeSet> set = placeProbes(scene, place, report, progress);
    if (!set) return set.error();
    BenchProbes made;
    made.name = probeSetName(settings);
    made.set = std::move(*set);
    made.report = {{"method", made.set.method},
                   {"seconds", report.seconds},
                   {"coverage", {{"rays", report.coverageRays}, {"area", report.coverageArea}}}};
    if (made.set.grid) made.report["grid"] = {made.set.grid->count.x, made.set.grid->count.y, made.set.grid->count.z};
    return made;
}

} // namespace sconce
