// Light of a field's lamps (shared/lamps.h) at a place. Field space. After light_field.glsl.
#include "shared/brdf.h"
#include "shared/polygon_light.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer SconceLamps { Lamp value[]; };
Lamp lampAt(uint i) { return SconceLamps(lampAddress).value[i]; }
uint lampWord(uint index) { return SconceWords(lampAddress).word[index]; }

const int kShadowTaps = 32;        // in the disc that a lamp is, seen from the place past what stands before it
const float kGoldenAngle = 2.39996323;
const float kLampSteepest = 0.03;  // cosine of a plane to the light below which it counts as no steeper
const float kLampSlack = 0.1;      // texels, along a plane and towards the lamp, that its depth may be off by
const float kLampNearest = 0.7;    // texels that an edge is wide at least

float lampDepth(Lamp lamp, uint packed)
{
    return packed == kLampFar ? 1e30 : lamp.near + (lamp.far - lamp.near) * (float(packed) / float(kLampFar - 1u));
}

/// A receiver as a lamp's map sees it.
struct Receiver
{
    vec3 at;       // tangents, depth
    vec3 inverse;  // 1/depth of its plane is dot(inverse, (tangents, 1))
    float slack;   // field units of depth
};

/// How far before the plane a depth must be to shade it, at these tangents.
float depthOfPlane(Receiver r, vec2 tangents)
{
    float inverse = dot(r.inverse, vec3(tangents, 1.0));
    return (inverse > 0.0 ? 1.0 / inverse : 1e30) - r.slack;
}

/// By how far at most, as tangents, what shades a part of the lamp is off the way to its middle: similar triangles.
float reachAt(Lamp lamp, Receiver r, float depth) { return lamp.reach * max(1.0 / depth - 1.0 / r.at.z, 0.0); }

/// Of the blocks of a level of the map within `reach` of the receiver.
struct Blockers
{
    float nearness; // sum of the reciprocal depths of those that may shade it
    float count;    // of these
    float least;    // depth of these
    bool closed;    // every block is wholly before it
};
Blockers blockersOf(Lamp lamp, Receiver r, uint level, float reach)
{
    uint blockLog = 3u * level, blocks = lamp.size >> blockLog;
    uint first = lamp.firstWord + lamp.size * lamp.size / 2u + (level > 1u ? (lamp.size >> 3) * (lamp.size >> 3) : 0u);
    vec2 texel = 1.0 / lamp.perTangent, width = float(1u << blockLog) * texel;
    // The plane's depth is greatest at one of a block's corners, and least at the other.
    vec2 farther = 0.5 * width * mix(vec2(1.0), vec2(-1.0), greaterThan(r.inverse.xy, vec2(0.0)));
    ivec2 low = max(ivec2(floor((r.at.xy - reach - lamp.low) / width)), ivec2(0)), high = min(ivec2((r.at.xy + reach - lamp.low) / width), ivec2(blocks) - 1);
    Blockers found = Blockers(0.0, 0.0, 1e30, true);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
        {
            uint word = lampWord(first + uint(y) * blocks + uint(x));
            float depth = lampDepth(lamp, word & 0xffffu);
            vec2 middle = lamp.low + (vec2(x, y) + 0.5) * width;
            found.closed = found.closed && lampDepth(lamp, word >> 16) < depthOfPlane(r, middle - farther);
            vec2 off = max(abs(middle - r.at.xy) - 0.5 * width, vec2(0.0));
            bool isBefore = depth < depthOfPlane(r, middle + farther) && all(lessThanEqual(off, reachAt(lamp, r, depth) + texel));
            found.nearness += isBefore ? 1.0 / depth : 0.0;
            found.count += isBefore ? 1.0 : 0.0;
            found.least = isBefore ? min(found.least, depth) : found.least;
        }
    return found;
}

/// What shades a place from a lamp.
struct LampShade
{
    Receiver receiver;
    float seen; // share of the lamp; negative: not known, for its edge is near, and `disc` is
    vec2 disc;  // that the lamp is, from the place past what stands before it, tangents
};

/// Cost: 4 reads where nothing near is before the lamp, else some 10 to 30.
/// @param plane  unit, the surface's own normal
LampShade lampShade(Lamp lamp, vec3 point, vec3 plane)
{
    LampShade shade;
    shade.seen = 0.0;
    shade.disc = vec2(0.0);
    vec3 from = point - lamp.centre;
    Receiver r;
    r.at = vec3(dot(from, lamp.axisX), dot(from, lamp.axisY), dot(from, lamp.normal));
    r.at.xy /= r.at.z;
    vec2 inMap = (r.at.xy - lamp.low) * lamp.perTangent, texel = 1.0 / lamp.perTangent;
    vec3 n = vec3(dot(plane, lamp.axisX), dot(plane, lamp.axisY), dot(plane, lamp.normal)), along = vec3(r.at.xy, 1.0);
    float facing = -dot(n, along) / length(along);
    if (!(r.at.z > 0.0) || any(lessThan(inMap, vec2(0.0))) || any(greaterThanEqual(inMap, vec2(lamp.size))) || !(facing > 0.0)) return shade;
    n -= along * (max(kLampSteepest - facing, 0.0) / length(along));
    r.inverse = n / (dot(n, along) * r.at.z);
    r.slack = 2.0 * (lamp.far - lamp.near) / float(kLampFar - 1u) +
              kLampSlack * r.at.z * (r.at.z * dot(abs(r.inverse.xy), texel) + max(texel.x, texel.y));
    shade.receiver = r;
    shade.seen = 1.0;
    Blockers coarse = blockersOf(lamp, r, 2u, reachAt(lamp, r, max(lamp.near, 1e-6)));
    if (!(coarse.count > 0.0)) return shade;
    Blockers found = blockersOf(lamp, r, 1u, max(reachAt(lamp, r, coarse.least), kLampNearest * max(texel.x, texel.y)));
    if (!(found.count > 0.0)) return shade;
    shade.seen = found.closed ? 0.0 : -1.0;
    shade.disc = max(vec2(reachAt(lamp, r, found.count / found.nearness)), kLampNearest * texel);
    return shade;
}

/// Whether a texel of the map is before the receiver, 1, or not.
float isShadedBy(Lamp lamp, Receiver r, vec2 at)
{
    uvec2 texel = uvec2(clamp(at, vec2(0.0), vec2(lamp.size - 1u)));
    uint word = lampWord(lamp.firstWord + (texel.y * lamp.size + texel.x) / 2u);
    float depth = lampDepth(lamp, (texel.x & 1u) != 0u ? word >> 16 : word & 0xffffu);
    return depth < depthOfPlane(r, lamp.low + (vec2(texel) + 0.5) / lamp.perTangent) ? 1.0 : 0.0;
}

/// Share of a lamp that a place sees where lampShade() doesn't know. Blended over four texels a tap: near edges are a few texels wide, and would have
/// steps. Cost: 128 reads.
float seenOfLamp(Lamp lamp, LampShade shade)
{
    Receiver r = shade.receiver;
    float shaded = 0.0;
    for (int i = 0; i < kShadowTaps; ++i)
    {
        float angle = float(i) * kGoldenAngle; // Vogel's spiral, even over the disc
        vec2 off = sqrt((float(i) + 0.5) / float(kShadowTaps)) * vec2(cos(angle), sin(angle)) * shade.disc;
        vec2 tap = (r.at.xy + off - lamp.low) * lamp.perTangent - 0.5, low = floor(tap), f = tap - low;
        shaded += mix(mix(isShadedBy(lamp, r, low), isShadedBy(lamp, r, low + vec2(1.0, 0.0)), f.x),
                      mix(isShadedBy(lamp, r, low + vec2(0.0, 1.0)), isShadedBy(lamp, r, low + 1.0), f.x), f.y);
    }
    return 1.0 - shaded / float(kShadowTaps);
}

/// Share of a lamp that a place sees: soft shadows by the disc of what stands before it (Fernando 2005, "Percentage-Closer Soft Shadows"), whose
/// width is of what is before the lamp by its own depth (Guennebaud, Barthe and Paulin 2006, "Real-time Soft Shadow Mapping by Backprojection"), found
/// by least and most depths of blocks. No noise.
float lampVisibility(Lamp lamp, vec3 point, vec3 plane)
{
    LampShade shade = lampShade(lamp, point, plane);
    return shade.seen < 0.0 ? seenOfLamp(lamp, shade) : shade.seen;
}

struct LampCorners
{
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 d;
};
LampCorners cornersFrom(Lamp lamp, vec3 point, TangentFrame tangents)
{
    return LampCorners(toTangent(tangents, lamp.corner[0] - point), toTangent(tangents, lamp.corner[1] - point), toTangent(tangents, lamp.corner[2] - point),
                       toTangent(tangents, lamp.corner[3] - point));
}

/// Irradiance of a surface from all lamps, W/m^2.
vec3 lampIrradiance(vec3 point, vec3 normal, vec3 plane)
{
    TangentFrame tangents = tangentFrame(normal);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < lampCount; ++i)
    {
        Lamp lamp = lampAt(i);
        LampCorners c = cornersFrom(lamp, point, tangents);
        float given = polygonIrradiance(c.a, c.b, c.c, c.d);
        if (given > 0.0) sum += lamp.radiance * (given * lampVisibility(lamp, point, plane));
    }
    return sum;
}

/// Mean of the radiance that arrives at a surface of the world straight from the field's lamps, weighted by the cosine, with their shadows: what
/// sconceLightAt() leaves out. Cost: none without lamps, else 4 to 160 reads each.
/// @param normal, facing  as sconceLightAt()
vec3 sconceLampLightAt(vec3 point, vec3 normal, vec3 facing)
{
    return lampCount > 0u ? lampIrradiance(sconceFieldPoint(point), normal, facing) / kBrdfPi : vec3(0.0);
}

/// Whether a place is a lamp's own surface, which shines by itself.
/// @param distance_  to who sees it, whose packing it may be off by
/// @param width      that it may be off along the surface
bool isOfLamp(vec3 point, float distance_, float width)
{
    for (uint i = 0u; i < lampCount; ++i)
    {
        Lamp lamp = lampAt(i);
        if (abs(dot(point - lamp.centre, lamp.normal)) > 2e-3 * distance_) continue;
        bool inside = true;
        for (int k = 0; k < 4; ++k)
        {
            vec3 edge = lamp.corner[(k + 1) & 3] - lamp.corner[k];
            inside = inside && dot(cross(edge, point - lamp.corner[k]), lamp.normal) >= -width * length(edge);
        }
        if (inside) return true;
    }
    return false;
}
