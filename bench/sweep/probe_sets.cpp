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

glm::ivec3 powerOfTwoShape(const Bounds& bounds, uint32_t count)
{
    const vec3 size = glm::max(bounds.size(), vec3(1e-6f * bounds.diagonal()));
    glm::ivec3 best(1);
    double bestRatio = std::numeric_limits<double>::infinity(), bestAspect = bestRatio;
    for (int x = 0; x <= 6; ++x)
        for (int y = 0; y <= 6; ++y)
            for (int z = 0; z <= 6; ++z)
            {
                const glm::ivec3 shape(1 << x, 1 << y, 1 << z);
                const double ratio = std::abs(double(x + y + z) - std::log2(double(count)));
                const vec3 cell = size / vec3(shape);
                const double aspect = std::max({cell.x, cell.y, cell.z}) / std::min({cell.x, cell.y, cell.z});
                if (ratio > bestRatio || (ratio == bestRatio && aspect >= bestAspect)) continue;
                best = shape, bestRatio = ratio, bestAspect = aspect;
            }
    return best;
}

Result<BenchProbes> placeFor(const Scene& scene, const PointSettings& settings, const Progress& progress)
{
    PlaceSettings place;
    place.count = settings.probes;
    if (settings.placement == "skeleton")
    {
        place.refine = Refine::none;
        place.relocateRounds = 0;
    }
    else if (settings.placement == "balls")
        place.method = PlaceSettings::Method::balls;
    else if (settings.placement == "grid")
        place.method = PlaceSettings::Method::grid;
    else if (settings.placement != "optimised")
        return Error{ErrorCode::badArgument,
                     fmt::format("Placement '{}' is not known; there are optimised, skeleton, balls and grid.", settings.placement)};
    PlaceReport report;
    Result<ProbeSet> set = placeProbes(scene, place, report, progress);
    if (set && wantsPowersOfTwo(settings) && place.method == PlaceSettings::Method::grid)
    {
        place.count = 0; // the shape says
        place.grid = powerOfTwoShape(report.reachable, settings.probes);
        report = {};
        set = placeProbes(scene, place, report, progress);
    }
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
