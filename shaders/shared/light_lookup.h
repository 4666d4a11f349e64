// What light the probe maps hold: radiance at a traced hit and prefiltered irradiance at a point. Shared text, see probe_trace.h; needs
// radianceWord(uint), radianceBlock(uint), irradianceWord(uint), patchWords(uint), holdsRadiance() and holdsPrefiltered() besides.

SCONCE_FN uint radianceIndex(uint probe, int face, int x, int y)
{
    uint map = onOctahedron() ? mapSlot(probe) : mapSlot(probe) * 6u + uint(face);
    return (map * field.faceSize + uint(y)) * field.faceSize + uint(x);
}

/// Of a texel of a probe's map, W/(m^2 sr).
SCONCE_FN vec3 mapRadiance(uint probe, int face, int x, int y)
{
    if (!mapsInBlocks()) return unpackRadiance(radianceWord(radianceIndex(probe, face, x, y)));
    uint side = field.faceSize / kBlockSide;
    uint block = ((mapSlot(probe) * 6u + uint(face)) * side + uint(y) / kBlockSide) * side + uint(x) / kBlockSide;
    return blockRadiance(radianceBlock(block), (uint(y) % kBlockSide) * kBlockSide + uint(x) % kBlockSide);
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
        real q = halfToReal(texelWord(faceWords, uint(tx), uint(ty)));
        real expected = qc * (real(1.0) + gx * (real(tx) - cx) + gy * (real(ty) - cy));
        if (abs(q - expected) > real(0.02) * qc && (real(tx) != cx || real(ty) != cy)) continue;
        sum += weight * mapRadiance(hit.probe, hit.face, tx, ty);
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

SCONCE_CONST real kFacesTooLittle = real(0.02); // cosine of a surfel to its probe below which its plane says nothing; as bake_octahedral.comp's

/// planeSeen of an octahedral map, whose texels hold distances and normals.
SCONCE_FN vec3 planeOfDistance(uint probe, vec3 direction)
{
    real size = real(field.faceSize);
    vec2 at = octahedralFromDirection(direction) * size;
    real x = clamp(floor(at.x), real(0.0), size - real(1.0));
    real y = clamp(floor(at.y), real(0.0), size - real(1.0));
    uint word = distanceWord(mapWords(probe, 0) + uint(y) * field.faceSize + uint(x));
    real r = halfToReal(word);
    if ((word & 0xffffu) == 0x7c00u || !(r > real(0.0))) return vec3(real(0.0));
    vec3 middle = directionFromOctahedral(vec2((x + real(0.5)) / size, (y + real(0.5)) / size));
    vec3 normal = unpackNormal8(word >> 16);
    real facing = dot(normal, middle);
    return abs(facing) > kFacesTooLittle ? normal / (r * facing) : middle / r;
}

/// The plane of the surfel that a probe sees in a direction: dot(plane, p) is 1 for the points p of it, relative to the probe's centre, less
/// before it, and more behind it. 0 for sky, and where nothing is known.
SCONCE_FN vec3 planeSeen(uint probe, vec3 direction)
{
    if (!holdsMaps(probe)) return vec3(real(0.0)); // not known
    if (onOctahedron()) return dot(direction, direction) > real(1e-12) ? planeOfDistance(probe, direction) : vec3(real(0.0));
    int face = dominantFace(direction);
    vec3 uvw = faceCoordinates(face, direction);
    if (!(uvw.z > real(1e-6))) return vec3(real(0.0));
    real middle = real(0.5) * real(field.faceSize);
    real last = real(field.faceSize) - real(1.0);
    real x = clamp(floor(middle * (uvw.x / uvw.z + real(1.0))), real(0.0), last);
    real y = clamp(floor(middle * (uvw.y / uvw.z + real(1.0))), real(0.0), last);
    uint word = texelWord(mapWords(probe, face), uint(x), uint(y));
    real gx = unpackGradient(word >> 16);
    real gy = unpackGradient(word >> 24);
    real inMiddle = real(1.0) + gx * (middle - x - real(0.5)) + gy * (middle - y - real(0.5)); // of the face, over q of the texel's centre
    return halfToReal(word) * faceDirection(face, vec3(middle * gx, middle * gy, inMiddle));
}

SCONCE_CONST real kBeyondMoments = real(1.0); // standard deviations beyond the mean distance from which on a point counts as hidden
/// Whether a probe's map knows a surface between the probe and a point, relative to its centre. A wall thinner than the spread of the
/// distances about it is nothing to Chebyshev's bound; to the plane of its texel it is one. 0.2 %: what a packed plane is off by. Where its maps aren't
/// on the device, by the moments of its distances.
SCONCE_FN bool hiddenFromProbe(uint probe, vec3 p)
{
    if (holdsMaps(probe)) return dot(planeSeen(probe, p), p) > real(1.002);
    real away = length(p);
    vec2 moments = probeMoments(probe, p / max(away, real(1e-6)));
    return away > moments.x + kBeyondMoments * sqrt(max(moments.y, real(0.0)));
}

/// How far off a ray meets a surface that a probe sees, field units; 0: none was found. The ray is followed from plane to plane: where it
/// meets the one seen in its direction, the probe is asked again (as Szirmay-Kalos et al. 2005, "Approximate Ray-Tracing on the GPU with
/// Distance Impostors", follow distances). What stands before that surface, but out of the probe's sight, isn't found. Cost: 2 to 4 reads.
/// @param fromProbe  where the ray starts, relative to the probe's centre
SCONCE_FN real seenAlong(uint probe, vec3 fromProbe, vec3 direction)
{
    real farthest = real(1e3); // field units: beyond every scene
    real t = farthest;
    for (int step = 0; step < 4; ++step)
    {
        vec3 p = fromProbe + t * direction;
        vec3 plane = planeSeen(probe, p);
        real towards = dot(plane, direction);
        if (step > 0 && towards > real(0.0) && abs(dot(plane, p) - real(1.0)) < real(0.02)) return t;
        real before = real(1.0) - dot(plane, fromProbe);
        if (before > real(0.0) && towards * farthest > before) t = before / towards;
    }
    return real(0.0);
}

/// The same where no probe sees a surface on the ray: what it meets lies about as far from the probe as the surroundings in its direction.
SCONCE_FN real guessedAlong(uint probe, vec3 fromProbe, vec3 direction)
{
    return dot(probeMoments(probe, direction).x * direction - fromProbe, direction);
}

/// A lobe's light by one probe: towards what the lobe's axis meets, as wide, seen from the probe, as it has become on the way. Cost: 8 reads.
/// @param fromProbe  the lobe's origin relative to the probe's centre
/// @param t          how far off it meets something, field units
SCONCE_FN vec3 lobeRadiance(uint probe, vec3 fromProbe, SCONCE_IN(Lobe) lobe, real t)
{
    real way = max(t, real(field.voxel));
    vec3 met = fromProbe + way * lobe.direction;
    real away = max(length(met), real(1e-6));
    return prefilteredRadiance(probe, away > real(1e-6) ? met / away : lobe.direction, min(lobe.width * way / away, real(1.5)));
}

// Of what a probe's patches leave of the hemisphere, what it hides from them: the share that its own irradiance is taken for. 0, 1/4, 1/2 and 1 were
// tried (docs/light.md).
SCONCE_CONST real kHiddenShare = real(0.5);

/// Light that a probe's patches throw on a surface point: cosine-weighted mean radiance (irradiance / pi), without emission and sky. Each patch
/// is what the probe sees through 1/36 of a cube face, as one diffuse disc: its place in the middle of that window, its normal, its mean
/// radiance. The point is lit by it as a disc is seen (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-12's limit), from
/// where the point is, not from where the probe is: so it is right about what is near, which prefiltered irradiance is not. The patches are virtual point
/// lights (Keller 1997, "Instant Radiosity") of a probe. What of the hemisphere they leave open is hidden from the probe.
/// Cost: kPatches / 2 reads of four words.
/// @param fromProbe  the point relative to the probe's centre, field units
SCONCE_FN vec3 patchIrradiance(uint probe, vec3 fromProbe, vec3 normal)
{
    real pi = real(3.14159265358979);
    vec3 sum = vec3(real(0.0));
    real covered = real(0.0); // of the hemisphere, by the cosine
    uvec4 words = uvec4(0u);  // of two patches
    for (int face = 0; face < 6; ++face)
        for (int cell = 0; cell < kPatchSide * kPatchSide; ++cell)
        {
            if ((cell & 1) == 0) words = patchWords((probe * kPatches + uint(face * kPatchSide * kPatchSide + cell)) / 2u);
            uint place = (cell & 1) == 0 ? words.x : words.z;
            uint radiance = (cell & 1) == 0 ? words.y : words.w;
            real u = real(2 * (cell % kPatchSide) + 1) / real(kPatchSide) - real(1.0);
            real v = real(2 * (cell / kPatchSide) + 1) / real(kPatchSide) - real(1.0);
            real stretch = sqrt(real(1.0) + u * u + v * v);
            real solid = real(4.0) / (real(kPatchSide * kPatchSide) * stretch * stretch * stretch); // angle of the window
            vec3 towards = faceDirection(face, vec3(u, v, real(1.0)));
            real q = halfToReal(place); // 1 / W, as of a texel
            if (q == real(0.0)) // sky
            {
                covered += max(dot(towards, normal), real(0.0)) / stretch * solid / pi;
                continue;
            }
            vec3 facing = unpackNormal8(place >> 16);
            vec3 away = towards / q - fromProbe;
            real d2 = max(dot(away, away), real(1e-12));
            real cosines = max(dot(away, normal), real(0.0)) * max(-dot(away, facing), real(0.0)) / d2;
            real area = solid * stretch * stretch / (q * q * max(-dot(towards, facing) / stretch, real(0.1)));
            real factor = cosines * area / (pi * d2 + area);
            covered += factor;
            sum += factor * unpackRadiance(radiance);
        }
    return sum / max(covered, real(1.0)) + kHiddenShare * max(real(1.0) - covered, real(0.0)) * probeIrradiance(probe, normal);
}

/// Whether light can be gathered at a point: not for a point or normal that is not finite, nor for a normal without length.
SCONCE_FN bool canGather(vec3 point, vec3 normal)
{
    real length2 = dot(normal, normal);
    return length2 > real(1e-12) && length2 + dot(point, point) < real(1e18);
}

// 2 to 4, squared or not, were tried: all mend a probe in a gap, this one costs the others least (docs/light.md).
SCONCE_CONST real kCarried = real(4.0);

/// Angle of a probe's texel, radians: the root of its share of the sphere.
SCONCE_FN real texelAngle() { return (onOctahedron() ? real(3.545) : real(1.447)) / real(field.faceSize); }

/// The say of a probe in the light at a surface point, above 0: all are summed before they are divided by, so that a leaf behind a wall, whose
/// probes are all hidden, has none. Wrapped cosine towards the probe (Majercik et al. 2019, "Dynamic Diffuse Global Illumination with
/// Ray-Traced Irradiance Fields"), Chebyshev visibility from the distance moments (McGuire et al. 2017, section 5.2; cubed as in the former),
/// nothing from a probe whose map shows a surface before the point, and the inverse square of the distance, since the probes are no grid. A probe
/// close to surfaces, in a gap above a lamp say, has light that is no other place's: beyond kCarried times the harmonic mean of the distances that it
/// sees its say falls with the fourth power again (Ward, Rubinstein, Clear 1988, "A Ray Tracing Solution for Diffuse Interreflection", measure
/// by that mean how far irradiance holds).
/// Cost: 5 reads.
SCONCE_FN real weightOfProbe(uint probe, vec3 point, vec3 normal)
{
    // Off its surface by a texel: what the maps can tell the surface's own distance from.
    vec3 centre = vec3(probeHeader(probe).centre);
    vec3 toProbe = centre - point - texelAngle() * length(centre - point) * normal;
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
    real harmonic = real(probeHeader(probe).harmonic);
    real carried = harmonic > real(0.0) ? distance2 / (kCarried * kCarried * harmonic * harmonic) : real(0.0);
    weight /= real(1.0) + carried * carried;
    return max(weight, real(1e-6)) / (distance2 + real(field.voxel) * real(field.voxel));
}

/// Cosine-weighted mean of the radiance arriving at a surface point (irradiance / pi; multiply by the diffuse albedo) from the probes of one
/// leaf; see weightOfProbe. Black where nothing can be gathered.
/// @param lookUp  point whose leaf is asked
SCONCE_FN vec3 irradianceAt(vec3 point, vec3 normal, vec3 lookUp, SCONCE_INOUT(int) reads)
{
    vec3 sum = vec3(real(0.0));
    if (!canGather(point, normal)) return sum;
    real weights = real(0.0);
    uvec4 ranked = rankedProbesAt(lookUp, reads);
    for (int k = 0; k < kRanked; ++k)
    {
        bool repeated = false;
        for (int j = 0; j < k; ++j) repeated = repeated || ranked[j] == ranked[k];
        if (repeated) continue;
        real weight = weightOfProbe(ranked[k], point, normal);
        sum += weight * probeIrradiance(ranked[k], normal);
        weights += weight;
    }
    return sum / max(weights, real(1e-30));
}
