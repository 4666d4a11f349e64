// What light the probe maps hold: radiance at a traced hit and prefiltered irradiance at a point. Shared text, see probe_trace.h; needs
// radianceWord(uint), irradianceWord(uint) and holdsRadiance() besides.

SCONCE_FN uint radianceIndex(uint probe, int face, int x, int y)
{
    uint map = onOctahedron() ? probe : probe * 6u + uint(face);
    return (map * field.faceSize + uint(y)) * field.faceSize + uint(x);
}

/// Radiance leaving the surfel of a trace's result towards its probe, W/(m^2 sr). Bilinear over the texels that lie on the surfel's own
/// plane, so that neither a silhouette nor a texel of the background bleeds in. Cost: 8 reads.
SCONCE_FN vec3 surfelRadiance(SCONCE_IN(TraceResult) hit)
{
    int size = int(field.faceSize);
    real x = clamp(hit.pixel.x, real(0.5), real(size) - real(0.5)) - real(0.5);
    real y = clamp(hit.pixel.y, real(0.5), real(size) - real(0.5)) - real(0.5);
    int x0 = min(int(x), size - 2);
    int y0 = min(int(y), size - 2);
    real fx = x - real(x0);
    real fy = y - real(y0);
    real cx = min(floor(hit.pixel.x), real(size - 1));
    real cy = min(floor(hit.pixel.y), real(size - 1));
    real qc = halfToReal(hit.word);
    real gx = unpackGradient(hit.word >> 16);
    real gy = unpackGradient(hit.word >> 24);
    uint faceWords = mapWords(hit.probe, hit.face);
    vec3 sum = vec3(real(0.0));
    real weights = real(0.0);
    for (int tap = 0; tap < 4; ++tap)
    {
        int tx = x0 + (tap & 1);
        int ty = y0 + (tap >> 1);
        real weight = ((tap & 1) != 0 ? fx : real(1.0) - fx) * ((tap >> 1) != 0 ? fy : real(1.0) - fy) + real(1e-4);
        real q = halfToReal(distanceWord(faceWords + uint(ty * size + tx)));
        real expected = qc * (real(1.0) + gx * (real(tx) - cx) + gy * (real(ty) - cy));
        if (abs(q - expected) > real(0.02) * qc && (real(tx) != cx || real(ty) != cy)) continue;
        sum += weight * unpackRadiance(radianceWord(radianceIndex(hit.probe, hit.face, tx, ty)));
        weights += weight;
    }
    return sum / max(weights, real(1e-6));
}

/// Words of a texel of a probe's irradiance map: the irradiance, and after it the moments.
SCONCE_FN uint irradianceIndex(uint probe, uint texel) { return 2u * (probe * kIrradianceSize * kIrradianceSize + texel); }

/// Bilinear: cosine-weighted mean radiance (irradiance / pi) about direction d.
SCONCE_FN vec3 probeIrradiance(uint probe, vec3 d)
{
    OctahedralTaps taps = octahedralTaps(octahedralFromDirection(d), int(kIrradianceSize));
    return taps.weight.x * unpackRadiance(irradianceWord(irradianceIndex(probe, taps.texel.x))) +
           taps.weight.y * unpackRadiance(irradianceWord(irradianceIndex(probe, taps.texel.y))) +
           taps.weight.z * unpackRadiance(irradianceWord(irradianceIndex(probe, taps.texel.z))) +
           taps.weight.w * unpackRadiance(irradianceWord(irradianceIndex(probe, taps.texel.w)));
}

SCONCE_FN vec2 texelMoments(uint probe, uint texel)
{
    uint word = irradianceWord(irradianceIndex(probe, texel) + 1u);
    return vec2(halfToReal(word), halfToReal(word >> 16));
}

/// Bilinear: (mean, variance) of the distance seen in direction d, field units.
SCONCE_FN vec2 probeMoments(uint probe, vec3 d)
{
    OctahedralTaps taps = octahedralTaps(octahedralFromDirection(d), int(kIrradianceSize));
    return taps.weight.x * texelMoments(probe, taps.texel.x) + taps.weight.y * texelMoments(probe, taps.texel.y) +
           taps.weight.z * texelMoments(probe, taps.texel.z) + taps.weight.w * texelMoments(probe, taps.texel.w);
}

/// Whether a probe's map (cube chart) knows a surface between the probe and a point, relative to its centre. A wall thinner than the spread
/// of the distances about it is nothing to Chebyshev's bound; to the plane of its texel it is one. 0.2 %: what a packed plane is off by.
SCONCE_FN bool hiddenFromProbe(uint probe, vec3 p)
{
    int face = dominantFace(p);
    vec3 uvw = faceCoordinates(face, p);
    if (field.chart != kChartCube || !(uvw.z > real(1e-6))) return false;
    real last = real(field.faceSize) - real(1.0);
    real x = real(0.5) * real(field.faceSize) * (uvw.x / uvw.z + real(1.0));
    real y = real(0.5) * real(field.faceSize) * (uvw.y / uvw.z + real(1.0));
    real ix = clamp(floor(x), real(0.0), last);
    real iy = clamp(floor(y), real(0.0), last);
    uint word = distanceWord(probe * field.wordsPerProbe + uint(face) * (field.wordsPerProbe / 6u) + uint(iy) * field.faceSize + uint(ix));
    real slope = unpackGradient(word >> 16) * (x - ix - real(0.5)) + unpackGradient(word >> 24) * (y - iy - real(0.5));
    real q = halfToReal(word) * (real(1.0) + slope);
    return uvw.z * q > real(1.002);
}

/// What probes say of the light at a surface point, weighted; all are added before they are divided by the weight, so that a leaf behind a
/// wall, whose probes are all hidden, has no say.
struct GatheredLight
{
    vec3 diffuse; // weight times cosine-weighted mean of the arriving radiance (irradiance / pi)
    vec3 lobe;    // weight times mean radiance in the lobe
    real weight;
};

/// A lobe's light by one probe: what the lobe's axis meets lies about as far from the probe as its surroundings in that direction, and the
/// lobe is as wide, seen from there, as it has become on the way.
/// @param fromProbe  the lobe's origin relative to the probe's centre
SCONCE_FN vec3 lobeRadiance(uint probe, vec3 fromProbe, SCONCE_IN(Lobe) lobe)
{
    vec3 seen = probeMoments(probe, lobe.direction).x * lobe.direction;
    real t = max(dot(seen - fromProbe, lobe.direction), real(field.voxel));
    vec3 met = fromProbe + t * lobe.direction;
    real away = max(length(met), real(1e-6));
    return prefilteredRadiance(probe, away > real(1e-6) ? met / away : lobe.direction, min(lobe.width * t / away, real(1.5)));
}

SCONCE_FN GatheredLight noLight()
{
    GatheredLight none;
    none.diffuse = vec3(real(0.0));
    none.lobe = vec3(real(0.0));
    none.weight = real(0.0);
    return none;
}

/// Whether light can be gathered at a point: not for a point or normal that is not finite, nor for a normal without length.
SCONCE_FN bool canGather(vec3 point, vec3 normal)
{
    real length2 = dot(normal, normal);
    return length2 > real(1e-12) && length2 + dot(point, point) < real(1e18);
}

/// Adds what one probe says of the light at a surface point: diffuse, and in a lobe where one is asked for. Weights: wrapped cosine towards
/// the probe (Majercik et al. 2019, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields"), Chebyshev visibility from the
/// distance moments (McGuire et al. 2017, section 5.2; cubed as in the former), nothing from a probe whose map shows a surface before the
/// point, and the inverse square of the distance, since the probes are no grid. Cost: 9 reads, 12 more with a lobe.
/// @param times  how often the probe is counted
/// @param wantDiffuse, wantLobe  constants of the caller: what is not wanted is not read
SCONCE_FN void gatherProbe(uint probe, vec3 point, vec3 normal, SCONCE_IN(Lobe) lobe, real times, bool wantDiffuse, bool wantLobe,
                           SCONCE_INOUT(GatheredLight) gathered)
{
    vec3 biased = point + real(0.002) * real(field.diagonal) * normal;
    vec3 toProbe = vec3(probeHeader(probe).centre) - biased;
    real distance2 = max(dot(toProbe, toProbe), real(1e-12));
    real distance = sqrt(distance2);
    vec3 direction = distance2 > real(1e-12) ? toProbe / distance : normal; // at the centre any direction will do
    real wrap = real(0.5) * dot(direction, normal) + real(0.5);
    real weight = wrap * wrap + real(0.02);
    vec2 moments = probeMoments(probe, -direction);
    if (distance > moments.x)
    {
        real beyond = distance - moments.x;
        real spread = max(moments.y, real(0.0)) + real(1e-6);
        real chebyshev = spread / (spread + beyond * beyond);
        weight *= chebyshev * chebyshev * chebyshev;
    }
    if (hiddenFromProbe(probe, -toProbe)) weight = real(0.0);
    weight = times * max(weight, real(1e-6)) / (distance2 + real(field.voxel) * real(field.voxel));
    if (wantDiffuse) gathered.diffuse += weight * probeIrradiance(probe, normal);
    if (wantLobe) gathered.lobe += weight * lobeRadiance(probe, -toProbe, lobe);
    gathered.weight += weight;
}

/// Cosine-weighted mean of the radiance arriving at a surface point (irradiance / pi; multiply by the diffuse albedo) from the probes of one
/// leaf; see gatherProbe. Black where nothing can be gathered.
/// @param lookUp  point whose leaf is asked
SCONCE_FN vec3 irradianceAt(vec3 point, vec3 normal, vec3 lookUp, SCONCE_INOUT(int) reads)
{
    GatheredLight gathered = noLight();
    if (!canGather(point, normal)) return gathered.diffuse;
    Lobe none;
    none.direction = normal;
    none.width = real(0.0);
    uvec4 ranked = rankedProbesAt(lookUp, reads);
    for (int k = 0; k < kRanked; ++k)
    {
        bool repeated = false;
        for (int j = 0; j < k; ++j) repeated = repeated || ranked[j] == ranked[k];
        if (!repeated) gatherProbe(ranked[k], point, normal, none, real(1.0), true, false, gathered);
    }
    return gathered.diffuse / max(gathered.weight, real(1e-30));
}
