// How light is gathered at a place: what its rays end at, and what comes straight from emitters. Shared text, see probe_trace.h: the device's rays go
// through the light field, the host's to the scene's triangles. Needs besides surface_light.h and gathered_rays.h:
//   gatherRays(), shadowRays()                  how many of either
//   endOfRay(point, direction, plane, lots, t, emitted)  the link of a ray's end, its length, and what an emitter that it meets sends where it is near:
//                                               see isNearPatch(); lots: two even random numbers
//   keepLink(i, link)                           of the i-th ray
//   emitterReaches(point, toLight, distance, plane)
//   isNearPatch(d2, area)                       whether a patch of an emitter is left to the rays that meet it: so near, it is no longer small
//   discOf(area)                                of patchAttenuation()
//   lights[i], lightsHeader                     the list of lights
SCONCE_CONST uint kShadowStream = 7u;
SCONCE_CONST uint kLinkStream = 8u;

struct EmitterSample
{
    vec3 toLight; // unit
    vec3 irradiance;
    real distance;
    real cosine; // at the surface, times what is taken of light along it; 0 behind its plane
};

/// @param from    a patch's place; `facing`: its normal, outward; `area` and `oneSided`: as GpuLight has them
SCONCE_FN EmitterSample sampleOfPatch(vec3 from, vec3 facing, vec3 radiance, real area, bool oneSided, vec3 point, vec3 normal, vec3 plane, real grazing)
{
    EmitterSample s;
    vec3 away = from - point;
    real d2 = max(dot(away, away), real(1e-14));
    s.distance = sqrt(d2);
    s.toLight = away / s.distance;
    s.irradiance = radiance * patchAttenuation(-dot(s.toLight, facing), d2, area, discOf(area), oneSided);
    s.cosine = dot(plane, s.toLight) > real(0.0) && !isNearPatch(d2, area) ? max(dot(normal, s.toLight), real(0.0)) : real(0.0);
    s.cosine *= takenAlong(s.cosine, grazing);
    return s;
}

SCONCE_FN EmitterSample emitterSampleAt(uint i, vec3 point, vec3 normal, vec3 plane, real grazing)
{
    return sampleOfPatch(vec3(lights[i].position), vec3(lights[i].direction), vec3(lights[i].intensity), real(lights[i].area), lights[i].innerCone > 0.0f,
                         point, normal, plane, grazing);
}

/// What a sample would give unshadowed, to draw by.
SCONCE_FN real weightOf(SCONCE_IN(EmitterSample) s) { return s.cosine * luminance(s.irradiance); }

#ifndef __cplusplus
/// Sum of the weights of all patches; `passedBy`: of those up to one and with it, from the sum before. The host keeps them from one to the other.
real weighEmitters(vec3 point, vec3 normal, vec3 plane, real grazing)
{
    real total = 0.0;
    for (uint i = 0; i < lightsHeader.emitterCount; ++i) total += weightOf(emitterSampleAt(lightsHeader.deltaCount + i, point, normal, plane, grazing));
    return total;
}
real passedBy(uint i, real before, vec3 point, vec3 normal, vec3 plane, real grazing)
{
    return before + weightOf(emitterSampleAt(i, point, normal, plane, grazing));
}
#endif

struct Gathered
{
    vec3 light;    // mean radiance straight from emitters and sky
    vec3 emitters; // of it, from emitters
    real variance; // of its luminance, by chance
    vec3 tilt;     // moment of its luminance along the plane
    Ends ends;     // where the rays ended
    real asked;    // rays that went out
    real room;     // harmonic mean of their lengths, field units
    real reach;    // of those that end at a surface: next to a place the sky is the same
};

/// Adds the mean over the hemisphere of the radiance that comes straight from emitters: shadow rays to samples drawn by how much they would give
/// unshadowed (resampled importance sampling, Talbot et al. 2005), systematically along the list.
SCONCE_FN void addEmitters(SCONCE_INOUT(Gathered) to, vec3 point, vec3 normal, vec3 plane, uvec2 pixel, real grazing)
{
    uint begin = lightsHeader.deltaCount;
    uint end = begin + lightsHeader.emitterCount;
    real total = weighEmitters(point, normal, plane, grazing);
    if (!(total > real(0.0))) return;
    uint drawn[kMostShadowRays];
    uint count = 0u;
    real each = total / real(shadowRays());
    real next = randomPair(pixel, 0u, kShadowStream, 0u).x * each;
    real passed = real(0.0);
    for (uint i = begin; i < end; ++i)
    {
        passed = passedBy(i, passed, point, normal, plane, grazing);
        for (; passed > next && count < shadowRays(); next += each) drawn[count++] = i;
    }
    vec3 sum = vec3(real(0.0));
    vec3 tilt = vec3(real(0.0));
    uint before = kNoProbe;
    bool reached = false;
    real arrived = real(0.0);
    for (uint k = 0u; k < count; ++k)
    {
        uint i = drawn[k];
        EmitterSample s = emitterSampleAt(i, point, normal, plane, grazing);
        if (i != before) reached = emitterReaches(point, s.toLight, s.distance, plane);
        before = i;
        if (!reached) continue;
        arrived += real(1.0);
        sum += s.irradiance / max(luminance(s.irradiance), real(1e-30));
        tilt += slopeOf(s.toLight, normal);
    }
    to.emitters += sum * (each / kBrdfPi);
    to.tilt += tilt * (each / kBrdfPi);
    to.variance += total * total / (kBrdfPi * kBrdfPi) * varianceOfShare(arrived, real(count));
}

/// What a texel gets straight from emitters and sky, and where its other light comes from: of rays that leave the scene the sky's light, of the others
/// the texel where each ended, kept by keepLink(i, link), so that bounces need no ray.
/// @param plane    unit normal of the surface; `normal`: that light is gathered about
/// @param grazing  of the surface, see takenAlong(); 0, and a metal's lean: light counts alike from all sides
SCONCE_FN Gathered gatherAt(vec3 point, vec3 normal, vec3 plane, uvec2 pixel, real grazing)
{
    TangentFrame tangents = tangentFrame(normal);
    vec3 slopes = vec3(real(0.0));
    real nearness = real(0.0);
    real ended = real(0.0); // rays, at a surface
    real sky = real(0.0);
    vec3 emitted = vec3(real(0.0));
    real squares = real(0.0);
    Gathered got;
    got.ends.all = real(0.0);
    got.ends.surfaces = real(0.0);
    got.ends.known = real(0.0);
    got.asked = real(0.0);
    for (uint i = 0u; i < gatherRays(); ++i)
    {
        vec3 direction = gatherDirection(tangents, pixel, i, grazing);
        uint link = kLinkDark; // below the surface
        got.asked += real(1.0);
        if (dot(direction, plane) > real(0.0))
        {
            real t;
            vec3 met;
            // Another sample's numbers: the same one's would be the direction's, shifted, and what a ray ends at must not hang on where it goes.
            link = endOfRay(point, direction, plane, pairOfRay(pixel, 29u * i + 17u, kLinkStream), t, met);
            if (link != kLinkSky)
            {
                nearness += real(1.0) / max(t, real(1e-6));
                ended += real(1.0);
            }
            real luminous = luminance(met);
            emitted += met;
            squares += luminous * luminous;
            slopes += luminous * slopeOf(direction, normal);
        }
        keepLink(i, link);
        countEnd(got.ends, link);
        if (link != kLinkSky) continue;
        sky += real(1.0);
        slopes += luminance(vec3(field.sky)) * slopeOf(direction, normal);
    }
    real rays = max(got.ends.all, real(1.0));
    real luminousSky = luminance(vec3(field.sky));
    real near = luminance(emitted) / rays;
    got.emitters = emitted / rays;
    got.variance = max(squares / rays - near * near, real(0.0)) / rays;
    if (luminousSky > real(0.0)) got.variance += luminousSky * luminousSky * varianceOfShare(sky, got.ends.all);
    got.tilt = slopes / rays;
    got.room = real(gatherRays()) / max(nearness, real(1e-6));
    got.reach = max(ended, real(1.0)) / max(nearness, real(1e-6));
    if (lightsHeader.emitterCount > 0u) addEmitters(got, point, normal, plane, pixel, max(grazing, real(0.0)));
    got.light = vec3(field.sky) * (sky / rays) + got.emitters;
    return got;
}

SCONCE_CONST int kPlacesTried = 32;
SCONCE_CONST real kLeastClearance = real(0.5); // finest voxels to the surfaces that the probe sees about the place

/// A place in a cell that a probe of its leaf sees, the nearest to nothing first; without kCellKnown where there is none.
SCONCE_FN uint openPlace(ivec3 cell)
{
    for (int i = 0; i < kPlacesTried; ++i)
    {
        // From the middle on by the sequence R3 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
        vec3 within = fract(vec3(real(0.5)) + real(i) * vec3(real(0.8191725), real(0.6710436), real(0.5497005)));
        uvec3 steps = uvec3(within * kCellPlaces);
        uint place = steps.x | (steps.y << 10) | (steps.z << 20) | kCellKnown;
        vec3 point = cellPlace(cell, place);
        int reads = 0;
        uvec4 ranked = rankedProbesAt(point, reads);
        for (int k = 0; k < kRanked; ++k)
        {
            vec3 from = point - vec3(probeHeader(ranked[k]).centre);
            vec3 plane = planeSeen(ranked[k], from);
            if (real(1.0) - dot(plane, from) > kLeastClearance * field.voxel * length(plane)) return place;
        }
    }
    return 0u;
}
