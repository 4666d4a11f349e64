// How a surface texel's reach is packed, and what rays find of live light. Shared text, see probe_trace.h; needs liveWord(uint), albedoWord(uint),
// holdsLive() and surface_light.h besides.

SCONCE_CONST real kReachSteps = real(5.0); // to a power of two
SCONCE_CONST real kLeastReachLog = real(-21.0);

/// Of a distance in field units, 7 bits above 0, within 7 %; 0: not known.
SCONCE_PURE uint packReach(real reach)
{
    return uint(int(clamp(floor((log2(max(reach, real(1e-9))) - kLeastReachLog) * kReachSteps + real(0.5)), real(1.0), real(127.0))));
}
SCONCE_PURE real unpackReach(uint code) { return exp2(real(code) / kReachSteps + kLeastReachLog); }

/// Albedo, all lobes taken as diffuse, of one of the coarser texels that rays find it in: half as many a side as the radiance's.
SCONCE_FN vec3 liveAlbedoOf(uint probe, int face, int x, int y)
{
    uint side = field.faceSize / 2u;
    uint index = ((probe * 6u + uint(face)) * side + uint(y)) * side + uint(x);
    return unpackAlbedo(albedoWord(index / 2u) >> (16u * (index & 1u)));
}

/// Bilinear.
SCONCE_FN vec3 liveAlbedo(SCONCE_IN(TraceResult) hit)
{
    int last = int(field.faceSize / 2u) - 1;
    real x = clamp(real(0.5) * hit.pixel.x - real(0.5), real(0.0), real(last));
    real y = clamp(real(0.5) * hit.pixel.y - real(0.5), real(0.0), real(last));
    int x0 = min(int(x), last - 1);
    int y0 = min(int(y), last - 1);
    real fx = x - real(x0);
    real fy = y - real(y0);
    return (real(1.0) - fy) * ((real(1.0) - fx) * liveAlbedoOf(hit.probe, hit.face, x0, y0) + fx * liveAlbedoOf(hit.probe, hit.face, x0 + 1, y0)) +
           fy * ((real(1.0) - fx) * liveAlbedoOf(hit.probe, hit.face, x0, y0 + 1) + fx * liveAlbedoOf(hit.probe, hit.face, x0 + 1, y0 + 1));
}

/// Light of live lights, direct and bounced, that arrives at the surfel of a trace's result: mean of the radiance, weighted by the cosine; by the four
/// texels about it of the same surface, where there is none by the nearest. Cost: 8 reads.
SCONCE_FN vec3 liveLightAt(SCONCE_IN(TraceResult) hit)
{
    real toUnit = real(2.0) / real(field.faceSize);
    vec2 off = vec2(hit.pixel.x - floor(hit.pixel.x) - real(0.5), hit.pixel.y - floor(hit.pixel.y) - real(0.5));
    real q = halfToReal(hit.word) * (real(1.0) + unpackGradient(hit.word >> 16) * off.x + unpackGradient(hit.word >> 24) * off.y);
    if (!(q > real(0.0))) return vec3(real(0.0));
    vec3 point = faceDirection(hit.face, vec3(hit.pixel.x * toUnit - real(1.0), hit.pixel.y * toUnit - real(1.0), real(1.0))) / q;
    vec3 normal = texelNormal(hit.face, hit.pixel, hit.word);
    real finer = real(field.surfaceSize) / real(field.faceSize);
    int last = int(field.surfaceSize) - 1;
    real px = hit.pixel.x * finer - real(0.5);
    real py = hit.pixel.y * finer - real(0.5);
    int x0 = clamp(int(floor(px)), 0, last - 1);
    int y0 = clamp(int(floor(py)), 0, last - 1);
    real fx = clamp(px - real(x0), real(0.0), real(1.0));
    real fy = clamp(py - real(y0), real(0.0), real(1.0));
    vec3 sum = vec3(real(0.0));
    vec3 nearest = vec3(real(0.0));
    real weights = real(0.0);
    real most = real(0.0);
    for (int tap = 0; tap < 4; ++tap)
    {
        int x = x0 + (tap & 1);
        int y = y0 + (tap >> 1);
        real weight = ((tap & 1) != 0 ? fx : real(1.0) - fx) * ((tap >> 1) != 0 ? fy : real(1.0) - fy);
        vec3 light = unpackSharedExponent(liveWord(surfaceIndex(hit.probe, hit.face, x, y)));
        if (weight > most) nearest = light;
        most = max(most, weight);
        if (!isSameSurface(point, normal, surfacePointAt(hit.probe, hit.face, x, y), kSurfaceBend)) continue;
        sum += weight * light;
        weights += weight;
    }
    return weights > kSurfaceLeast ? sum / weights : nearest;
}

/// What a surfel sends of live light. Cost: 12 reads.
SCONCE_FN vec3 liveRadiance(SCONCE_IN(TraceResult) hit) { return liveAlbedo(hit) * liveLightAt(hit); }
