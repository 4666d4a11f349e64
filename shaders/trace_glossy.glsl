#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "sparse.glsl"
#include "moving_shapes.glsl"
#include "lamps.glsl"
#include "screen_trace.glsl"

// Light by traced rays, by SCONCE_QUERY: a query of the light field, which is included before. kTermGlossy: GGX visible-normal rays; kTermMirror: the one mirrored ray; kTermDiffuse: cosine-weighted rays, whose
// mean radiance has emitters and sky in it, with soft shadows at a cost that doesn't know their number. Dispatch: see findPixel, or sparseRuns; of each 2^kEveryLog
// tiles one workgroup finds the pixels to trace, and its invocations share them out, so that none idles beside a pixel that is left out.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(constant_id = kCountId) const bool kCount = true; // write the counts
layout(constant_id = kUntintedId) const bool kUntinted = false; // reflections are stored before the surface's tint, for filters
layout(constant_id = kMovingId) const bool kMoving = false; // rays meet shapes that move
layout(constant_id = kScreenId) const bool kScreen = false; // and what the picture shows
layout(set = 1, binding = kTraceLightBinding, rgba16f) writeonly uniform image2D reflected; // rgb: radiance reflected to the eye, of diffuse rays that arrives; a: mean hit distance, metres
layout(set = 1, binding = kTraceCountsBinding, rgba32ui) writeonly uniform uimage2D counts;  // probe of the last ray, hand-offs, reads, unknown rays

shared uint chosenCount;
shared uint chosen[64u << kEveryLog]; // x | y << 16

/// A ray of a pixel, and what its light counts; all 0 where it would go below the surface.
struct Sample
{
    vec3 direction; // world, unit
    vec3 weight;
};

Sample sampleOf(ivec2 at, Pixel p, TangentFrame tangents, uint ray)
{
    if (kTerm == kTermDiffuse)
        return Sample(normalize(toWorld(tangents, sampleCosine(pairOfFrame(uvec2(at), frame.seed, frame.glossyRays, ray, 4u)))), vec3(1.0));
    vec3 view = toTangent(tangents, p.view);
    view.z = max(view.z, 1e-4); // a shading normal may turn away from the eye
    const bool mirror = kTerm == kTermMirror;
    float alpha = ggxAlpha(p.brdf.roughness);
    BrdfLobes lobes = lobesAt(p.brdf, view.z);
    vec3 halfway = mirror ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(normalize(view), alpha, pairOfFrame(uvec2(at), frame.seed, frame.glossyRays, ray, 0u));
    vec3 direction = reflect(-view, halfway);
    if (direction.z <= 0.0) return Sample(vec3(0.0), vec3(0.0));
    vec3 color = lobes.atNormal + lobes.atEdge * schlick(dot(view, halfway));
    // weight of a visible-normal sample: colour G2 / G1 (Heitz 2018)
    float weight = mirror ? 1.0 : 4.0 * view.z * direction.z * smithVisibility(direction.z, view.z, alpha) / max(smithMasking(view.z, alpha), 1e-6);
    return Sample(normalize(toWorld(tangents, direction)), color * weight);
}

void trace(ivec2 at, Pixel p, uint terms)
{
    vec4 result = vec4(0.0);
    uvec4 count = uvec4(kNoProbe, 0u, 0u, 0u); // probe, hand-offs, distance + index reads, unknown rays
    TangentFrame tangents = tangentFrame(p.normal);
    uint rays = kTerm == kTermMirror ? 1u : frame.glossyRays;
    for (uint i = 0u; i < rays; ++i)
    {
        Sample s = sampleOf(at, p, tangents, i);
        if (s.direction == vec3(0.0)) continue;
        // The one place that asks: compilers write the whole tracer out for each.
        vec3 origin = p.position + frame.normalOffset * p.normal;
        RayHit hit = SCONCE_QUERY(origin, s.direction, p.normal);
        if (kMoving) meetShapes(origin, s.direction, p.normal, hit);
        if (kScreen) meetScreen(origin, s.direction, hit);
        result += vec4(s.weight * hit.radiance, hit.t);
        count.x = hit.probe;
        count.y += uint(hit.handoffs);
        count.z += uint(hit.distanceReads + hit.indexReads);
        count.w += hit.status == kUnknown ? 1u : 0u;
    }
    if (kUntinted) result.rgb /= tintOf(p);
    imageStore(reflected, at, storedLight(result / float(rays)));
    if (kTerm != kTermDiffuse && kCount && (terms & (1u << kTerm)) != 0u) imageStore(counts, at, count);
}

void traceChosen()
{
    if (gl_LocalInvocationIndex == 0u) chosenCount = 0u;
    barrier(); // no pixel may be counted before the count is cleared
    uint first = workgroupIndex() << kEveryLog, last = min(first + (1u << kEveryLog), tileCount(kTerm));
    for (uint tile = first; tile < last; ++tile)
    {
        ivec2 at = tileOrigin(kTerm, tile) + ivec2(gl_LocalInvocationID.xy);
        if (any(greaterThanEqual(at, ivec2(frame.size)))) continue;
        Pixel p = readPixel(at);
        if ((termsOf(p) & (1u << kTerm)) == 0u) continue;
        if (isTraced(p, at, kTerm))
            chosen[atomicAdd(chosenCount, 1u)] = uint(at.x) | (uint(at.y) << 16);
        else
            imageStore(reflected, at, vec4(0.0, 0.0, 0.0, kNotTraced));
    }
    barrier(); // the pixels are dealt out anew, so that all of them must be in the list
    for (uint i = gl_LocalInvocationIndex; i < chosenCount; i += 64u)
    {
        ivec2 at = ivec2(chosen[i] & 0xffffu, chosen[i] >> 16);
        Pixel p = readPixel(at);
        trace(at, p, termsOf(p));
    }
}

void main()
{
    if (kEveryLog > 0u)
    {
        traceChosen();
        return;
    }
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    Pixel p = readPixel(at);
    uint terms = termsOf(p);
    if (p.surface && !isNotOf(kTerm, terms)) trace(at, p, terms);
}
