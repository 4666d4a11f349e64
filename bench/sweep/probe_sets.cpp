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

/// Of the grids the one that its judge finds least wrong.
Result<ProbeGrid> bestGrid(const Scene& scene, const PlaceSettings& place, const GridJudge& judge, const Progress& progress)
{
    const Result<std::vector<ProbeGrid>> poses = gridPoses(scene, place, progress);
    if (!poses) return poses.error();
    const ProbeGrid* best = nullptr;
    double least = 0.0;
    for (const ProbeGrid& pose : *poses)
    {
        const Result<double> wrong = judge(pose);
        if (!wrong) return wrong.error();
        if (!best || *wrong < least) best = &pose, least = *wrong;
    }
    return *best;
}

} // namespace

std::string probeSetName(const PointSettings& settings)
{
    // A grid is chosen by its method's own answers, so that each has its own.
    return fmt::format("{}-{}{}", settings.placement, settings.placement == "grid" ? settings.method + "-" : "", settings.probes);
}

Status applyPlacement(PlaceSettings& settings, const std::string& placement)
{
    if (placement == "skeleton")
        settings.refine = Refine::none;
    else if (placement == "balls")
        settings.method = PlaceSettings::Method::balls;
    else if (placement == "grid")
        settings.method = PlaceSettings::Method::grid;
    else if (placement != knobs::placement.value)
        return Error{ErrorCode::badArgument, fmt::format("Placement '{}' is not known; there are {}, skeleton, balls and grid.", placement,
                                                         knobs::placement.value)};
    return success();
}

Result<BenchProbes> placeFor(const Scene& scene, const PointSettings& settings, const Progress& progress, const GridJudge& judge)
{
    PlaceSettings place;
    place.count = settings.probes;
    if (const auto status = applyPlacement(place, settings.placement); !status) return status.error();
    if (place.method == PlaceSettings::Method::grid)
    {
        place.fitGrid = true; // opponents at their best
        place.powersOfTwo = wantsPowersOfTwo(settings);
        if (judge)
        {
            const Result<ProbeGrid> best = bestGrid(scene, place, judge, progress);
            if (!best) return best.error();
            place.pose = *best;
        }
    }
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
