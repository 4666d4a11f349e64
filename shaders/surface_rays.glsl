// What shared/surface_gather.h asks, answered by rays through the light field. After the light field and `push`, a SurfacePush.
#include "lights.glsl"
#include "gathered_rays.glsl"

/// A texel that shows where a ray ended.
uint linkOf(TraceResult hit, float lot)
{
    float half_ = 0.5 * float(field.faceSize);
    vec2 off = hit.pixel - floor(hit.pixel) - 0.5;
    float q = halfToReal(hit.word) * (1.0 + unpackGradient(hit.word >> 16) * off.x + unpackGradient(hit.word >> 24) * off.y);
    if (!(q > 0.0)) return kLinkSurface;
    return texelShowing(hit.probe, faceDirection(hit.face, vec3(hit.pixel / half_ - 1.0, 1.0)) / q, texelNormal(hit.face, hit.pixel, hit.word), lot);
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
        hit.word = texelWord(mapWords(probe, face), uint(hit.pixel.x), uint(hit.pixel.y));
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
uint endThroughField(vec3 point, vec3 direction, vec3 normal, vec2 lots, out float t)
{
    TraceResult hit = traceRay(point, direction, normal);
    t = hit.t;
    if (hit.status == kUnknown) return kLinkNone;
    bool back = comesBack(point, direction, hit);
    if (hit.status == kMiss) return back || lots.y < kSkyOfOneWay ? kLinkSky : kLinkSurface;
    return back ? linkOf(hit, lots.x) : kLinkSurface;
}

bool isNearPatch(float d2, float area) { return false; } // the field doesn't tell what emits
float discOf(float area) { return area; }
uint gatherRays() { return push.rays; }
uint shadowRays() { return push.shadowRays; }
bool emitterReaches(vec3 point, vec3 toLight, float distance_, vec3 plane)
{
    return lightReaches(field.origin + field.scale * point, toLight, distance_ * field.scale, plane);
}
