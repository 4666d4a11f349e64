#version 460
#extension GL_GOOGLE_include_directive : require
#include "sconce.glsl"
#include "sconce_frame.glsl" // sconceTermsOf(), for a lighting pass
#if SCONCE_GLSL_VERSION != 1
#error "written for version 1 of sconce.glsl"
#endif

// A host's own pass, with the installed GLSL: rays in, answers out, by address.
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { SconceRay ray[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { SconceRayHit hit[]; };
layout(scalar, push_constant) uniform Push { SconceTraceRaysPush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    SconceRay ray = Rays(push.rays).ray[i];
    Hits(push.hits).hit[i] = sconceQuery(ray.origin, ray.direction, ray.normal);
}
