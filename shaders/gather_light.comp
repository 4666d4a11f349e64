#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#define SCONCE_TILE_CONSTANT 2
#include "tiles.glsl"

// Light that needs no ray, from the pixel's ranked probes weighted by visibility: diffuse by their prefiltered irradiance, rough reflections
// by their prefiltered radiance. The leaf is looked up at points dithered by a voxel, so that no border of a voxel shows.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 5) const uint kList = kListGathered;
layout(constant_id = 3) const bool kDiffuse = true; // make the diffuse light
layout(constant_id = 4) const bool kRough = true;   // make the rough reflections
layout(constant_id = 6) const bool kByPatches = false; // diffuse light from one probe's patches
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo)
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D rough;   // rgb: radiance reflected to the eye
layout(scalar, set = 1, binding = 6) readonly buffer EnvironmentBrdf { vec2 environmentBrdf[]; }; // runtime/environment_brdf.h

const uint kLookUps = 4u; // dithered look-ups a pixel

/// Bilinear: scale and bias of the reflectance at normal incidence.
vec2 reflectedShare(float cosine, float alpha)
{
    const int n = int(kEnvironmentBrdfSide);
    vec2 at = clamp(vec2(cosine, sqrt(alpha)), 0.0, 1.0) * float(n - 1);
    ivec2 low = min(ivec2(at), n - 2);
    vec2 f = at - vec2(low);
    int i = low.y * n + low.x;
    return mix(mix(environmentBrdf[i], environmentBrdf[i + 1], f.x), mix(environmentBrdf[i + n], environmentBrdf[i + n + 1], f.x), f.y);
}

void main()
{
    ivec2 at;
    if (!findPixel(kList, at)) return;
    Pixel p = readPixel(at);
    uint terms = termsOf(p);
    bool wantDiffuse = kDiffuse && !isNotOf(kTermDiffuse, terms), wantRough = kRough && !isNotOf(kTermRough, terms);
    if (!p.surface || !(wantDiffuse || wantRough)) return;
    vec3 point = (p.position - field.origin) / field.scale;
    TangentFrame tangents = tangentFrame(p.normal);
    float alpha = ggxAlpha(p.brdf.roughness);
    Lobe lobe = reflectedLobe(p.normal, p.view, alpha);

    // The weight of a probe doesn't depend on the look-up that named it: each is asked once, and counted as often as it was named.
    uint named[kLookUps * kRanked];
    float times[kLookUps * kRanked]; // and then their weights
    uint count = 0u;
    for (uint i = 0u; i < kLookUps; ++i)
    {
        vec2 along = (randomPair(uvec2(at), i, 1u, frame.seed) - 0.5) * 2.0 * field.voxel;
        int reads = 0;
        uvec4 ranked = rankedProbesAt(point + along.x * tangents.tangent + along.y * tangents.bitangent + 0.5 * field.voxel * p.normal, reads);
        for (uint k = 0u; k < uint(kRanked); ++k)
        {
            bool repeated = false;
            for (uint j = 0u; j < k; ++j) repeated = repeated || ranked[j] == ranked[k];
            if (repeated) continue;
            uint found = 0u;
            while (found < count && named[found] != ranked[k]) ++found;
            if (found == count) named[count] = ranked[k], times[count++] = 0.0;
            times[found] += 1.0;
        }
    }
    if (!canGather(point, p.normal)) count = 0u;
    vec3 arriving = vec3(0.0);
    float weights = 1e-30, met = 0.0; // how far off the lobe's axis meets the nearest surface that a probe sees there
    for (uint i = 0u; i < count; ++i)
    {
        times[i] *= weightOfProbe(named[i], point, p.normal);
        weights += times[i];
        if (wantDiffuse && !kByPatches) arriving += times[i] * probeIrradiance(named[i], p.normal);
        float seen = wantRough ? seenAlong(named[i], point - probeHeader(named[i]).centre, lobe.direction) : 0.0;
        if (seen > 0.0) met = met > 0.0 ? min(met, seen) : seen;
    }
    if (wantDiffuse && kByPatches && count > 0u)
    {
        // One probe, drawn by its say; the filter blends what neighbours drew.
        float left = randomPair(uvec2(at), 0u, 5u, frame.seed).x * (weights - 1e-30);
        uint drawn = 0u;
        while (drawn + 1u < count && left >= times[drawn]) left -= times[drawn++];
        arriving = weights * patchIrradiance(named[drawn], point - probeHeader(named[drawn]).centre, p.normal);
    }
    if (wantDiffuse) imageStore(diffuse, at, vec4(arriving / weights, 1.0));
    if (!wantRough) return;
    vec3 inLobe = vec3(0.0);
    for (uint i = 0u; i < count; ++i)
    {
        vec3 fromProbe = point - probeHeader(named[i]).centre;
        inLobe += times[i] * lobeRadiance(named[i], fromProbe, lobe, met > 0.0 ? met : guessedAlong(named[i], fromProbe, lobe.direction));
    }
    vec2 share = reflectedShare(dot(p.normal, p.view), alpha);
    imageStore(rough, at, vec4(inLobe / weights * (reflectanceAtNormal(p.brdf) * share.x + share.y), 1.0));
}
