#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"

// A host's own pass, with the installed GLSL and the interface that RayTracer binds.
layout(local_size_x = 64) in;
layout(scalar, set = 1, binding = 0) readonly buffer Rays { Ray rays[]; };
layout(scalar, set = 1, binding = 1) writeonly buffer Hits { RayHit hits[]; };
layout(scalar, push_constant) uniform Push { uint count; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < count) hits[i] = queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
}
