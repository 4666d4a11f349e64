#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SCENE_SET 1
#include "light_field.glsl"
#include "lights.glsl"
#include "shared/sample_pair.h"
#include "surface_texels.glsl"

// Bake: what a texel of the surface light gets straight from emitters and sky, and where its other light comes from. Cosine-weighted rays go from
// its surface through the light field: the sky's light is that of those that leave the scene; of the others the texel where each ended is kept,
// so that bounces need no ray. Emitters are sampled by shadow rays to samples drawn by how much they would give unshadowed (resampled importance
// sampling, Talbot et al. 2005), systematically along the list.
// Dispatch: ceil(surfaceSize/8) twice x 6.

const uint kGatherStream = 6u, kShadowStream = 7u, kLinkStream = 8u;

/// A texel that shows where a ray ended, drawn among the four about it by their weights; else the nearest of the same surface; else none.
uint linkOf(TraceResult hit, float lot)
{
    float half_ = 0.5 * float(field.faceSize);
    vec2 off = hit.pixel - floor(hit.pixel) - 0.5;
    float q = halfToReal(hit.word) * (1.0 + unpackGradient(hit.word >> 16) * off.x + unpackGradient(hit.word >> 24) * off.y);
    if (!(q > 0.0)) return kLinkNone;
    vec3 point = faceDirection(hit.face, vec3(hit.pixel / half_ - 1.0, 1.0)) / q;
    vec3 normal = texelNormal(hit.face, hit.pixel, hit.word);
    vec2 at = hit.pixel * (float(field.surfaceSize) / float(field.faceSize)) - 0.5;
    ivec2 low = clamp(ivec2(floor(at)), ivec2(0), ivec2(int(field.surfaceSize) - 2));
    vec2 f = clamp(at - vec2(low), vec2(0.0), vec2(1.0));
    uint found = kLinkNone;
    float weights = 0.0, best = 1e30;
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
    if (found == kLinkNone) found = nearestSurfaceTexel(hit.probe, point, normal);
    return found == kNoTexel ? kLinkNone : found;
}

const int kNearbySteps = 3;       // of a distance texel's width each
const float kNearbySlack = 0.1;   // widths that a packed plane may be off by
const float kNearbyThickest = 2.0; // widths

/// Whether a ray meets a surface within its first texels: whether it goes from before to just behind a plane that the texel's own probe sees there.
/// A tracer whose first texel is that of the start can't tell the foot of a wall from its own surface, and walls of a centimetre leaked at corners.
/// @param from  relative to the probe's centre; `hit` is set where it is met
bool meetsNearby(vec3 from, vec3 direction, inout TraceResult hit)
{
    float width = length(from) * 2.0 / float(field.faceSize), half_ = 0.5 * float(field.faceSize);
    for (int i = 1; i <= kNearbySteps; ++i)
    {
        vec3 at = from + float(i) * width * direction;
        vec3 plane = planeSeen(push.probe, at);
        float size = length(plane);
        float behind = (dot(plane, at) - 1.0) / max(size, 1e-12), before = (1.0 - dot(plane, from)) / max(size, 1e-12);
        if (!(size > 0.0) || behind < kNearbySlack * width || behind > kNearbyThickest * width || before < kNearbySlack * width) continue;
        int face = dominantFace(at);
        vec3 uvw = faceCoordinates(face, at);
        hit.probe = push.probe;
        hit.face = face;
        hit.pixel = clamp(half_ * (uvw.xy / uvw.z + 1.0), vec2(0.0), vec2(2.0 * half_ - 0.001));
        hit.word = distanceWord(mapWords(push.probe, face) + uint(hit.pixel.y) * field.faceSize + uint(hit.pixel.x));
        hit.t = float(i) * width;
        hit.status = kHit;
        return true;
    }
    return false;
}

/// Mean over the hemisphere of the radiance that comes straight from emitters.
vec3 emittersAt(vec3 point, vec3 normal, vec3 geometric, uvec2 pixel)
{
    uint begin = lightsHeader.deltaCount, end = begin + lightsHeader.emitterCount;
    float total = 0.0;
    for (uint i = begin; i < end; ++i)
    {
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        if (dot(geometric, s.toLight) > 0.0) total += max(dot(normal, s.toLight), 0.0) * dot(s.irradiance, vec3(0.2126, 0.7152, 0.0722));
    }
    if (!(total > 0.0)) return vec3(0.0);
    uint drawn[kMostShadowRays];
    uint count = 0u;
    float step = total / float(push.shadowRays), next = randomPair(pixel, 0u, kShadowStream, seedOfProbe()).x * step, passed = 0.0;
    for (uint i = begin; i < end; ++i)
    {
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        if (!(dot(geometric, s.toLight) > 0.0)) continue;
        passed += max(dot(normal, s.toLight), 0.0) * dot(s.irradiance, vec3(0.2126, 0.7152, 0.0722));
        for (; passed > next && count < push.shadowRays; next += step) drawn[count++] = i;
    }
    vec3 sum = vec3(0.0);
    uint before = kNoProbe;
    bool reached = false;
    for (uint k = 0u; k < count; ++k)
    {
        uint i = drawn[k];
        LightSample s = unshadowedLight(kLightEmitter, i, point);
        vec3 start = field.origin + field.scale * point;
        if (i != before) reached = lightReaches(start, s.toLight, distance(lights[i].position, point) * field.scale, geometric);
        before = i;
        if (reached) sum += s.irradiance / max(dot(s.irradiance, vec3(0.2126, 0.7152, 0.0722)), 1e-30);
    }
    return sum * step / kBrdfPi;
}

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index)) return;
    SurfacePoint surface = surfacePointAt(push.probe, int(texel.z), int(texel.x), int(texel.y));
    vec3 normal = unpackNormal8(push.texels.value[index].normal);
    // Off the surface by what the distance of its texel is packed to, besides.
    vec3 point = probeHeader(push.probe).centre + surface.at + (push.offset + 5e-4 * length(surface.at)) * surface.normal;
    uvec2 pixel = texel.xy + uvec2(field.surfaceSize * texel.z, 0u);
    uint seed = seedOfProbe();
    TangentFrame tangents = tangentFrame(normal);
    vec3 sky = vec3(0.0);
    float known = 0.0, nearness = 0.0;
    for (uint i = 0u; i < push.rays; ++i)
    {
        uint sampled = i & ((1u << kSampleBits) - 1u), round_ = i >> kSampleBits;
        vec3 direction = normalize(toWorld(tangents, sampleCosine(randomPair(pixel, sampled, kGatherStream, seed + 2654435769u * round_))));
        uint link = kLinkNone;
        if (dot(direction, surface.normal) > 0.0)
        {
            TraceResult hit;
            if (!meetsNearby(point - probeHeader(push.probe).centre, direction, hit)) hit = traceRay(point, direction, surface.normal);
            if (hit.status == kMiss) link = kLinkSky;
            else if (hit.status == kHit) link = linkOf(hit, randomPair(pixel, sampled, kLinkStream, seed + 2654435769u * round_).x);
            nearness += 1.0 / max(hit.t, 1e-6);
        }
        push.links.word[i * texelsOfProbe() + ofProbe] = link;
        if (link != kLinkNone) known += 1.0;
        if (link == kLinkSky) sky += field.sky;
    }
    vec3 light = sky / max(known, 1.0);
    if (lightsHeader.emitterCount > 0u) light += emittersAt(point, normal, surface.normal, pixel);
    push.first.value[index] = vec4(light, float(push.rays) / max(nearness, 1e-6));
}
