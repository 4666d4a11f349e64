// What RayTracer tells its pass, trace_rays.comp or a host's own with the same push constants (set 0 is the light field's).
#include "shared/light_field.h"
#ifndef SCONCE_TRACE_RAYS_H
#define SCONCE_TRACE_RAYS_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SconceRays { Ray ray[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer SconceHits { RayHit hit[]; };
#endif
SCONCE_STRUCTS_BEGIN

/// Addresses, not descriptors: each recorded trace has its own, whatever is recorded or in flight beside it.
struct TraceRaysPush
{
    SCONCE_ADDRESS(SconceRays) rays;
    SCONCE_ADDRESS(SconceHits) hits;
    uint count;
    uint unused; // to a multiple of 8
};
SCONCE_CHECK_SIZE(TraceRaysPush, 24);

SCONCE_STRUCTS_END
#endif
