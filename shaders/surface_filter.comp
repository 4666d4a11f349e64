#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "surface_texels.glsl"

// Bake: a probe's surface light, blended with that of texels about it on the same surface. How far is bound by how near other surfaces are, of whose
// light and shadow the rays of few texels tell more than they know (the harmonic mean, as Ward, Rubinstein, Clear 1988).
// Dispatch: ceil(surfaceSize/8) twice x 6.

const float kReachOfDistance = 0.12, kLeastReach = 0.3; // of the harmonic mean; of a texel's width

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
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
        {
            ivec2 at = ivec2(texel.xy) + ivec2(dx, dy);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(int(field.surfaceSize))))) continue;
            SurfacePoint other = surfacePointAt(push.probe, int(texel.z), at.x, at.y);
            if (push.first.value[surfaceIndex(push.probe, int(texel.z), at.x, at.y)].w == kNotKnown || !isSameSurface(own.at, own.normal, other, kSurfaceBend))
                continue;
            vec3 to = other.at - own.at;
            float weight = exp(-0.5 * dot(to, to) / (reach * reach));
            sum += weight * push.light.value[surfaceIndex(push.probe, int(texel.z), at.x, at.y)].xyz;
            weights += weight;
        }
    push.sent.word[index] = weights > 0.0 ? packKnownLight(sum / weights) : 0u;
}
