#include "runtime/field/quality.h"

#include <algorithm>

#include "shaders/shared/sample_pair.h"

namespace sconce
{
namespace
{

// The tracer's own knobs stay at their defaults in every level: fewer ranked probes, hand-offs or a narrower hit rule cost rays and save
// nothing that could be measured. A bounce costs the bake alone: all have all.
// Reflections: where rays begin to pay moves with what a frame may cost (docs/light.md). Diffuse light is read at surfaces: nearer to the
// truth than by rays, and by all levels from as many texels: of 26 boxes that no probe looks at show streaks.
constexpr QualityLevel kLevels[] = {
    {"mobile", 128, knobs::bounces.value, true, {}, 1, 16, 1, 2, true, 0.0f, false, 0.58f, 0.27f, 1.64f},
    {"draft", 128, knobs::bounces.value, false, {}, 1, 4, 2, 2, true, 0.2f, false, 0.65f, 0.40f, 1.40f},
    {"low", 128, knobs::bounces.value, false, {}, 1, 2, 2, 2, true, 0.2f, false, 0.65f, 0.40f, 1.40f},
    {"medium", 256, knobs::bounces.value, false, {}, 1, 1, 2, 8, true, knobs::raysBelow.value, false, 1.00f, 1.00f, 1.00f},
    {"high", 416, knobs::bounces.value, false, {}, 2, 1, 2, 32, true, 0.6f, false, 1.29f, 2.33f, 0.97f},
    {"reference", 512, knobs::bounces.value, false, {}, 8, 1, 2, 32, true, 2.0f, false, 2.84f, 3.44f, 0.92f},
};

constexpr bool inRange(const QualityLevel& level)
{
    return knobs::resolution.inRange(level.resolution) && knobs::bounces.inRange(level.bounces) &&
           knobs::surfaceProbes.inRange(level.surfaceProbes) && knobs::glossyRays.inRange(level.glossyRays) &&
           knobs::traceEvery.inRange(level.traceEvery) && knobs::areaSamples.inRange(level.areaSamples) &&
           knobs::raysBelow.inRange(level.raysBelow);
}
static_assert(std::ranges::all_of(kLevels, inRange));

// Shaders have these for themselves.
static_assert(knobs::ranked.most == gpu::kRanked);
static_assert(knobs::glossyRays.most == 1u << gpu::kSampleBits);

} // namespace

std::span<const QualityLevel> qualityLevels()
{
    return kLevels;
}

const QualityLevel* findQualityLevel(std::string_view name)
{
    const auto found = std::ranges::find(kLevels, name, &QualityLevel::name);
    return found == std::end(kLevels) ? nullptr : found;
}

} // namespace sconce
