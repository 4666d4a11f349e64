// World-space rays in, answers out, by SCONCE_QUERY: a query of the light field, which is included before.
// Dispatch: ceil(count / kTraceRaysGroup) groups.
layout(local_size_x = kTraceRaysGroup) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { Ray ray[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { RayHit hit[]; };
layout(scalar, push_constant) uniform Push { TraceRaysPush push; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Ray ray = Rays(push.rays).ray[i];
    Hits(push.hits).hit[i] = SCONCE_QUERY(ray.origin, ray.direction, ray.normal);
}
