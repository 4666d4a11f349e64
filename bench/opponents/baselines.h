#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "base/result.h"
#include "runtime/field/field_data.h"
#include "runtime/frame/indirect_light.h"
#include "runtime/vulkan/pipeline.h"
#include "shaders/opponents/baseline.h"

namespace sconce
{

/// The opponents: tracers that the bench runs in place of ours on the same maps, rays and outputs (shaders/opponents/baseline_trace.h).
enum class Baseline : uint32_t
{
    b0 = gpu::kBaselineB0,                     // McGuire et al. 2017 as published
    b0Plus = gpu::kBaselineB0Plus,             // its defects mended
    b0PlusOctree = gpu::kBaselineB0PlusOctree, // the same, probes from the octree's lists
    wang = gpu::kBaselineWang                  // Wang et al. 2019
};
inline constexpr Baseline kBaselines[] = {Baseline::b0, Baseline::b0Plus, Baseline::b0PlusOctree, Baseline::wang};

/// As --tracer spells it: b0, b0plus, b0plus-octree, wang.
std::string_view baselineName(Baseline baseline);
std::optional<Baseline> baselineNamed(std::string_view name);

/// Metres along the normal that an opponent's rays start further off their surface: kFartherStart, without which more than half of all
/// hand-offs are the start surface met again; 0 for b0, whose defect that is.
inline constexpr float kFartherStart = 0.01f;
float baselineOffset(Baseline baseline);

/// Texels a side that a texel of the low-resolution map covers: the published 16 for b0, for the others what is fastest on maps of 256 to
/// 1024 texels a side (bench/results/low_factor.json).
uint32_t bestLowFactor(Baseline baseline);

/// What an opponent reads, made from a baked field: b0 and b0plus want octahedral maps on a grid (b0: of power-of-two counts),
/// b0plus-octree octahedral maps, wang cube faces, from which it makes octahedral maps of the faces' size and their chain
/// (bench/opponents/wang_field.h). A field that lacks it is badInput with a sentence that says how to bake one.
/// @param lowFactor  8, 16 or 32; 0: bestLowFactor
Result<FieldData> baselineField(FieldData field, Baseline baseline, uint32_t lowFactor = 0);

/// Passes with the interface of trace_rays.comp, for makeRayTracer().
RayShaders traceRaysPass(Baseline baseline);

/// Passes for makeIndirectLight(). Grids are lit by the eight corners of a point's cell: b0 by the weights of McGuire et al. 2017, b0plus
/// by those of Majercik et al. 2021; what has lists is lit by them, as ours is.
/// @param lookUpBias  of b0plus, metres along the normal
/// @param lookUpView  times as far towards the viewer
LightShaders lightPasses(Baseline baseline, float lookUpBias = gpu::kLookUpBias, float lookUpView = knobs::lookUpView.value);

/// The same text on the CPU, on all cores. The field is one of baselineField(). Misuse: spans of different length assert.
void traceBaselineOnCpu(const FieldData& field, Baseline baseline, std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits);

} // namespace sconce
