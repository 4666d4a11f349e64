#pragma once

#include "shaders/shared/light_field.h"

namespace sconce
{

/// Every approximate knob of the tracer, with its default, range and unit.
struct Quality
{
    gpu::TraceQuality trace = {
        .ranked = 4,        // probes of a leaf that are asked, 1..4
        .maxHandoffs = 24,  // probes a ray may change to before it ends as UNKNOWN, 0..64
        .startLevel = 4,    // level of the Hi-Z chain a ray starts at in a probe; even, 0..6. Results don't depend on it, reads do
        .coarsestLevel = 6, // coarsest level climbed to; even, 0..6. Results don't depend on it, reads do
        .tolerance = 1.0f,  // scale of the hit rule's thickness, 0.25..4; 1 is derived from the texel's footprint
        .epsilon = 1e-4f,   // absolute slack of the hit rule, share of the scene's diagonal, 0..1e-2
        .opinion = 2e-3f,   // a hit in a texel larger than this share of the diagonal is asked of a nearer probe, 0..1; 0: never
        .farBounds = 0,     // 1: read the far bounds, too, and end early behind them; the same results. Fixed in a pass when it is made
    };
};

} // namespace sconce
