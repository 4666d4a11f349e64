#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"
#include "packed_pixel.glsl"
#include "tiles.glsl"

// Blends a term's light with what the frame before had for the same point (McGuire et al. 2017, section 5.1, reproject likewise; Karis 2014,
// "High Quality Temporal Supersampling", for the clamp to the neighbourhood). A smooth surface's light is followed where its reflection
// moves: at the mirrored hit's image behind the surface, or at the hit itself where the ray came back. Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(constant_id = kMovingId) const bool kMoving = false; // what reflections show may move while the eye is still
layout(set = 1, binding = kBlendLightBinding, rgba16f) uniform image2D light;              // rgb; a: of the glossy term the distance of the hit, metres
layout(set = 1, binding = kBlendBeforeBinding) uniform texture2D before;    // rgb, a: frames blended
layout(set = 1, binding = kBlendPointsBeforeBinding) uniform utexture2D pointsBefore;
layout(set = 1, binding = kBlendAfterBinding, rgba16f) writeonly uniform image2D after;
layout(set = 1, binding = kBlendPointsAfterBinding, r32ui) writeonly uniform uimage2D pointsAfter; // distance to the eye, metres, a half float; normal of 2 x 8 bits; 0 where the pixel had no such light

const float kLongest = 32.0;     // frames a history counts for: 97 % of a still picture is the past (the paper: 98 %)
const float kLongestFollowed = 8.0; // of a sharp reflection that moves: 88 % (the paper: 75 %)
const float kSharpBelow = 0.25;     // roughness
const float kStill = 0.02;          // pixels that a point may be off by where nothing moves
const int kBentOver = 4;            // pixels to each side, over which a surface's bend is asked
const float kBent = 0.012;          // by how much normals that far apart differ at least: three steps of packed ones
const float kMostMagnified = 4.0;   // times as far as the hit its image may lie: of hollow mirrors anywhere

/// Mean and deviation of the term's light in the 3x3 pixels about one.
void neighbourhood(ivec2 at, out vec3 mean, out vec3 deviation)
{
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    float count = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
        {
            ivec2 tap = clamp(at + ivec2(dx, dy), ivec2(0), ivec2(frame.size) - 1);
            if ((termsAt(tap) & (1u << kTerm)) == 0u) continue;
            vec3 value = imageLoad(light, tap).rgb;
            sum += value;
            squares += value * value;
            count += 1.0;
        }
    mean = sum / max(count, 1.0);
    deviation = sqrt(max(squares / max(count, 1.0) - mean * mean, vec3(0.0)));
}

/// The frame before at a point of its picture, of those pixels that showed the same surface; a: frames blended, 0 where none did.
vec4 history(vec2 pixel, float distanceBefore, vec3 normal)
{
    distanceBefore = min(distanceBefore, 65504.0); // as halves keep it
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    ivec2 low = ivec2(floor(pixel - 0.5));
    vec2 f = pixel - 0.5 - vec2(low);
    for (int i = 0; i < 4; ++i)
    {
        ivec2 tap = low + ivec2(i & 1, i >> 1);
        if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(frame.size)))) continue;
        uint point = texelFetch(pointsBefore, tap, 0).x;
        if (point == 0u) continue;
        bool sameDepth = abs(halfToReal(point) - distanceBefore) < 0.02 * distanceBefore;
        if (!sameDepth || dot(unpackNormal8(point >> 16), normal) < 0.9) continue;
        float weight = ((i & 1) != 0 ? f.x : 1.0 - f.x) * ((i >> 1) != 0 ? f.y : 1.0 - f.y);
        sum += weight * texelFetch(before, tap, 0);
        weights += weight;
    }
    return weights > 0.05 ? sum / weights : vec4(0.0);
}

vec4 clipBefore(vec3 point) { return frame.clipFromWorldBefore * vec4(point, 1.0); }
vec2 pixelOf(vec2 ndc) { return (0.5 * ndc + 0.5) * vec2(frame.size); }

/// How a surface is bent along a way over the picture, 1/metres; positive: towards the eye; 0 where it is flat, as far as normals tell.
float bendAlong(ivec2 at, vec2 way)
{
    if (dot(way, way) < kStill * kStill) return 0.0; // nothing asks
    float bend = 0.0;
    for (int axis = 0; axis < 2; ++axis)
    {
        ivec2 to = axis == 0 ? ivec2(kBentOver, 0) : ivec2(0, kBentOver), last = ivec2(frame.size) - 1;
        Pixel a = readPacked(clamp(at - to, ivec2(0), last)), b = readPacked(clamp(at + to, ivec2(0), last));
        vec3 turn = b.normal - a.normal, along = b.position - a.position;
        if (a.surface && b.surface && dot(turn, turn) > kBent * kBent)
            bend += dot(turn, along) / dot(along, along) * way[axis] * way[axis] / dot(way, way);
    }
    return bend;
}

void main()
{
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    uint terms;
    Pixel p = readPacked(at, terms);
    if ((terms & (1u << kTerm)) == 0u) return;
    vec4 own = imageLoad(light, at);
    vec4 past = vec4(0.0);
    bool sharp = kTerm == kTermGlossy && p.brdf.roughness < kSharpBelow;
    bool moves = false, guessed = false; // a sharp reflection; where it was, for on a bent surface it has no one place
    if (frame.follows != 0u)
    {
        float along = 0.0; // metres towards the eye, from the surface to what is followed
        if (sharp && p.retro)
            along = own.a;
        else if (sharp)
        {
            vec4 clip = clipBefore(p.position);
            float bend = bendAlong(at, pixelOf(clip.xy / clip.w) - vec2(at) - 0.5);
            float nearer = 1.0 + 2.0 * own.a * bend; // the mirror's equation, for light along its axis; below 0: before a hollow one
            along = -own.a / (nearer < 0.0 ? min(nearer, -1.0 / kMostMagnified) : max(nearer, 1.0 / kMostMagnified));
            guessed = bend != 0.0;
        }
        vec4 clip = clipBefore(p.position + along * normalize(frame.eye - p.position));
        // Where a ray came back past the eye, the surface is where the line from its hit through the eye goes on: w is below 0.
        vec2 ndc = clip.xy / clip.w;
        if ((clip.w > 0.0 || p.retro) && max(abs(ndc.x), abs(ndc.y)) < 2.0) // not where w is 0
        {
            past = history(pixelOf(ndc), distance(p.position, frame.eyeBefore), p.normal);
            moves = sharp && (kMoving || distance(pixelOf(ndc), vec2(at) + 0.5) > kStill);
        }
    }
    // Elsewhere a clamp would only cut off what few rays of many find, as lamps in a lobe's tail.
    if (moves && (guessed || kMoving))
    {
        vec3 mean, deviation;
        neighbourhood(at, mean, deviation);
        past.rgb = clamp(past.rgb, mean - 3.0 * deviation, mean + 3.0 * deviation);
    }
    float frames = min(past.a + 1.0, moves ? kLongestFollowed : kLongest);
    if (frame.follows > 1u) frames = min(frames, float(frame.follows));
    vec3 blended = mix(past.rgb, own.rgb, 1.0 / frames);
    // By lot, for a share of 1/32 of what is new is less than a half float's step, and would be lost each frame.
    imageStore(after, at, storedLight(vec4(blended, frames), randomPair(uvec2(at), 0u, 6u, frame.seed).x));
    imageStore(pointsAfter, at, uvec4(realToHalf(distance(p.position, frame.eye)) | (packNormal8(p.normal) << 16)));
}
