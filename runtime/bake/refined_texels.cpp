#include "runtime/bake/refined_texels.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/numbers.h"
#include "base/parallel.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

constexpr float kLeastOff = 0.03f; // share of a texel's light that it is off by: less never shows
constexpr float kDim = 0.5f;       // of the mean light: what errors are told from beside a texel's own
constexpr uint32_t kFineSide = 1u << gpu::kFineLog;

using Texel = RefinedPlaces::Texel;

struct Candidate
{
    Texel texel;
    float error = 0.0f; // of its light, times its area
};

/// A field's texels, by the shared text.
struct Texels : twin::LightFieldTwin<float>
{
    float dim = 0.0f; // light that an error of as much hardly shows in

    explicit Texels(const FieldData& lit, float dimmest = 0.0f) : LightFieldTwin<float>(lit, {}), dim(dimmest) {}

    float lightOf(const Texel& texel, int x, int y)
    {
        return glm::dot(unpackSharedExponent(surfaceWord(surfaceIndex(texel.probe, int(texel.at.z), x, y))), kLuminance);
    }

    /// How far a texel's light is off the line between its neighbours along an axis, or off the one that goes on; share of their light.
    float offAlong(const Texel& texel, const SurfacePoint& own, glm::ivec2 axis)
    {
        const float light = lightOf(texel, int(texel.at.x), int(texel.at.y));
        float sum = 0.0f, brightest = light;
        int count = 0;
        for (const int step : {-1, 1})
        {
            const glm::ivec2 at = glm::ivec2(texel.at) + step * axis;
            if (at.x < 0 || at.y < 0 || at.x >= int(field.surfaceSize) || at.y >= int(field.surfaceSize)) continue;
            if (surfaceWord(surfaceIndex(texel.probe, int(texel.at.z), at.x, at.y)) == 0) continue;
            if (!isSameSurface(own.at, own.normal, surfacePointAt(texel.probe, int(texel.at.z), at.x, at.y), kSurfaceBend)) continue;
            const float other = lightOf(texel, at.x, at.y);
            sum += other - light;
            brightest = std::max(brightest, other);
            ++count;
        }
        return brightest > 0.0f ? std::abs(sum) / (2.0f * (brightest + dim)) : 0.0f;
    }

    /// Whether a probe is one of those that light a place.
    bool lights(uint32_t probe, glm::vec3 place, glm::vec3 normal)
    {
        int reads = 0;
        const glm::uvec4 ranked = rankedProbesAt(place + 0.5f * field.voxel * normal, reads);
        const float own = surfaceDensity(probe, place, normal);
        int before = 0;
        bool named = false;
        for (int k = 0; k < gpu::kRanked; ++k)
        {
            named = named || ranked[k] == probe;
            bool repeated = false;
            for (int j = 0; j < k; ++j) repeated = repeated || ranked[j] == ranked[k];
            if (repeated || ranked[k] == probe || !(surfaceDensity(ranked[k], place, normal) > own)) continue;
            before += isSeenBy(ranked[k], place - probeHeader(ranked[k]).centre, normal);
        }
        return named && before < kSurfaceProbes;
    }

    float errorOf(const Texel& texel)
    {
        const glm::ivec3 at(texel.at);
        if (surfaceWord(surfaceIndex(texel.probe, at.z, at.x, at.y)) == 0) return 0.0f;
        const SurfacePoint own = surfacePointAt(texel.probe, at.z, at.x, at.y);
        const float off = std::max(offAlong(texel, own, {1, 0}), offAlong(texel, own, {0, 1}));
        if (!(off > kLeastOff) || !lights(texel.probe, probeHeader(texel.probe).centre + own.at, own.normal)) return 0.0f;
        return off * own.width * own.width;
    }
};

float meanLight(const FieldData& lit)
{
    const size_t texels = size_t(6) * lit.info.surfaceSize * lit.info.surfaceSize * lit.info.probeCount;
    double sum = 0.0;
    for (size_t i = 0; i < texels; ++i) sum += double(glm::dot(Pure<float>::unpackSharedExponent(lit.surfaceLight[i]), kLuminance));
    return float(sum / double(texels));
}

std::vector<Texel> worstTexels(const FieldData& lit, size_t most)
{
    const float dim = kDim * meanLight(lit);
    const uint32_t side = lit.info.surfaceSize;
    const size_t rows = size_t(6) * side * lit.info.probeCount;
    std::vector<std::vector<Candidate>> found(rows);
    parallelFor(rows,
                [&](size_t row)
                {
                    Texels texels(lit, dim);
                    for (uint32_t x = 0; x < side; ++x)
                    {
                        const Texel texel{uint32_t(row / (size_t(6) * side)), {x, row % side, row / side % 6}};
                        const float error = texels.errorOf(texel);
                        if (error > 0.0f) found[row].push_back({texel, error});
                    }
                });
    std::vector<Candidate> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    std::ranges::stable_sort(all, std::ranges::greater(), &Candidate::error);
    if (all.size() > most) all.resize(most);
    std::vector<Texel> worst;
    for (const Candidate& candidate : all) worst.push_back(candidate.texel);
    return worst;
}

/// As surface_filter.comp, over the finer texels.
struct FineFilter
{
    Texels& texels; // of one thread
    const std::vector<Texel>& refined;
    const std::vector<TriangleGather::FinePoints>& points;
    const std::unordered_map<uint32_t, uint32_t>& places; // a texel's index, and its place in `refined`

    const TriangleGather::Point* pointAt(const Texel& of, int x, int y) const
    {
        const int side = int(texels.field.surfaceSize * kFineSide);
        if (x < 0 || y < 0 || x >= side || y >= side) return nullptr;
        const auto found = places.find(texels.surfaceIndex(of.probe, int(of.at.z), x >> gpu::kFineLog, y >> gpu::kFineLog));
        if (found == places.end()) return nullptr;
        const TriangleGather::Point& point = points[found->second][texels.fineIndex(x, y) - 1];
        return point.known ? &point : nullptr;
    }

    uint32_t lightOf(const Texel& texel, uint32_t index) const
    {
        constexpr float kLikeNoise = 2.0f, kAlike = 0.02f;
        const int x = int(kFineSide * texel.at.x + index % kFineSide), y = int(kFineSide * texel.at.y + index / kFineSide);
        const TriangleGather::Point* point = pointAt(texel, x, y);
        if (!point) return 0;
        const uint32_t side = texels.field.surfaceSize * kFineSide;
        const auto own = texels.surfacePointOf(texel.probe, int(texel.at.z), x, y, side);
        const float reach = std::max(Texels::kReachOfDistance * point->reach, Texels::kLeastReach * own.width),
                    ownFirst = glm::dot(point->straight, kLuminance);
        glm::vec3 bounced(0.0f), straight(0.0f);
        float weights = 0.0f, straightWeights = 0.0f;
        for (int tap = 0; tap < 25; ++tap)
        {
            const glm::ivec2 at(x + tap % 5 - 2, y + tap / 5 - 2);
            const TriangleGather::Point* other = pointAt(texel, at.x, at.y);
            if (!other) continue;
            const auto there = texels.surfacePointOf(texel.probe, int(texel.at.z), at.x, at.y, side);
            if (!texels.isSameSurface(own.at, own.normal, there, twin::LightFieldTwin<float>::kSurfaceBend)) continue;
            const glm::vec3 to = there.at - own.at;
            float weight = std::exp(-0.5f * glm::dot(to, to) / (reach * reach));
            bounced += weight * other->bounced;
            weights += weight;
            const float theirs = glm::dot(other->straight, kLuminance), off = theirs - ownFirst,
                        slack = kAlike * std::max(theirs, ownFirst);
            weight *= std::exp(-off * off / std::max(2.0f * kLikeNoise * (point->variance + other->variance) + slack * slack, 1e-30f));
            straight += weight * other->straight;
            straightWeights += weight;
        }
        return texels.packKnownLight(bounced / weights + straight / straightWeights);
    }
};

} // namespace

void refineTexels(FieldData& lit, const TriangleGather& triangles, const TriangleGather::Sent& sent, float share,
                  std::optional<RefinedPlaces>* places)
{
    const size_t all = size_t(6) * lit.info.surfaceSize * lit.info.surfaceSize * lit.info.probeCount;
    const std::vector<Texel> refined = places && *places ? (*places)->texels : worstTexels(lit, size_t(share * double(all)));
    if (places && !*places) *places = RefinedPlaces{refined};
    std::vector<TriangleGather::FinePoints> points(refined.size());
    parallelFor(refined.size(), [&](size_t i) { points[i] = triangles.gatherFiner(refined[i].probe, refined[i].at, sent); });
    std::vector<uint32_t> indices(refined.size());
    std::unordered_map<uint32_t, uint32_t> numbers; // of refined texels, by their index
    for (uint32_t i = 0; i < refined.size(); ++i)
    {
        const glm::ivec3 at(refined[i].at);
        numbers[indices[i] = Texels(lit).surfaceIndex(refined[i].probe, at.z, at.x, at.y)] = i;
    }
    std::vector<uint32_t> finer(gpu::kFineWords * refined.size());
    parallelFor(refined.size(),
                [&](size_t i)
                {
                    Texels texels(lit);
                    const FineFilter filter{texels, refined, points, numbers};
                    uint32_t* const own = &finer[gpu::kFineWords * i];
                    own[0] = lit.surfaceLight[indices[i]];
                    for (uint32_t index = 0; index + 1 < gpu::kFineWords; ++index) own[1 + index] = filter.lightOf(refined[i], index);
                });
    for (uint32_t i = 0; i < refined.size(); ++i) lit.surfaceLight[indices[i]] = gpu::kRefinedWord + i;
    lit.surfaceLight.insert(lit.surfaceLight.end() - std::ptrdiff_t(hiddenWords(lit.info)), finer.begin(), finer.end());
    lit.info.refinedTexels = uint32_t(refined.size());
}

} // namespace sconce
