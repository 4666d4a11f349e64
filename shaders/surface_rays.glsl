// Rays that gather light at a place through the light field: what they end at, and what emitters give. After the light field and `push`, a SurfacePush.
#include "lights.glsl"
#include "gathered_rays.glsl"

const float kLeastKnown = 0.5; // share of the rays whose end must be known
const uint kShadowStream = 7u, kLinkStream = 8u;

/// A texel that shows where a ray ended, drawn among the four about it by their weights; else the nearest of the same surface; else kLinkSurface.
uint linkOf(TraceResult hit, float lot)
{
    float half_ = 0.5 * float(field.faceSize);
    vec2 off = hit.pixel - floor(hit.pixel) - 0.5;
    float q = halfToReal(hit.word) * (1.0 + unpackGradient(hit.word >> 16) * off.x + unpackGradient(hit.word >> 24) * off.y);
    if (!(q > 0.0)) return kLinkSurface;
    vec3 point = faceDirection(hit.face, vec3(hit.pixel / half_ - 1.0, 1.0)) / q;
    vec3 normal = texelNormal(hit.face, hit.pixel, hit.word);
    vec2 at = hit.pixel * (float(field.surfaceSize) / float(field.faceSize)) - 0.5;
    ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(int(field.surfaceSize) - 2));
    vec2 f = clamp(at - vec2(low), vec2(0.0), vec2(1.0));
    uint found = kLinkSurface;
    float weights = 0.0;
    for (int tap = 0; tap < 4; ++tap)
    {
        ivec2 texel = low + ivec2(tap & 1, tap >> 1);
        float weight = ((tap & 1) != 0 ? f.x : 1.0 - f.x) * ((tap >> 1) != 0 ? f.y : 1.0 - f.y);
        if (!(weight > 0.0) || !isSameSurface(point, normal, surfacePointAt(hit.probe, hit.face, texel.x, texel.y), kSurfaceBend)) continue;
        weights += weight;
        float share = weight / weights;
        if (lot < share)
        {
            found = surfaceIndex(hit.probe, hit.face, texel.x, texel.y);
            lot /= share;
        }
        else lot = (lot - share) / (1.0 - share);
    }
    if (found != kLinkSurface) return found;
    found = nearestSurfaceTexel(hit.probe, point, normal);
    return found == kNoTexel ? kLinkSurface : found;
}

const int kNearbySteps = 3;       // of a distance texel's width each
const float kOffSurface = 1e-3;   // of the distance to the probe, that a ray starts off a surface that it sees
const float kNearbySlack = 0.1;   // widths that a packed plane may be off by
const float kNearbyThickest = 2.0; // widths

/// Whether a ray meets a surface within its first texels: whether it goes from before to just behind a plane that the texel's own probe sees there.
/// A tracer whose first texel is that of the start can't tell the foot of a wall from its own surface, and walls of a centimetre leaked at corners.
/// @param from  relative to the probe's centre; `hit` is set where it is met
bool meetsNearby(uint probe, vec3 from, vec3 direction, inout TraceResult hit)
{
    float width = length(from) * 2.0 / float(field.faceSize), half_ = 0.5 * float(field.faceSize);
    for (int i = 1; i <= kNearbySteps; ++i)
    {
        vec3 at = from + float(i) * width * direction;
        vec3 plane = planeSeen(probe, at);
        float size = length(plane);
        float behind = (dot(plane, at) - 1.0) / max(size, 1e-12), before = (1.0 - dot(plane, from)) / max(size, 1e-12);
        if (!(size > 0.0) || behind < kNearbySlack * width || behind > kNearbyThickest * width || before < kNearbySlack * width) continue;
        int face = dominantFace(at);
        vec3 uvw = faceCoordinates(face, at);
        hit.probe = probe;
        hit.face = face;
        hit.pixel = clamp(half_ * (uvw.xy / uvw.z + 1.0), vec2(0.0), vec2(2.0 * half_ - 0.001));
        hit.word = distanceWord(mapWords(probe, face) + uint(hit.pixel.y) * field.faceSize + uint(hit.pixel.x));
        hit.t = float(i) * width;
        hit.status = kHit;
        return true;
    }
    return false;
}

// A ray that changed probes counts only where it comes back to its start when traced from its end: half of the few that pass a wall are found so, and
// of the others one in two hundred. Against Embree in Sponza, temple and modern_hall, of those from the sky that don't come back 0.27, 0.72 and
// 0.68 do see it, of those from surfaces 0.002 to 0.014. So the former stand for sky by half, and the latter for a surface: left out, they would
// count as the mean of all that is seen, sky and all, by which Sponza had 2 % too much of its sky.
const float kSkyOfOneWay = 0.5;

/// Whether a ray comes back to its start.
bool comesBack(vec3 point, vec3 direction, TraceResult hit)
{
    if (hit.handoffs == 0) return true;
    vec3 end = point + hit.t * direction, there = vec3(0.0);
    if (hit.status == kHit)
    {
        there = texelNormal(hit.face, hit.pixel, hit.word);
        end += kOffSurface * length(end - probeHeader(hit.probe).centre) * there;
    }
    return lightReaches(field.origin + field.scale * end, -direction, hit.t * field.scale, there);
}

/// What a ray through the field ends at.
/// @param lots  two even random numbers
uint endOfRay(vec3 point, vec3 direction, vec3 normal, vec2 lots, out float t)
{
    TraceResult hit = traceRay(point, direction, normal);
    t = hit.t;
    if (hit.status == kUnknown) return kLinkNone;
    bool back = comesBack(point, direction, hit);
    if (hit.status == kMiss) return back || lots.y < kSkyOfOneWay ? kLinkSky : kLinkSurface;
    return back ? linkOf(hit, lots.x) : kLinkSurface;
}

/// Variance of a share of tries that came out; as if half a try more had and half a one hadn't, since none of a few is not none of all.
float varianceOfShare(float came, float tries)
{
    float share = (came + 0.5) / (tries + 1.0);
    return share * (1.0 - share) / max(tries, 1.0);
}

/// Mean over the hemisphere of the radiance that comes straight from emitters.
/// @param variance  of its luminance, by chance; `tilt`: of its luminance, along the plane
vec3 emittersAt(vec3 point, vec3 normal, vec3 geometric, uvec2 pixel, out float variance, out vec3 tilt)
{
    variance = 0.0;
    tilt = vec3(0.0);
    uint begin = lightsHeader.deltaCount, end = begin + lightsHeader.emitterCount;
    float total = 0.0;
    for (uint i = begin; i < end; ++i)
    {
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        if (dot(geometric, s.toLight) > 0.0) total += max(dot(normal, s.toLight), 0.0) * luminance(s.irradiance);
    }
    if (!(total > 0.0)) return vec3(0.0);
    uint drawn[kMostShadowRays];
    uint count = 0u;
    float step = total / float(push.shadowRays), next = randomPair(pixel, 0u, kShadowStream, 0u).x * step, passed = 0.0;
    for (uint i = begin; i < end; ++i)
    {
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        if (!(dot(geometric, s.toLight) > 0.0)) continue;
        passed += max(dot(normal, s.toLight), 0.0) * luminance(s.irradiance);
        for (; passed > next && count < push.shadowRays; next += step) drawn[count++] = i;
    }
    vec3 sum = vec3(0.0);
    uint before = kNoProbe;
    bool reached = false;
    float arrived = 0.0;
    for (uint k = 0u; k < count; ++k)
    {
        uint i = drawn[k];
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        vec3 start = field.origin + field.scale * point;
        if (i != before) reached = lightReaches(start, s.toLight, distance(lights[i].position, point) * field.scale, geometric);
        before = i;
        if (!reached) continue;
        arrived += 1.0;
        sum += s.irradiance / max(luminance(s.irradiance), 1e-30);
        tilt += slopeOf(s.toLight, normal);
    }
    tilt *= step / kBrdfPi;
    variance = total * total / (kBrdfPi * kBrdfPi) * varianceOfShare(arrived, float(count));
    return sum * step / kBrdfPi;
}

