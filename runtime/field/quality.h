#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/knobs.h"
#include "shaders/shared/light_field.h"

namespace sconce
{

/// Every approximate knob of the tracer. Defaults, ranges, units and prices: base/knobs.h.
struct Quality
{
    gpu::TraceQuality trace = {
        .ranked = knobs::ranked.value,               // probes of a leaf that are asked
        .maxHandoffs = knobs::maxHandoffs.value,     // probes a ray may change to before it ends as UNKNOWN
        .startLevel = knobs::startLevel.value,       // level of the Hi-Z chain a ray starts at in a probe. Results don't depend on it
        .coarsestLevel = knobs::coarsestLevel.value, // coarsest level climbed to. Results don't depend on it, reads do
        .tolerance = knobs::tolerance.value,         // scale of the hit rule's thickness; 1 is derived from the texel's footprint
        .epsilon = knobs::epsilon.value,             // absolute slack of the hit rule, share of the scene's diagonal
        .opinion = knobs::opinion.value,     // a hit in a texel larger than this share of the diagonal is asked of a nearer probe; 0: never
        .farBounds = knobs::farBounds.value, // 1: read the far bounds, too, and end early behind them. Fixed in a pass when it is made
        .order = knobs::order.value,         // gpu::kOrder...: whom of a leaf a ray asks first. Fixed in a pass when it is made
        .unused = 0,
    };
};

/// A named choice of every knob but the number of probes, with what it was measured to cost (docs/accuracy.md). A host bakes with the first
/// three (and with radiance, where `tracedDiffuse`), loads its LightField with `quality`, and draws with the rest: `glossyRays` and
/// `raysBelow` are FrameView's, `raysBelow` goes to sconceComposeIndirect(), too, and `areaSamples` is of the command's frames alone.
struct QualityLevel
{
    std::string_view name;  // mobile, draft, low, medium, high, reference
    uint32_t resolution;    // of the bake, texels
    uint32_t bounces;       // of the bake
    bool compact;           // of the bake
    Quality quality;        // of LightField::load
    uint32_t glossyRays;    // a pixel
    uint32_t traceEvery;    // pixels for each that is traced
    uint32_t surfaceProbes; // blended at a look-up
    uint32_t areaSamples;   // a pixel
    bool denoise;
    float raysBelow;    // roughness below which reflections are traced
    bool tracedDiffuse; // diffuse light by rays
    float time, memory,
        error; // of a frame, of the light field, of the picture (FLIP), times those of `medium`; of docs/accuracy.md's table
};

/// From the cheapest to the best.
std::span<const QualityLevel> qualityLevels();
/// Null when there is no such name.
const QualityLevel* findQualityLevel(std::string_view name);

} // namespace sconce
