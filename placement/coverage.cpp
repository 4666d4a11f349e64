#include "placement/coverage.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace sconce
{
namespace
{

constexpr uint32_t kNobody = 0xffffffffu;

/// The probe with the best view of each surfel, or kNobody. Probes are asked best first, so the first that sees it ends the search.
std::vector<uint32_t> bestProbes(const Visibility& visibility, std::span<const Surfel> surfels, std::span<const vec3> probes, float spacing)
{
    std::vector<uint32_t> best(surfels.size(), kNobody);
    tbb::parallel_for(size_t(0), surfels.size(),
                      [&](size_t s)
                      {
                          std::vector<std::pair<float, uint32_t>> ranked;
                          for (uint32_t probe = 0; probe < probes.size(); ++probe)
                              if (const float quality = viewQuality(surfels[s], probes[probe], spacing); quality > 0.0f)
                                  ranked.emplace_back(-quality, probe);
                          std::sort(ranked.begin(), ranked.end());
                          for (const auto& [quality, probe] : ranked)
                              if (visibility.sees(probes[probe], surfels[s].position, surfels[s].normal))
                              {
                                  best[s] = probe;
                                  return;
                              }
                      });
    return best;
}

float median(std::vector<float>& values)
{
    if (values.empty()) return 0.0f;
    const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

float shareSeen(const std::vector<uint32_t>& best)
{
    const auto seen = std::count_if(best.begin(), best.end(), [](uint32_t probe) { return probe != kNobody; });
    return best.empty() ? 0.0f : float(double(seen) / double(best.size()));
}

} // namespace

float probeSpacing(const FreeSpace& space, size_t probes)
{
    return float(std::cbrt(space.volume / double(std::max<size_t>(probes, 1))));
}

Result<Coverage> measureCoverage(const Scene& scene, const Visibility& visibility, const FreeSpace& space, std::span<const vec3> probes,
                                 const CoverageSettings& settings, const Progress& progress)
{
    const Error cancelled{ErrorCode::cancelled, "The measurement of coverage was cancelled."};
    if (settings.points < 1000 || settings.points > 10'000'000)
        return Error{ErrorCode::badArgument,
                     fmt::format("Coverage can't be measured with {} points; give 1000 to 10000000.", settings.points)};
    for (const vec3& probe : probes)
        if (!std::isfinite(probe.x + probe.y + probe.z))
            return Error{ErrorCode::badArgument, "A probe's position is not finite, so its coverage can't be measured."};
    if (!report(progress, "coverage", 0.0)) return cancelled;
    // Streams of their own: samples that a placement was fitted to would flatter it.
    const std::vector<Surfel> hit = raySurfels(visibility, space, settings.points, settings.seed ^ 0x636f766572616765ull);
    const float spacing = probeSpacing(space, probes.size());
    const std::vector<uint32_t> best = bestProbes(visibility, hit, probes, spacing);
    if (!report(progress, "coverage", 0.6)) return cancelled;
    // By area as well: rays hit most what much of the space sees, and a niche hardly counts.
    const std::vector<Surfel> spread = areaSurfels(scene, visibility, space, settings.points, settings.seed ^ 0x61726561ull);

    Coverage coverage;
    coverage.rayPoints = hit.size();
    coverage.areaPoints = spread.size();
    coverage.rays = shareSeen(best);
    coverage.area = shareSeen(bestProbes(visibility, spread, probes, spacing));
    std::vector<float> cosines, distances;
    size_t backs = 0;
    for (size_t s = 0; s < hit.size(); ++s)
    {
        backs += hit[s].back;
        coverage.quality.push_back(best[s] == kNobody ? 0.0f : viewQuality(hit[s], probes[best[s]], spacing));
        if (best[s] == kNobody)
        {
            coverage.unseen.push_back(hit[s]);
            continue;
        }
        const vec3 toProbe = probes[best[s]] - hit[s].position;
        distances.push_back(glm::length(toProbe));
        cosines.push_back(glm::dot(toProbe, hit[s].normal) / distances.back());
    }
    coverage.backs = hit.empty() ? 0.0f : float(double(backs) / double(hit.size()));
    coverage.points = hit;
    coverage.medianCosine = median(cosines);
    coverage.medianDistance = median(distances);
    if (!report(progress, "coverage", 1.0)) return cancelled;
    return coverage;
}

Result<Coverage> measureCoverage(const Scene& scene, std::span<const vec3> probes, const CoverageSettings& settings,
                                 const Progress& progress)
{
    if (const std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, fault};
    const Result<Visibility> visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    const Result<FreeSpace> space = findFreeSpace(scene, *visibility, settings.inside, settings.voxels, progress, settings.open);
    if (!space) return space.error();
    return measureCoverage(scene, *visibility, *space, probes, settings, progress);
}

} // namespace sconce
