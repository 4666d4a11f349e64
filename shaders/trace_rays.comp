#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"

// World-space rays in, answers out. Dispatch: ceil(count / 64) groups.
layout(local_size_x = kTraceRaysGroup) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { Ray ray[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { RayHit hit[]; };
layout(scalar, push_constant) uniform Push { TraceRaysPush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Ray ray = Rays(push.rays).ray[i];
    Hits(push.hits).hit[i] = sconceQuery(ray.origin, ray.direction, ray.normal);
}
