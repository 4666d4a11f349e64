// From a world-space ray to the answer a host sees. Shared text, see probe_trace.h and light_lookup.h.

SCONCE_FN real finiteOr(real value, real otherwise) { return abs(value) < real(1e30) ? value : otherwise; }

/// @param radiance  of the surfel the result names, when it names one
SCONCE_FN RayHit answer(vec3 origin, vec3 direction, SCONCE_IN(TraceResult) r, vec3 normal, vec3 radiance)
{
    RayHit hit;
    real t = finiteOr(r.t * real(field.scale), real(0.0));
    hit.status = r.status;
    hit.t = float(t);
    hit.position = vec3f(finiteOr(origin.x + t * direction.x, real(0.0)), finiteOr(origin.y + t * direction.y, real(0.0)),
                         finiteOr(origin.z + t * direction.z, real(0.0)));
    hit.normal = vec3f(normal);
    vec3 light = radiance;
    if (r.status == kMiss) light = vec3(field.sky);
    hit.radiance = vec3f(light);
    hit.probe = r.probe;
    hit.handoffs = r.handoffs;
    hit.distanceReads = r.distanceReads;
    hit.indexReads = r.indexReads;
    hit.confidence = float(r.confidence);
    return hit;
}

SCONCE_FN vec3 pixelDirection(int face, vec2 pixel)
{
    real half_ = real(0.5) * real(field.faceSize);
    return normalize(mapDirection(face, vec3(pixel.x / half_ - real(1.0), pixel.y / half_ - real(1.0), real(1.0))));
}

/// The answer of our tracer's result.
SCONCE_FN RayHit answerOf(vec3 origin, vec3 direction, SCONCE_IN(TraceResult) r)
{
    vec3 normal = vec3(real(0.0));
    vec3 radiance = vec3(real(0.0));
    if (r.face >= 0)
    {
        normal = texelNormal(r.face, r.pixel, r.word);
        // A field of a scene without glossy surfaces has its radiance only prefiltered: the hit is then as blurred as that. One that was baked
        // for where rays end has none.
        if (!holdsRadiance() && holdsPrefiltered()) radiance = prefilteredRadiance(r.probe, pixelDirection(r.face, r.pixel), real(0.0));
        else if (!holdsRadiance()) radiance = vec3(real(0.0));
        else if (holdsLive()) radiance = fixedWeight() * surfelRadiance(r) + liveRadiance(r);
        else radiance = surfelRadiance(r);
    }
    return answer(origin, direction, r, normal, radiance);
}

/// A world-space ray through the light field with our tracer. Cost: about 30 distance reads on a cluttered indoor scene.
SCONCE_FN RayHit queryRay(vec3 origin, vec3 direction, vec3 normal)
{
    return answerOf(origin, direction, traceRay((origin - vec3(field.origin)) / real(field.scale), direction, normal));
}

/// Whether light that comes against `direction` (unit) from `distance` metres off, or further than the field goes, reaches a world-space point:
/// a shadow ray. What a probe shows within two of its texels of the light is the light's own surface; a ray that no probe can answer is
/// blocked. Cost: that of queryRay at most, and no radiance is read.
SCONCE_FN bool lightReaches(vec3 point, vec3 direction, real distance_, vec3 normal)
{
    RayState r = startRay((point - vec3(field.origin)) / real(field.scale), direction, normal);
    real last = distance_ / real(field.scale);
    r.ray.tMax = min(r.ray.tMax, last);
    int limit = turnLimit();
    for (int i = 0; i < limit && r.phase != kPhaseDone; ++i) turn(r);
    if (r.status == kMiss) return true;
    if (r.phase != kPhaseDone || r.surfel.probe == kNoProbe) return false;
    real away = length(r.ray.origin + r.t * r.ray.direction - vec3(probeHeader(r.surfel.probe).centre));
    return r.t >= last - real(2.0) * texelAngle() * away;
}

SCONCE_FN RayHit queryRay(vec3 origin, vec3 direction) { return queryRay(origin, direction, vec3(real(0.0))); }
