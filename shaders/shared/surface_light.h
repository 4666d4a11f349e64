// Surface light: the light that arrives at the surface points that a probe sees, one value a texel: a lightmap without a parametrisation of the
// scene. A point that a probe sees reads its own light there, where probes in the open know only the light of the open. Shared text, see
// probe_trace.h; needs surfaceWord(uint), planeSeen(), rankedProbesAt(), surfaceProbes() and light_cells.h besides.
//
// A surface map has `surfaceSize` texels a side of each cube face, fewer than the distance map. Its texel stands for one point, that of the
// distance texel that holds its centre: one that the probe sees. (Where the centre's own direction meets that texel's plane may lie beyond an edge,
// and so behind a thin wall.) The value is the mean of the radiance that arrives there, weighted
// by the cosine (irradiance / pi), of emitters, sky and all that surfaces scatter; what a host's point, spot and directional lights give
// directly is left out, since it is the host's to draw. RGB9E5; 0: it is sky, or its light is not known.
//
// A texel whose light changes within it is refined, into 4 x 4 finer ones: its word's exponent is 31, above any light's, and the rest the number of
// kFineWords words after all cells: the mean, and the light at what the finer texels see, of the same surface.
//
// Where the scene has normal textures (`surfaceDirections`), a texel's light is that on its plane, and 16 bits more tell its tilt: how it grows where
// the normal leans over, the first moment of the light along the plane over the light itself, two to a word after all texels' light.

// A texel lights a point that lies on its surface: within the chord of a curve as bent as the two normals are apart, and some slack.
SCONCE_CONST real kSurfaceSlack = real(0.05);  // of the distance to the texel's point, and of its width
SCONCE_CONST real kSurfaceBend = real(0.7071); // cosine of the angle between normals up to which a surface goes on
SCONCE_CONST real kSurfaceGrazing = real(0.05); // cosine at the point below which a probe sees too little of its surface
SCONCE_CONST real kSurfaceLeast = real(0.05);  // share of the four taps that must lie on the surface
SCONCE_CONST int kSurfaceProbes = 2;           // that light a point; a frame may take fewer: surfaceProbes()
SCONCE_CONST int kNearestReach = 2;            // texels to either side that the nearest one is searched in
SCONCE_CONST real kNearestBend = real(0.5);
SCONCE_CONST real kNearestWidths = real(3.0);
SCONCE_CONST real kReachOfDistance = real(0.12); // of the harmonic mean of a place's rays, over which gathered light is blended
SCONCE_CONST real kLeastReach = real(0.3);       // of a texel's width, the same
SCONCE_CONST uint kNoTexel = 0xffffffffu;
SCONCE_CONST real kMostTilt = real(2.0);      // that is stored
SCONCE_CONST real kMostBent = real(2.5);      // times a plane's light that a bent normal may get
SCONCE_CONST real kMostStored = real(32704.0); // the largest light of a lesser exponent
SCONCE_CONST uint kBlackWord = 0x08000000u; // no light that is known: 0 with another exponent

struct SurfacePoint
{
    vec3 at;     // relative to the probe's centre, field units
    vec3 normal; // unit, of the geometry, on the probe's side
    real width;  // of the texel across its axis there, field units; 0: sky
};

SCONCE_FN uint surfaceIndex(uint probe, int face, int x, int y)
{
    return ((probe * 6u + uint(face)) * field.surfaceSize + uint(y)) * field.surfaceSize + uint(x);
}

/// Where a texel of a map of `side` texels a side lies.
SCONCE_FN SurfacePoint surfacePointOf(uint probe, int face, int x, int y, uint side)
{
    SurfacePoint p;
    real finer = real(field.faceSize) / real(side);
    real fx = floor((real(x) + real(0.5)) * finer);
    real fy = floor((real(y) + real(0.5)) * finer);
    uint word = texelWord(mapWords(probe, face), uint(fx), uint(fy));
    real toUnit = real(2.0) / real(field.faceSize);
    real q = halfToReal(word);
    p.width = real(0.0);
    p.at = vec3(real(0.0));
    p.normal = vec3(real(0.0));
    if (!(q > real(0.0))) return p;
    p.at = faceDirection(face, vec3((fx + real(0.5)) * toUnit - real(1.0), (fy + real(0.5)) * toUnit - real(1.0), real(1.0))) / q;
    p.normal = texelNormal(face, vec2(fx, fy), word);
    if (side > field.faceSize) // several of one distance texel: along its plane
    {
        toUnit = real(2.0) / real(side);
        vec3 through = faceDirection(face, vec3((real(x) + real(0.5)) * toUnit - real(1.0), (real(y) + real(0.5)) * toUnit - real(1.0), real(1.0)));
        p.at = through * clamp(dot(p.normal, p.at) / min(dot(p.normal, through), real(-1e-6)), real(0.5) / q, real(2.0) / q);
    }
    p.width = real(2.0) / (real(side) * q);
    return p;
}

SCONCE_FN SurfacePoint surfacePointAt(uint probe, int face, int x, int y) { return surfacePointOf(probe, face, x, y, field.surfaceSize); }

/// Whether a surface goes on from a point (relative to the probe, its normal unit) to a texel's.
/// @param bend  least cosine between the normals
SCONCE_FN bool isSameSurface(vec3 point, vec3 normal, SCONCE_IN(SurfacePoint) texel, real bend)
{
    real turned = dot(normal, texel.normal);
    if (!(texel.width > real(0.0)) || turned < bend) return false;
    vec3 to = texel.at - point;
    real off = max(abs(dot(normal, to)), abs(dot(texel.normal, to)));
    real chord = sqrt(max(real(0.5) - real(0.5) * turned, real(0.0))) + kSurfaceSlack;
    return off <= length(to) * chord + kSurfaceSlack * texel.width;
}

/// Proof that a probe sees a surface point: a point lifted off it by a texel's width is in front of what the probe sees there. Without it the
/// foot of a thin wall would take the light of the floor on the other side, which lies in one plane with it. Cost: 1 read.
SCONCE_FN bool isSeenBy(uint probe, vec3 point, vec3 normal)
{
    real width = length(point) * real(2.0) / real(field.faceSize);
    vec3 lifted = point + width * normal;
    vec3 plane = planeSeen(probe, lifted);
    real behind = dot(plane, lifted);
    if (behind <= real(1.0) + real(0.5) / real(field.faceSize)) return true; // by at most a quarter of the width
    SurfacePoint seen;
    seen.at = lifted / behind;
    seen.normal = -normalize(plane);
    seen.width = width;
    return isSameSurface(point, normal, seen, kSurfaceBend);
}

/// What a probe has to say about a point: cosine there over the squared distance, so about its texels a unit of the surface; 0 where it sees too
/// little.
SCONCE_FN real surfaceDensity(uint probe, vec3 point, vec3 normal)
{
    vec3 to = vec3(probeHeader(probe).centre) - point;
    real d2 = max(dot(to, to), real(1e-12));
    real cosine = dot(to, normal) * inversesqrt(d2);
    return cosine > kSurfaceGrazing ? cosine / d2 : real(0.0);
}

/// A texel's light as it is stored where it is known.
SCONCE_FN uint packKnownLight(vec3 light)
{
    uint word = packSharedExponent(min(light, vec3(kMostStored)));
    return word == 0u ? kBlackWord : word;
}

/// The first of two axes along a plane, which its normal alone decides.
SCONCE_PURE vec3 firstAlong(vec3 normal)
{
    vec3 side = abs(normal.x) < real(0.6) ? vec3(real(1.0), real(0.0), real(0.0)) : vec3(real(0.0), real(1.0), real(0.0));
    return normalize(cross(normal, side));
}

SCONCE_PURE vec2 alongPlane(vec3 v, vec3 normal)
{
    vec3 first = firstAlong(normal);
    return vec2(dot(v, first), dot(v, cross(normal, first)));
}

SCONCE_PURE uint packTilt(vec2 tilt)
{
    real x = clamp(tilt.x / kMostTilt, real(-1.0), real(1.0));
    real y = clamp(tilt.y / kMostTilt, real(-1.0), real(1.0));
    return uint(int(floor(x * real(127.0) + real(127.5)))) | (uint(int(floor(y * real(127.0) + real(127.5)))) << 8);
}

SCONCE_PURE vec2 unpackTilt(uint bits)
{
    return vec2(real(bits & 255u) - real(127.0), real((bits >> 8) & 255u) - real(127.0)) * (kMostTilt / real(127.0));
}

/// How the light on a texel's plane grows where a normal bends off it, by a texture say: 0.5 + its dot product with the normal is what that gets over what
/// the plane gets. The hemisphere above the plane is cut off by another at that angle, which of even light leaves (1 + cos) / 2; what more comes from one
/// side is linear in the normal.
SCONCE_PURE vec3 growthOf(vec3 plane, vec2 tilt)
{
    vec3 first = firstAlong(plane);
    return real(0.5) * plane + tilt.x * first + tilt.y * cross(plane, first);
}

SCONCE_FN vec2 tiltOf(uint texel) { return unpackTilt(surfaceWord(surfaceTexels() + texel / 2u) >> (16u * (texel & 1u))); }

struct SurfaceTaps
{
    vec3 light;  // sum of the taps' light
    vec3 growth; // sum of growthOf() them, by their luminance
    real weight; // sum, bilinear, of those that lie on the surface
    real width;  // least of theirs, field units
};

/// The four taps about a point, of the finer texels where its own is refined. Cost: 8 reads, 12 with directions, up to 5 more with refined ones.
/// @param point   relative to the probe's centre
/// @param facing  of the surface, unit
SCONCE_FN SurfaceTaps surfaceTaps(uint probe, vec3 point, vec3 facing)
{
    int face = dominantFace(point);
    vec3 uvw = faceCoordinates(face, point);
    SurfaceTaps sum;
    sum.light = vec3(real(0.0));
    sum.growth = vec3(real(0.0));
    sum.weight = real(0.0);
    sum.width = real(1e30);
    if (!(uvw.z > real(1e-6))) return sum;
    int fineLog = 0; // log2 of the texels a side to one
    vec2 uv = vec2(uvw.x / uvw.z + real(1.0), uvw.y / uvw.z + real(1.0)) * (real(0.5) * real(field.surfaceSize));
    if (holdsRefined())
    {
        int most = int(field.surfaceSize) - 1;
        if (isRefined(surfaceWord(surfaceIndex(probe, face, clamp(int(floor(uv.x)), 0, most), clamp(int(floor(uv.y)), 0, most))))) fineLog = kFineLog;
    }
    int last = (int(field.surfaceSize) << fineLog) - 1;
    real px = uv.x * real(1 << fineLog) - real(0.5);
    real py = uv.y * real(1 << fineLog) - real(0.5);
    int x0 = clamp(int(floor(px)), 0, last - 1);
    int y0 = clamp(int(floor(py)), 0, last - 1);
    real fx = clamp(px - real(x0), real(0.0), real(1.0));
    real fy = clamp(py - real(y0), real(0.0), real(1.0));
    for (int tap = 0; tap < 4; ++tap)
    {
        int x = x0 + (tap & 1);
        int y = y0 + (tap >> 1);
        real weight = ((tap & 1) != 0 ? fx : real(1.0) - fx) * ((tap >> 1) != 0 ? fy : real(1.0) - fy);
        SurfacePoint texel = surfacePointOf(probe, face, x, y, field.surfaceSize << uint(fineLog));
        if (!isSameSurface(point, facing, texel, kSurfaceBend)) continue;
        uint index = surfaceIndex(probe, face, x >> fineLog, y >> fineLog);
        uint word = surfaceWord(index);
        if (holdsRefined() && isRefined(word)) word = refinedWord(word, fineLog == 0 ? 0u : fineIndex(x, y));
        if (word == 0u) continue;
        vec3 light = weight * unpackSharedExponent(word);
        sum.light += light;
        sum.weight += weight;
        sum.width = min(sum.width, texel.width);
        if (field.surfaceDirections != 0u) sum.growth += luminance(light) * growthOf(texel.normal, tiltOf(index));
    }
    return sum;
}

/// The nearest texel of some about a point that may be of its surface: for edges and what is thinner than a texel. Its bounds keep another room's
/// light out, which the nearest texel of all may be. Cost: 25 reads.
/// @return  its index; kNoTexel where there is none
SCONCE_FN uint nearestSurfaceTexel(uint probe, vec3 point, vec3 normal)
{
    int face = dominantFace(point);
    vec3 uvw = faceCoordinates(face, point);
    uint found = kNoTexel;
    if (!(uvw.z > real(1e-6))) return found;
    real middle = real(0.5) * real(field.surfaceSize);
    int last = int(field.surfaceSize) - 1;
    int px = int(floor(middle * (uvw.x / uvw.z + real(1.0))));
    int py = int(floor(middle * (uvw.y / uvw.z + real(1.0))));
    real best = real(1e30);
    int side = 2 * kNearestReach + 1;
    for (int tap = 0; tap < side * side; ++tap)
    {
        int x = px + tap % side - kNearestReach;
        int y = py + tap / side - kNearestReach;
        if (x < 0 || y < 0 || x > last || y > last) continue;
        SurfacePoint texel = surfacePointAt(probe, face, x, y);
        vec3 to = texel.at - point;
        real d2 = dot(to, to);
        if (!(texel.width > real(0.0)) || d2 > min(best, kNearestWidths * kNearestWidths * texel.width * texel.width)) continue;
        if (dot(normal, texel.normal) < kNearestBend || abs(dot(normal, to)) > texel.width) continue;
        best = d2;
        found = surfaceIndex(probe, face, x, y);
    }
    return found;
}

struct SurfaceLight
{
    vec3 light;  // mean of the arriving radiance, weighted by the cosine
    vec3 growth; // of what bent normals get, as growthOf(); 0: they get the same
    int probes; // that lit the point: 2, 1; 0: the nearest texel; -1: what is known of hidden surfaces there; -2: the cells in the open; -3: the probes' irradiance, which lacks emitters and sky
};

/// The first component that is largest; -1 when none is above 0.
SCONCE_FN int largestOf(vec4 v)
{
    real most = max(max(v.x, v.y), max(v.z, v.w));
    if (!(most > real(0.0))) return -1;
    return v.x == most ? 0 : (v.y == most ? 1 : (v.z == most ? 2 : 3));
}

/// What a normal bent off a surface gets of its light.
SCONCE_PURE vec3 lightOn(vec3 normal, SCONCE_IN(SurfaceLight) of)
{
    if (!(dot(of.growth, of.growth) > real(0.0))) return of.light;
    return of.light * clamp(real(0.5) + dot(normal, of.growth), real(0.0), kMostBent);
}

/// What a leaf's probes see of a surface point.
struct SurfaceSeen
{
    SurfaceLight light; // probes: 0 where no texel shows it
    uvec4 ranked;       // the leaf's probes
    uvec2 seeing;       // that see the point without a texel of its surface; kNoProbe
    real width;         // least of the texels that light it, field units
};

/// Light at a surface point from the two of its leaf's probes that see most of it, of their texels those of the same surface. Cost: about 25 reads,
/// 33 with directions.
/// @param point   field space
/// @param facing  normal of the surface, unit, on the side that is looked at
/// @param lookUp  point whose leaf is asked
SCONCE_FN SurfaceSeen surfaceLightSeen(vec3 point, vec3 facing, vec3 lookUp, SCONCE_INOUT(int) reads)
{
    SurfaceSeen result;
    result.light.light = vec3(real(0.0));
    result.light.growth = vec3(real(0.0));
    result.light.probes = 0;
    result.seeing = uvec2(kNoProbe);
    result.width = real(1e30);
    result.ranked = uvec4(0u);
    if (!canGather(point, facing)) return result;
    uvec4 ranked = rankedProbesAt(lookUp, reads);
    result.ranked = ranked;
    vec4 density = vec4(surfaceDensity(ranked.x, point, facing), surfaceDensity(ranked.y, point, facing),
                        surfaceDensity(ranked.z, point, facing), surfaceDensity(ranked.w, point, facing));
    // A list of fewer repeats some.
    if (ranked.y == ranked.x) density.y = real(0.0);
    if (ranked.z == ranked.x || ranked.z == ranked.y) density.z = real(0.0);
    if (ranked.w == ranked.x || ranked.w == ranked.y || ranked.w == ranked.z) density.w = real(0.0);
    real weight = real(0.0);
    for (int k = 0; k < kRanked && result.light.probes < surfaceProbes(); ++k)
    {
        int which = largestOf(density);
        if (which < 0) break;
        real most = density[which];
        uint probe = ranked[which];
        density[which] = real(0.0);
        askForMaps(probe);
        if (!holdsMaps(probe)) continue;
        vec3 fromProbe = point - vec3(probeHeader(probe).centre);
        if (!isSeenBy(probe, fromProbe, facing)) continue;
        SurfaceTaps taps = surfaceTaps(probe, fromProbe, facing);
        if (taps.weight > kSurfaceLeast)
        {
            result.light.light += most * taps.light;
            result.light.growth += most * taps.growth;
            weight += most * taps.weight;
            ++result.light.probes;
            result.width = min(result.width, taps.width);
        }
        else if (result.seeing.x == kNoProbe) result.seeing.x = probe;
        else if (result.seeing.y == kNoProbe) result.seeing.y = probe;
    }
    if (result.light.probes > 0)
    {
        real bright = luminance(result.light.light);
        result.light.growth = bright > real(0.0) ? result.light.growth / bright : vec3(real(0.0));
        result.light.light = result.light.light / weight;
    }
    return result;
}

/// Light at a surface point, from what near it is known where no texel shows it. Cost: surfaceLightSeen()'s; up to 50 reads more where no texel shows the
/// point, and up to 68 where nothing near it does (light_cells.h).
/// @param normal  unit, that the light falls on where no texel shows the point
/// @return  on the surface itself: see lightOn()
SCONCE_FN SurfaceLight surfaceLightOf(vec3 point, vec3 normal, vec3 facing, vec3 lookUp, SCONCE_INOUT(int) reads)
{
    SurfaceSeen seen = surfaceLightSeen(point, facing, lookUp, reads);
    SurfaceLight result = seen.light;
    if (result.probes > 0 || !canGather(point, facing)) return result;
    vec4 hidden = vec4(real(0.0));
    if (holdsHidden()) hidden = hiddenLightAt(point, facing);
    result.probes = -1;
    result.light = vec3(hidden.x, hidden.y, hidden.z);
    if (hidden.w > real(0.0)) return result;
    result.probes = 0;
    uint nearest = kNoTexel;
    if (seen.seeing.x != kNoProbe) nearest = nearestSurfaceTexel(seen.seeing.x, point - vec3(probeHeader(seen.seeing.x).centre), facing);
    if (nearest == kNoTexel && seen.seeing.y != kNoProbe)
        nearest = nearestSurfaceTexel(seen.seeing.y, point - vec3(probeHeader(seen.seeing.y).centre), facing);
    uint word = 0u;
    if (nearest != kNoTexel) word = surfaceWord(nearest);
    if (holdsRefined() && isRefined(word)) word = refinedWord(word, 0u);
    if (word != 0u)
    {
        result.light = unpackSharedExponent(word);
        if (field.surfaceDirections != 0u) result.growth = growthOf(facing, tiltOf(nearest));
        return result;
    }
    vec4 open = cellLightAt(lookUp, normal, seen.ranked);
    result.probes = -2;
    result.light = vec3(open.x, open.y, open.z);
    if (open.w > real(0.0)) return result;
    result.probes = -3;
    result.light = irradianceAt(point, normal, lookUp, reads);
    return result;
}

/// The same, on a normal.
SCONCE_FN SurfaceLight surfaceLightAt(vec3 point, vec3 normal, vec3 facing, vec3 lookUp, SCONCE_INOUT(int) reads)
{
    SurfaceLight result = surfaceLightOf(point, normal, facing, lookUp, reads);
    result.light = lightOn(normal, result);
    return result;
}
