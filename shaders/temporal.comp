#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"
#include "packed_pixel.glsl"
#include "tiles.glsl"

// Blends a term's light with what the frame before had for the same point (McGuire et al. 2017, section 5.1, reproject likewise; Karis 2014,
// "High Quality Temporal Supersampling", for the clamp to the neighbourhood). A smooth surface's light is followed where its reflection
// moves: at the mirrored hit behind the surface, as far as the ray went. Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTermId) const uint kTerm = kTermGlossy;
layout(set = 1, binding = kBlendLightBinding, rgba16f) uniform image2D light;              // rgb; a: of the glossy term the distance of the hit, metres
layout(set = 1, binding = kBlendBeforeBinding) uniform texture2D before;    // rgb, a: frames blended
layout(set = 1, binding = kBlendPointsBeforeBinding) uniform utexture2D pointsBefore;
layout(set = 1, binding = kBlendAfterBinding, rgba16f) writeonly uniform image2D after;
layout(set = 1, binding = kBlendPointsAfterBinding, r32ui) writeonly uniform uimage2D pointsAfter; // distance to the eye, metres, a half float; normal of 2 x 8 bits; 0 where the pixel had no such light

const float kLongest = 32.0;     // frames a history counts for: 97 % of a still picture is the past (the paper: 98 %)
const float kLongestGlossy = 8.0; // of a sharp reflection: 88 % (the paper: 75 %)

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

void main()
{
    ivec2 at;
    if (!findPixel(kTerm, at)) return;
    uint terms;
    Pixel p = readPacked(at, terms);
    if ((terms & (1u << kTerm)) == 0u) return;
    vec4 own = imageLoad(light, at);
    vec4 past = vec4(0.0);
    bool sharp = kTerm == kTermGlossy && p.brdf.roughness < 0.25;
    if (frame.follows != 0u)
    {
        vec3 seen = sharp ? p.position - own.a * normalize(frame.eye - p.position) : p.position; // the hit, mirrored: on the line of sight, behind the surface
        vec4 clip = frame.clipFromWorldBefore * vec4(seen, 1.0);
        if (clip.w > 0.0)
            past = history((0.5 * clip.xy / clip.w + 0.5) * vec2(frame.size), distance(p.position, frame.eyeBefore), p.normal);
    }
    if (sharp) // where reflections go is a guess. Elsewhere a clamp would only cut off what few rays of many find: the light itself is still
    {
        vec3 mean, deviation;
        neighbourhood(at, mean, deviation);
        past.rgb = clamp(past.rgb, mean - 3.0 * deviation, mean + 3.0 * deviation);
    }
    float frames = min(past.a + 1.0, sharp ? kLongestGlossy : kLongest);
    if (frame.follows > 1u) frames = min(frames, float(frame.follows));
    vec3 blended = mix(past.rgb, own.rgb, 1.0 / frames);
    // By lot, for a share of 1/32 of what is new is less than a half float's step, and would be lost each frame.
    imageStore(after, at, storedLight(vec4(blended, frames), randomPair(uvec2(at), 0u, 6u, frame.seed).x));
    imageStore(pointsAfter, at, uvec4(realToHalf(distance(p.position, frame.eye)) | (packNormal8(p.normal) << 16)));
}
