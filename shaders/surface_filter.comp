#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "surface_texels.glsl"

// Bake: a probe's surface light, blended with that of texels about it on the same surface. How far is bound by how near other surfaces are, of whose
// light and shadow the rays of few texels tell more than they know (the harmonic mean, as Ward, Rubinstein, Clear 1988).
// What comes straight from emitters and sky is blended only with what may be the same by its noise, so that the edges of shadows stay.
// Dispatch: ceil(surfaceSize/8) twice x 6.

const float kLikeNoise = 2.0;    // times the two variances, that a squared difference may be
const float kAlike = 0.02;       // relative difference that never shows

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index))
    {
        if (texel.x < field.surfaceSize && texel.y < field.surfaceSize) push.sent.word[index] = 0u;
        return;
    }
    SurfacePoint own = surfacePointAt(push.probe, int(texel.z), int(texel.x), int(texel.y));
    float reach = max(kReachOfDistance * push.first.value[index].w, kLeastReach * own.width); // what isn't known is filled from next to it
    bool known = push.first.value[index].w != kNotKnown;
    float ownFirst = luminance(push.first.value[index].xyz), ownVariance = push.light.value[index].w;
    vec3 bounced = vec3(0.0), straight = vec3(0.0);
    vec2 tilt = vec2(0.0);
    float weights = 0.0, straightWeights = 0.0;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
        {
            ivec2 at = ivec2(texel.xy) + ivec2(dx, dy);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(int(field.surfaceSize))))) continue;
            SurfacePoint other = surfacePointAt(push.probe, int(texel.z), at.x, at.y);
            uint there = surfaceIndex(push.probe, int(texel.z), at.x, at.y);
            vec4 first = push.first.value[there], light = push.light.value[there];
            if (first.w == kNotKnown || !isSameSurface(own.at, own.normal, other, kSurfaceBend)) continue;
            vec3 to = other.at - own.at;
            float weight = exp(-0.5 * dot(to, to) / (reach * reach));
            bounced += weight * (light.xyz - first.xyz);
            weights += weight;
            float theirs = luminance(first.xyz), off = theirs - ownFirst, slack = kAlike * max(theirs, ownFirst);
            if (known) weight *= exp(-off * off / max(2.0 * kLikeNoise * (ownVariance + light.w) + slack * slack, 1e-30));
            straight += weight * first.xyz;
            straightWeights += weight;
            if (field.surfaceDirections != 0u) tilt += weight * push.tilts.value[there].zw;
        }
    vec3 light = straightWeights > 0.0 ? bounced / weights + straight / straightWeights : vec3(0.0);
    push.sent.word[index] = straightWeights > 0.0 ? packKnownLight(light) : 0u;
    if (field.surfaceDirections != 0u)
        push.tilted.word[index] = packTilt(straightWeights > 0.0 ? tilt / (straightWeights * max(luminance(light), 1e-20)) : vec2(0.0));
}
