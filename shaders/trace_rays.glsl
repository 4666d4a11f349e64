// World-space rays in, answers out, by SCONCE_QUERY: a query of the light field, which is included before.
// Dispatch: ceil(count / kTraceRaysGroup) groups; with SCONCE_REFILLS ceil(count / (raysALane kTraceRaysGroup)), and a lane whose ray has ended takes
// the group's next one, by ray_walk.glsl's names (refill.glsl; Aila & Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs", persistent threads).
layout(local_size_x = kTraceRaysGroup) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { Ray ray[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Hits { RayHit hit[]; };
layout(scalar, push_constant) uniform Push { TraceRaysPush push; };

#ifdef SCONCE_REFILLS
#include "refill.glsl"
shared uint nextRay;

void main()
{
    uint first = gl_WorkGroupID.x * push.raysALane * kTraceRaysGroup;
    uint end = min(first + push.raysALane * kTraceRaysGroup, push.count);
    if (gl_LocalInvocationIndex == 0u) nextRay = first + kTraceRaysGroup;
    barrier(); // no ray may be taken before the first that is left is known
    uint i = first + gl_LocalInvocationIndex;
    bool walking = false, begun = false;
    SCONCE_WALK walk;
    while (true) // one loop, so that lanes that begin a ray and lanes amid theirs take turns together
    {
        if (isTimeToTake(!walking) && !walking)
        {
            if (begun)
            {
                Ray ray = Rays(push.rays).ray[i];
                Hits(push.hits).hit[i] = SCONCE_WALK_ANSWER(ray.origin, ray.direction, walk);
                i = atomicAdd(nextRay, 1u);
            }
            if (i >= end) break;
            Ray ray = Rays(push.rays).ray[i];
            walk = SCONCE_WALK_BEGIN(ray.origin, ray.direction, ray.normal);
            walking = begun = true;
        }
        if (walking) walking = !SCONCE_WALK_TURN(walk);
    }
}
#else
void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Ray ray = Rays(push.rays).ray[i];
    Hits(push.hits).hit[i] = SCONCE_QUERY(ray.origin, ray.direction, ray.normal);
}
#endif
