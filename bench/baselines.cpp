#include "bench/baselines.h"

#include "spirv/trace_glossy_b0plus.h"
#include "spirv/trace_rays_b0plus.h"

namespace sconce
{

Spirv traceRaysB0Plus()
{
    return trace_rays_b0plus;
}
Spirv traceGlossyB0Plus()
{
    return trace_glossy_b0plus;
}

} // namespace sconce
