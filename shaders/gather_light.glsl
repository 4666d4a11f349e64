// Light that needs no ray, from the pixel's probes weighted by visibility: diffuse by their prefiltered irradiance, rough reflections by their
// prefiltered radiance. Which probes, their weights and what they hold: candidatesAt(), nextCandidate(), candidateLight() and blendedLight(), which
// are defined before.
// Dispatch: see lookups.glsl.
layout(local_size_x = 64) in;
layout(constant_id = kGatherDiffuseId) const bool kDiffuse = true; // make the diffuse light
layout(constant_id = kGatherRoughId) const bool kRough = true;   // make the rough reflections
layout(constant_id = kByPatchesId) const bool kByPatches = false; // diffuse light from one probe's patches
layout(constant_id = kBySurfaceId) const bool kBySurface = false; // `diffuse` has been made, from surface light
layout(set = 1, binding = kGatherDiffuseBinding, rgba16f) uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo)
layout(set = 1, binding = kGatherRoughBinding, rgba16f) writeonly uniform image2D rough;   // rgb: radiance reflected to the eye

/// The probes with the largest weights, in order, and the largest weight of the others.
struct Heaviest
{
    uvec4 probe;
    vec4 weight;
    float next;
};
const int kRoughProbes = 2; // that a rough reflection asks; at most 4
const float kWidestLobe = 0.8;      // radians: as reflectedLobe()'s
const float kMostOfSurface = 2.0;

void weigh(inout Heaviest h, uint probe, float weight)
{
    bvec4 after = greaterThan(vec4(weight), h.weight); // the places from which on all move
    vec4 moved = vec4(weight, h.weight.xyz);
    uvec4 movedProbe = uvec4(probe, h.probe.xyz);
    h.next = max(h.next, min(weight, h.weight[kRoughProbes - 1]));
    bvec4 here = bvec4(after.x, after.y && !after.x, after.z && !after.y, after.w && !after.z);
    h.weight = mix(mix(h.weight, moved, after), vec4(weight), here);
    h.probe = uvec4(here.x ? probe : after.x ? movedProbe.x : h.probe.x, here.y ? probe : after.y ? movedProbe.y : h.probe.y,
                    here.z ? probe : after.z ? movedProbe.z : h.probe.z, here.w ? probe : after.w ? movedProbe.w : h.probe.w);
}

/// What a probe's light is to be scaled by, for shadows and near surfaces that it doesn't know: by the light at the surface over what the probe has
/// for it, as Lazarov 2013, "Getting More Physical in Call of Duty: Black Ops II", scales environment maps by lightmaps.
/// @param above  what the probes have in the hemisphere above it
vec3 shareOfSurface(vec3 own, vec3 above)
{
    return min(own / max(above, vec3(1e-20)), vec3(kMostOfSurface));
}

/// Radiance that arrives in a lobe from the two probes with the most say; with surface light also what they have in the hemisphere above.
struct InLobe
{
    vec3 radiance;
    vec3 above;
};

InLobe radianceInLobe(Heaviest heaviest, vec3 point, vec3 normal, Lobe lobe)
{
    float met = 0.0; // how far off the lobe's axis meets the nearest surface that a probe sees there
    for (int i = 0; i < kRoughProbes; ++i)
    {
        if (heaviest.weight[i] <= 0.0) continue;
        float seen = seenAlong(heaviest.probe[i], point - probeHeader(heaviest.probe[i]).centre, lobe.direction);
        if (seen > 0.0) met = met > 0.0 ? min(met, seen) : seen;
    }
    InLobe sum = InLobe(vec3(0.0), vec3(0.0));
    float weights = 1e-30;
    for (int i = 0; i < kRoughProbes; ++i)
    {
        if (heaviest.weight[i] <= 0.0) continue;
        float weight = heaviest.weight[i] - 0.999 * heaviest.next; // so that one that leaves the list has no say before
        vec3 fromProbe = point - probeHeader(heaviest.probe[i]).centre;
        sum.radiance += weight * lobeRadiance(heaviest.probe[i], fromProbe, lobe, met > 0.0 ? met : guessedAlong(heaviest.probe[i], fromProbe, lobe.direction));
        if (kBySurface)
            sum.above += weight * lobeRadiance(heaviest.probe[i], fromProbe, Lobe(normal, kWidestLobe), guessedAlong(heaviest.probe[i], fromProbe, normal));
        weights += weight;
    }
    return InLobe(sum.radiance / weights, sum.above / weights);
}

void main()
{
    LookUp lookUp;
    if (!findLookUp(lookUp)) return;
    Pixel p = readLookUp(lookUp);
    uint terms = termsOf(p);
    bool wantDiffuse = kDiffuse && !isNotOf(kTermDiffuse, terms), wantRough = kRough && !isNotOf(kTermRough, terms);
    if (!p.surface || !(wantDiffuse || wantRough)) return;
    vec3 point = (p.position - field.origin) / field.scale;
    Candidates candidates = candidatesAt(lookUp.at, p, point, tangentFrame(p.normal));
    vec3 arriving = vec3(0.0);
    float weights = 1e-30;
    Heaviest heaviest = Heaviest(uvec4(0u), vec4(0.0), 0.0);
    uint drawn = kNoProbe;
    float lot = pairOfFrame(uvec2(lookUp.at), frame.seed, 1u, 0u, 5u).x;
    uint probe;
    float say;
    while (nextCandidate(candidates, probe, say))
    {
        weights += say;
        if (wantDiffuse && !kByPatches) arriving += say * candidateLight(probe, p.normal);
        if (wantRough) weigh(heaviest, probe, say);
        float share = say / weights;
        if (lot < share) drawn = probe, lot /= share;
        else lot = (lot - share) / (1.0 - share);
    }
    // One probe's patches, drawn by its say; the filter blends what neighbours drew.
    if (wantDiffuse && kByPatches && drawn != kNoProbe)
        arriving = weights * patchIrradiance(drawn, point - probeHeader(drawn).centre, p.normal);
    if (wantDiffuse)
        for (int i = 0; i < lookUp.pixels; ++i)
            imageStore(diffuse, pixelOf(lookUp, i), storedLight(vec4(kByPatches ? arriving / weights : blendedLight(arriving / weights), 1.0)));
    if (!wantRough) return;
    InLobe inLobe = radianceInLobe(heaviest, point, p.normal, reflectedLobe(p.normal, p.view, ggxAlpha(p.brdf.roughness)));
    for (int i = 0; i < lookUp.pixels; ++i)
    {
        ivec2 at = pixelOf(lookUp, i);
        Pixel own = readPixel(at);
        vec3 share = kBySurface ? shareOfSurface(imageLoad(diffuse, at).rgb, inLobe.above) : vec3(1.0);
        // The lobe's mean radiance times what it reflects of white light (Karis 2013, "Real Shading in Unreal Engine 4").
        imageStore(rough, at, storedLight(vec4(inLobe.radiance * share * specularColor(lobesAt(own.brdf, dot(own.normal, own.view))), 1.0)));
    }
}
