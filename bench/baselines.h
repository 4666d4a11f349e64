#pragma once

#include "runtime/pipeline.h"

namespace sconce
{

/// Passes that trace with baseline B0+ (shaders/shared/baseline_b0.h) in place of our tracer, for RayTracer and IndirectLight. The field
/// must be baked with the octahedral chart from probes on a uniform grid.
/// Its rays start this much further off their surface, metres along the normal: without it more than half of all hand-offs are the start
/// surface met again.
inline constexpr float kB0PlusOffset = 0.01f;
Spirv traceRaysB0Plus();
Spirv traceGlossyB0Plus();

} // namespace sconce
