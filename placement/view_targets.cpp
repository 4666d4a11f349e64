#include "placement/view_targets.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "base/numbers.h"

namespace sconce
{
namespace
{

constexpr uint8_t kMostRare = 2; // probes that see a rare surfel; with two, a pair of exchanges can't lose a surfel unnoticed

uint64_t sumOfGains(const uint8_t* row, const uint8_t* best, size_t count)
{
    uint64_t sum = 0;
    for (size_t first = 0; first < count; first += 4096) // blocks whose sum fits 32 bits: the inner loop vectorises
    {
        const size_t end = std::min(count, first + 4096);
        uint32_t part = 0;
        for (size_t s = first; s < end; ++s) part += uint32_t(std::max(row[s], best[s]) - best[s]);
        sum += part;
    }
    return sum;
}

std::vector<Surfel> alongMortonCurve(std::vector<Surfel> surfels)
{
    Bounds bounds;
    for (const Surfel& surfel : surfels) bounds.add(surfel.position);
    const vec3 perCell = 1023.0f / glm::max(bounds.size(), vec3(1e-30f));
    std::vector<std::pair<uint32_t, uint32_t>> order(surfels.size());
    for (uint32_t s = 0; s < order.size(); ++s) order[s] = {mortonCode(uvec3((surfels[s].position - bounds.low) * perCell)), s};
    std::sort(order.begin(), order.end());
    std::vector<Surfel> sorted;
    for (const auto& [code, s] : order) sorted.push_back(surfels[s]);
    return sorted;
}

/// Every `stride`-th, so many that about `budget` remain: draws are in no order, so these are a fair sample of them.
uint32_t thin(std::vector<Surfel>& surfels, size_t budget)
{
    const size_t stride = std::max<size_t>(1, (surfels.size() + budget / 2) / std::max<size_t>(budget, 1));
    size_t kept = 0;
    for (size_t s = 0; s < surfels.size(); s += stride) surfels[kept++] = surfels[s];
    surfels.resize(kept);
    return uint32_t(stride);
}

} // namespace

uint64_t gainOf(std::span<const uint8_t> row, const uint8_t* best, const SurfelWeights& weights)
{
    const size_t common = std::min(weights.common, row.size());
    return weights.commonWeight * sumOfGains(row.data(), best, common) +
           weights.rareWeight * sumOfGains(row.data() + common, best + common, row.size() - common);
}

ViewTargets::ViewTargets(const Visibility& visibility, std::vector<Surfel> samples, float metres)
    : ViewTargets(visibility, {}, 1, std::move(samples), 1, metres)
{
}

ViewTargets::ViewTargets(const Visibility& visibility, std::vector<Surfel> common, uint32_t commonWeight, std::vector<Surfel> rare,
                         uint32_t rareWeight, float metres)
    : surfels(alongMortonCurve(std::move(common))), spacing(metres), weights{surfels.size(), commonWeight, rareWeight}
{
    for (const Surfel& surfel : alongMortonCurve(std::move(rare))) surfels.push_back(surfel);
    for (const Surfel& surfel : surfels) lifted.push_back(surfel.position + visibility.epsilon() * surfel.normal);
}

void ViewTargets::rate(const Visibility& visibility, vec3 probe, std::span<uint8_t> values, std::span<const uint8_t> floor) const
{
    for (size_t s = 0; s < surfels.size(); ++s)
    {
        const float quality = viewQuality(surfels[s], probe, spacing);
        // Each surfel rounds at a place of its own (multiples of the golden ratio), so that the sum over many knows finer steps than one.
        const float dither = float((uint32_t(s) * 2654435769u) >> 8) * 0x1p-24f;
        const uint8_t value = quality > 0.0f ? uint8_t(float(kSeen) + std::floor(float(kBetter) * quality + dither)) : uint8_t(0);
        values[s] = floor.empty() || value > floor[s] ? value : uint8_t(0);
    }
    thread_local std::vector<uint8_t> seen;
    seen.assign(values.begin(), values.end());
    visibility.unoccluded(probe, lifted, seen);
    for (size_t s = 0; s < surfels.size(); ++s)
        if (!seen[s]) values[s] = 0;
}

std::vector<uint8_t> countViews(const Visibility& visibility, std::span<const Surfel> surfels, std::span<const vec3> probes, float spacing,
                                uint8_t most)
{
    std::vector<uint8_t> views(surfels.size(), 0);
    tbb::parallel_for(size_t(0), surfels.size(),
                      [&](size_t s)
                      {
                          thread_local std::vector<std::pair<float, uint32_t>> ranked; // a heap: few of the best are asked
                          ranked.clear();
                          for (uint32_t probe = 0; probe < probes.size(); ++probe)
                              if (const float quality = viewQuality(surfels[s], probes[probe], spacing); quality > 0.0f)
                                  ranked.emplace_back(quality, probe);
                          std::make_heap(ranked.begin(), ranked.end());
                          for (auto end = ranked.end(); end != ranked.begin() && views[s] < most; --end)
                          {
                              std::pop_heap(ranked.begin(), end);
                              views[s] += visibility.sees(probes[(end - 1)->second], surfels[s].position, surfels[s].normal);
                          }
                      });
    return views;
}

ViewTargets stratifiedTargets(const Visibility& visibility, const std::vector<Surfel>& draws, std::span<const vec3> probes, size_t budget,
                              float spacing, std::vector<Surfel>& unseen)
{
    const std::vector<uint8_t> views = countViews(visibility, draws, probes, spacing, kMostRare + 1);
    size_t atMost[kMostRare + 1] = {}; // draws that at most so many probes see
    for (uint8_t view : views)
        for (uint8_t limit = view; limit <= kMostRare; ++limit) ++atMost[limit];
    uint8_t limit = kMostRare;
    while (limit > 0 && atMost[limit] > budget) --limit;
    std::vector<Surfel> common, rare;
    unseen.clear();
    for (size_t s = 0; s < draws.size(); ++s)
    {
        (views[s] <= limit ? rare : common).push_back(draws[s]);
        if (views[s] == 0) unseen.push_back(draws[s]);
    }
    const uint32_t commonWeight = thin(common, budget), rareWeight = thin(rare, budget);
    return {visibility, std::move(common), commonWeight, std::move(rare), rareWeight, spacing};
}

} // namespace sconce
