#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "shared/live_light.h"

// Live light: its share of the finer texels of refined ones, between the texels about them: what bounces is even where they tell emitters' shadows.
// Dispatch: any number of groups in a row.
layout(local_size_x = kLiveGroup) in;
layout(scalar, push_constant) uniform Push { LivePush push; };

void light(uint index)
{
    uint texel = BakeWords(push.live.data.refined).word[index / kFineWords], fine = index % kFineWords, side = field.surfaceSize;
    uint probe = texel / (6u * side * side), word = BakeWords(push.live.data.surface).word[texel];
    int face = int(texel / (side * side) % 6u), x = int(texel % side), y = int(texel / side % side);
    if (fine > 0u)
    {
        ivec2 at = (ivec2(x, y) << kFineLog) + ivec2(int(fine - 1u) & ((1 << kFineLog) - 1), int(fine - 1u) >> kFineLog);
        SurfacePoint own = surfacePointOf(probe, face, at.x, at.y, side << uint(kFineLog));
        vec2 middle = (vec2(at) + 0.5) / float(1 << kFineLog) - 0.5, low = clamp(floor(middle), vec2(0.0), vec2(float(side) - 2.0)), f = clamp(middle - low, 0.0, 1.0);
        vec3 sum = vec3(0.0);
        float weights = 0.0;
        for (int tap = 0; tap < 4; ++tap)
        {
            ivec2 there = ivec2(low) + ivec2(tap & 1, tap >> 1);
            float weight = ((tap & 1) != 0 ? f.x : 1.0 - f.x) * ((tap >> 1) != 0 ? f.y : 1.0 - f.y);
            if (!isSameSurface(own.at, own.normal, surfacePointAt(probe, face, there.x, there.y), kSurfaceBend)) continue;
            sum += weight * unpackSharedExponent(BakeWords(push.live.data.surface).word[surfaceIndex(probe, face, there.x, there.y)]);
            weights += weight;
        }
        if (weights > kSurfaceLeast) word = packKnownLight(sum / weights);
    }
    BakeWords(push.live.data.surface).word[refinedWords() + kFineWords * (surfaceWord(texel) - kRefinedWord) + fine] = word;
}

void main()
{
    for (uint index = gl_GlobalInvocationID.x; index < kFineWords * field.refinedTexels; index += gl_NumWorkGroups.x * kLiveGroup) light(index);
}
