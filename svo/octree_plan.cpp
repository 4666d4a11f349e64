#include "svo/octree_plan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include "base/limits.h"
#include "base/parallel.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::vec3;

constexpr uint32_t kMostSamples = 1u << 23; // surface samples of all maps
constexpr int kRegionsAlong = 16;           // regions along the longest side, about
constexpr double kOutsideInfluence = 2.0 / 3.0;
constexpr double kWeightAtOneVoxel = double(1 << 20); // times the largest gain of a rank, it fits 32 bits

/// Probes but those that stand exactly where an earlier one does: a list that named both would have one rank less.
std::vector<uint32_t> distinctProbes(const ProbeMaps& maps)
{
    std::vector<uint32_t> probes(maps.probes.size());
    std::iota(probes.begin(), probes.end(), 0u);
    const auto key = [&](uint32_t p)
    {
        const vec3 c = maps.probes[p].centre;
        return std::tuple(c.x, c.y, c.z);
    };
    std::ranges::stable_sort(probes, {}, key);
    const auto again = std::ranges::unique(probes, {}, key);
    probes.erase(again.begin(), again.end());
    std::ranges::sort(probes);
    return probes;
}

/// World box of what the probes see, its outermost share cut off on each side.
void seenBounds(const ProbeMaps& maps, std::span<const uint32_t> distinct, vec3& low, vec3& high)
{
    constexpr size_t kMost = 1u << 20; // samples of all probes, about
    constexpr double kCut = 0.01;
    using Text = Pure<float>;
    const size_t size = maps.info.faceSize, probes = distinct.size();
    const size_t samples = std::clamp(size_t(std::sqrt(double(kMost) / double(6 * probes))), size_t(2), std::min<size_t>(24, size));
    std::array<std::vector<float>, 3> seen;
    for (const size_t probe : distinct)
        for (size_t face = 0; face < 6; ++face)
            for (size_t y = 0; y < samples; ++y)
                for (size_t x = 0; x < samples; ++x)
                {
                    const size_t px = (2 * x + 1) * size / (2 * samples), py = (2 * y + 1) * size / (2 * samples);
                    const float q = Text::halfToReal(
                        maps.distance[probe * maps.info.wordsPerProbe + face * (maps.info.wordsPerProbe / 6) + py * size + px]);
                    if (q == 0.0f) continue;
                    const float u = 2.0f * (float(px) + 0.5f) / float(size) - 1.0f, v = 2.0f * (float(py) + 0.5f) / float(size) - 1.0f;
                    const vec3 point = maps.probes[probe].centre + Text::faceDirection(int(face), vec3(u, v, 1.0f) / q);
                    for (int a = 0; a < 3; ++a) seen[a].push_back(point[a]);
                }
    low = high = maps.probes[0].centre;
    for (const gpu::ProbeHeader& probe : maps.probes)
    {
        low = glm::min(low, vec3(probe.centre));
        high = glm::max(high, vec3(probe.centre));
    }
    for (int a = 0; a < 3; ++a)
    {
        if (seen[a].empty()) continue;
        const ptrdiff_t cut = ptrdiff_t(kCut * double(seen[a].size()));
        std::nth_element(seen[a].begin(), seen[a].begin() + cut, seen[a].end());
        low[a] = std::min(low[a], seen[a][size_t(cut)]);
        std::nth_element(seen[a].begin(), seen[a].end() - 1 - cut, seen[a].end());
        high[a] = std::max(high[a], *(seen[a].end() - 1 - cut));
    }
    const vec3 margin = 0.01f * (high - low) + vec3(1e-3f);
    low = glm::max(low - margin, vec3(maps.info.sceneLow) - vec3(1e-3f));
    high = glm::min(high + margin, vec3(maps.info.sceneHigh) + vec3(1e-3f));
    high = glm::max(high, low + vec3(1e-3f));
}

/// How much a probe counts in a region; at least 1.
uint32_t weightOf(const gpu::ProbeHeader& probe, vec3 regionCentre, float regionSide, float voxel)
{
    const vec3 offset = regionCentre - vec3(probe.centre);
    const double distance = std::max(double(glm::length(offset)), 0.5 * double(regionSide)) / double(voxel);
    const bool inside =
        glm::all(glm::lessThanEqual(offset, vec3(probe.influenceHigh))) && glm::all(glm::lessThanEqual(-offset, vec3(probe.influenceLow)));
    return uint32_t(std::max(1.0, std::floor(kWeightAtOneVoxel / std::sqrt(distance) * (inside ? 1.0 : kOutsideInfluence))));
}

void findCandidates(const ProbeMaps& maps, std::span<const uint32_t> distinct, OctreePlan& plan)
{
    const gpu::OctreeBuild& build = plan.build;
    const float side = build.voxel * float(1 << build.regionShift);
    plan.candidates.resize(size_t(build.regions.x) * size_t(build.regions.y) * size_t(build.regions.z) * build.candidates);
    parallelFor(plan.candidates.size() / build.candidates,
                [&](size_t i)
                {
                    const ivec3 region(int(i % build.regions.x), int(i / build.regions.x % build.regions.y),
                                       int(i / build.regions.x / build.regions.y));
                    const vec3 centre = vec3(build.low) + side * (vec3(region) + 0.5f);
                    std::vector<glm::uvec2> all;
                    all.reserve(distinct.size());
                    for (const uint32_t p : distinct) all.emplace_back(p, weightOf(maps.probes[p], centre, side, build.voxel));
                    std::partial_sort(all.begin(), all.begin() + build.candidates, all.end(),
                                      [](const glm::uvec2& a, const glm::uvec2& b) { return a.y != b.y ? a.y > b.y : a.x < b.x; });
                    std::copy_n(all.begin(), build.candidates, plan.candidates.begin() + ptrdiff_t(i * build.candidates));
                });
}

int voxelsFor(const OctreeSettings& settings, size_t probes)
{
    constexpr double kProbes = 54.0; // of Sponza, whose index of 128 voxels takes 13 kB a probe
    return settings.voxels != 0 ? settings.voxels : std::clamp(int(128.0 * std::sqrt(double(probes) / kProbes)), 128, 256);
}

std::string argumentFault(const ProbeMaps& maps, const OctreeSettings& settings)
{
    if (maps.probes.empty()) return "an octree needs at least one probe; place some first";
    if (maps.probes.size() > kMostProbes)
        return fmt::format("{} probes are more than the {} an octree can index; place fewer", maps.probes.size(), kMostProbes);
    if (const std::string fault = firstFault({faultOf(knobs::octreeVoxels, settings.voxels), faultOf(knobs::topShift, settings.topShift)});
        !fault.empty())
        return fmt::format("octree settings: {}", fault);
    if (maps.info.chart != gpu::kChartCube) return "the octree judges visibility by cube-face maps; bake with the cube chart";
    return {};
}

} // namespace

Result<OctreePlan> planOctree(const ProbeMaps& maps, const OctreeSettings& settings)
{
    if (const std::string fault = argumentFault(maps, settings); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    OctreePlan plan;
    Octree& tree = plan.tree;
    const std::vector<uint32_t> distinct = distinctProbes(maps);
    seenBounds(maps, distinct, tree.boundsLow, tree.boundsHigh);
    const vec3 size = tree.boundsHigh - tree.boundsLow;
    const int voxels = voxelsFor(settings, distinct.size());
    tree.voxel = std::max({size.x, size.y, size.z}) / float(voxels);
    tree.topShift = settings.topShift;
    tree.topCells = glm::max(ivec3(glm::ceil(size / (tree.voxel * float(1 << tree.topShift)) - 1e-4f)), ivec3(1));
    tree.boundsHigh = tree.boundsLow + tree.voxel * float(1 << tree.topShift) * vec3(tree.topCells);
    tree.marker = maps.probes.size() <= kMostProbesOf8Bits ? kMostProbesOf8Bits : kMostProbes;

    gpu::OctreeBuild& build = plan.build;
    build.low = tree.boundsLow;
    build.voxel = tree.voxel;
    build.inverseVoxel = 1.0f / tree.voxel;
    build.count = tree.topCells << tree.topShift;
    build.regionShift = std::max(int(std::bit_width(unsigned(voxels / kRegionsAlong))) - 1, 2); // whole blocks
    build.regions = ((build.count - 1) >> build.regionShift) + 1;
    build.probeCount = uint32_t(maps.probes.size());
    build.candidates = std::min(uint32_t(distinct.size()), gpu::kMostCandidates);
    build.faceSize = maps.info.faceSize;
    build.wordsPerProbe = maps.info.wordsPerProbe;
    build.sampleStep = 1;
    const auto samplesAt = [&](uint32_t step)
    { return uint64_t(build.probeCount) * 6 * (build.faceSize / step) * (build.faceSize / step); };
    while (samplesAt(build.sampleStep) > kMostSamples && build.faceSize / build.sampleStep > 4) build.sampleStep *= 2;
    build.sampleSide = build.faceSize / build.sampleStep;
    plan.samples = uint32_t(samplesAt(build.sampleStep));
    build.texelWidth = 2.0f / float(build.faceSize);
    build.topLevel = maps.info.topLevel;
    build.slack = 1.0f / float(build.faceSize);
    findCandidates(maps, distinct, plan);
    return plan;
}

} // namespace sconce
