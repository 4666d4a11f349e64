#include "bench/opponents/baselines.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/opponents/baseline_cpu.h"
#include "bench/opponents/wang_field.h"
#include "runtime/field/quality.h"
#include "spirv/gather_light_2017.h"
#include "spirv/gather_light_2021.h"
#include "spirv/trace_glossy_b0.h"
#include "spirv/trace_glossy_b0plus.h"
#include "spirv/trace_glossy_b0plus_octree.h"
#include "spirv/trace_glossy_wang.h"
#include "spirv/trace_rays_b0.h"
#include "spirv/trace_rays_b0plus.h"
#include "spirv/trace_rays_b0plus_octree.h"
#include "spirv/trace_rays_b0plus_octree_refilled.h"
#include "spirv/trace_rays_b0plus_refilled.h"
#include "spirv/trace_rays_wang.h"
#include "spirv/trace_rays_wang_refilled.h"

namespace sconce
{
namespace
{

struct Entry // of the table, in the order of the numbers
{
    std::string_view name;
    RayShaders rays;
    LightShaders light;
};

const Entry& entryOf(Baseline baseline)
{
    static const Entry table[] = {
        {"b0", {trace_rays_b0, {}}, {trace_glossy_b0, gather_light_2017}},
        {"b0plus", {trace_rays_b0plus, trace_rays_b0plus_refilled}, {trace_glossy_b0plus, gather_light_2021}},
        {"b0plus-octree", {trace_rays_b0plus_octree, trace_rays_b0plus_octree_refilled}, {trace_glossy_b0plus_octree, {}}},
        {"wang", {trace_rays_wang, trace_rays_wang_refilled}, {trace_glossy_wang, {}}}};
    return table[uint32_t(baseline)];
}

std::string whatIsMissing(const FieldData& field, Baseline baseline)
{
    const gpu::LightFieldInfo& info = field.info;
    if (info.probeCount == 0) return "has no probes; place some and bake it again";
    const bool octahedral = info.chart == gpu::kChartOctahedral;
    if (baseline == Baseline::wang)
        return octahedral
                   ? "has octahedral maps, and tracer wang makes its own from cube faces; bake with --chart cube at twice the resolution"
                   : "";
    const std::string tracer(baselineName(baseline));
    if (!octahedral) return fmt::format("has cube faces, and tracer {} reads octahedral maps; bake with --chart octahedral", tracer);
    if (baseline == Baseline::b0PlusOctree)
        return field.octree.texels.empty() ? fmt::format("has no octree, where tracer {} finds its probes; bake it again", tracer) : "";
    if (info.gridX == 0)
        return fmt::format("is not a grid of probes, and tracer {} needs one; place with --method grid and bake it again", tracer);
    if (baseline == Baseline::b0 &&
        !(std::has_single_bit(info.gridX) && std::has_single_bit(info.gridY) && std::has_single_bit(info.gridZ)))
        return fmt::format("is a grid of {}x{}x{} probes, and tracer b0 wraps their indices: place with --method grid and --grid of powers "
                           "of two, and bake it again",
                           info.gridX, info.gridY, info.gridZ);
    return "";
}

/// Replaces the low-resolution map of every probe by one over `factor` texels a side, (minimum, maximum) of r; halves compare as their
/// bits do.
void setLowFactor(FieldData& field, uint32_t factor)
{
    const uint32_t size = field.info.faceSize, width = size / factor, texels = size * size;
    const uint32_t oldWords = field.info.wordsPerProbe, newWords = texels + width * width;
    std::vector<uint32_t> words(size_t(newWords) * field.info.probeCount);
    parallelFor(field.info.probeCount,
                [&](size_t probe)
                {
                    const uint32_t* from = field.distance.data() + probe * oldWords;
                    uint32_t* to = words.data() + probe * newWords;
                    std::copy(from, from + texels, to);
                    std::fill(to + texels, to + newWords, 0xffffu);
                    for (uint32_t i = 0; i < texels; ++i)
                    {
                        uint32_t& bounds = to[texels + (i / size / factor) * width + i % size / factor];
                        const uint32_t r = from[i] & 0xffffu;
                        bounds = std::min(bounds & 0xffffu, r) | (std::max(bounds >> 16, r) << 16);
                    }
                });
    field.distance = std::move(words);
    field.info.wordsPerProbe = newWords;
    field.info.topLevel = uint32_t(std::countr_zero(factor));
}

template <uint32_t kind> void traceAll(const FieldData& field, std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits)
{
    constexpr size_t kBatch = 256;
    parallelFor((rays.size() + kBatch - 1) / kBatch,
                [&](size_t batch)
                {
                    twin::BaselineTwin<float, kind> text(field, Quality{}.trace);
                    for (size_t i = batch * kBatch; i < std::min(rays.size(), (batch + 1) * kBatch); ++i)
                        hits[i] = text.baselineQuery(rays[i].origin, rays[i].direction);
                });
}

} // namespace

std::string_view baselineName(Baseline baseline)
{
    return entryOf(baseline).name;
}

std::optional<Baseline> baselineNamed(std::string_view name)
{
    for (Baseline baseline : kBaselines)
        if (baselineName(baseline) == name) return baseline;
    return {};
}

float baselineOffset(Baseline baseline)
{
    return baseline == Baseline::b0 ? 0.0f : kFartherStart;
}

uint32_t bestLowFactor(Baseline baseline)
{
    return baseline == Baseline::b0 ? 16 : 8;
}

Result<FieldData> baselineField(FieldData field, Baseline baseline, uint32_t lowFactor)
{
    if (const std::string missing = whatIsMissing(field, baseline); !missing.empty())
        return Error{ErrorCode::badInput, fmt::format("The light field of scene '{}' {}.", field.sceneName, missing)};
    if (baseline == Baseline::wang) return wangField(field);
    const uint32_t factor = lowFactor ? lowFactor : bestLowFactor(baseline);
    if (!std::has_single_bit(factor) || field.info.faceSize % factor != 0)
        return Error{ErrorCode::badArgument,
                     fmt::format("A low factor of {} does not divide maps of {} texels; give 8, 16 or 32", factor, field.info.faceSize)};
    setLowFactor(field, factor);
    if (baseline != Baseline::b0PlusOctree) field.octree = {}; // a grid finds its probes by a formula, and doesn't pay for an index
    return field;
}

RayShaders traceRaysPass(Baseline baseline)
{
    return entryOf(baseline).rays;
}

LightShaders lightPasses(Baseline baseline, float lookUpBias, float lookUpView)
{
    LightShaders passes = entryOf(baseline).light;
    if (baseline == Baseline::b0Plus)
        passes.constants = {{gpu::kGridBiasId, std::bit_cast<uint32_t>(lookUpBias)},
                            {gpu::kGridBiasViewId, std::bit_cast<uint32_t>(lookUpBias * lookUpView)}};
    return passes;
}

void traceBaselineOnCpu(const FieldData& field, Baseline baseline, std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits)
{
    assert(rays.size() == hits.size());
    switch (baseline)
    {
    case Baseline::b0:
        return traceAll<gpu::kBaselineB0>(field, rays, hits);
    case Baseline::b0Plus:
        return traceAll<gpu::kBaselineB0Plus>(field, rays, hits);
    case Baseline::b0PlusOctree:
        return traceAll<gpu::kBaselineB0PlusOctree>(field, rays, hits);
    case Baseline::wang:
        return traceAll<gpu::kBaselineWang>(field, rays, hits);
    }
}

} // namespace sconce
