#pragma once

#include "runtime/pipeline.h"

namespace sconce
{

/// Passes that trace with baseline B0+ (shaders/shared/baseline_b0.h) in place of our tracer, for RayTracer and IndirectLight. The field
/// must be baked with the octahedral chart from probes on a uniform grid.
Spirv traceRaysB0Plus();
Spirv traceGlossyB0Plus();

} // namespace sconce
