// The rays that gather light at a place: their directions and what they ended at. All places draw the same numbers, so that the order of probes
// changes nothing, and what a ray brought can be asked for its direction later.
#include "shared/bake_passes.h"
#include "shared/brdf.h"
#include "shared/sample_pair.h"

const uint kGatherStream = 6u;

/// Of a pair of numbers for the i-th ray; beyond the samples of one sequence others follow.
vec2 pairOfRay(uvec2 pixel, uint i, uint stream)
{
    return randomPair(pixel, i & ((1u << kSampleBits) - 1u), stream, 2654435769u * (i >> kSampleBits));
}

/// Weighted by the cosine about the tangents' normal.
vec3 gatherDirection(TangentFrame tangents, uvec2 pixel, uint i)
{
    return normalize(toWorld(tangents, sampleCosine(pairOfRay(pixel, i, kGatherStream))));
}

/// What a ray's radiance adds to a tilt: the slope of the direction along the plane.
vec3 slopeOf(vec3 direction, vec3 normal)
{
    float cosine = dot(direction, normal);
    return (direction - cosine * normal) / max(cosine, 1.0 / kMostSlope);
}

/// How many rays ended somewhere, at surfaces, and at surfaces whose light is known.
struct Ends
{
    float all, surfaces, known;
};

/// @return  whether the link is a texel, whose light is known
bool countEnd(inout Ends ends, uint link)
{
    if (link == kLinkNone) return false;
    ends.all += 1.0;
    if (link == kLinkSky) return false;
    ends.surfaces += 1.0;
    if (link == kLinkSurface) return false;
    ends.known += 1.0;
    return true;
}

/// Of a sum over the known surfaces the share of all rays: surfaces whose light isn't known send what the others send.
float perRay(Ends ends) { return ends.surfaces / (max(ends.known, 1.0) * max(ends.all, 1.0)); }
