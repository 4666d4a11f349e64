#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "shared/live_light.h"

// Live light: a probe's irradiance and the coarser levels of its prefiltered radiance, each direction by all of the finest level, whose texels are
// joined first: 2x2 of them for the first coarser level, 4x4 for all else. Dispatch: outputs of a probe / kLiveGroup x probes.
layout(local_size_x = kLiveGroup) in;
layout(scalar, push_constant) uniform Push { LivePush push; };

const uint kFine = kPrefilteredSize / 2u, kCoarse = kPrefilteredSize / 4u;
shared vec3 joined[kFine * kFine];

/// What an octahedral map's texel has of the sphere, but for a factor.
float solidAngle(vec3 direction)
{
    float off = abs(direction.x) + abs(direction.y) + abs(direction.z);
    return off * off * off;
}

/// Mean of the joined texels under a lobe about an axis.
/// @param width  of a round normal lobe, radians; 0: the cosine's
vec3 lobeMean(uint side, vec3 axis, float width)
{
    float sharpness = width > 0.0 ? 1.0 / (width * width) : 0.0, weights = 0.0;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < side * side; ++i)
    {
        vec3 direction = directionFromOctahedral((vec2(i % side, i / side) + 0.5) / float(side));
        float cosine = dot(axis, direction), weight = solidAngle(direction) * (width > 0.0 ? exp(sharpness * (cosine - 1.0)) : max(cosine, 0.0));
        sum += weight * joined[i];
        weights += weight;
    }
    return sum / max(weights, 1e-20);
}

void main()
{
    uint probe = BakeWords(push.live.data.probes).word[push.first + gl_GlobalInvocationID.y], words = probe * kPrefilteredWords;
    uint output_ = gl_GlobalInvocationID.x; // of the coarser levels, then of the irradiance
    const uint kOfLevel1 = kFine * kFine, kOfLevel2 = kCoarse * kCoarse, kOfLevel3 = kOfLevel2 / 4u;
    uint side = gl_WorkGroupID.x * kLiveGroup < kOfLevel1 ? kFine : kCoarse, factor = kPrefilteredSize / side;
    for (uint i = gl_LocalInvocationIndex; i < side * side; i += kLiveGroup)
    {
        uvec2 corner = factor * uvec2(i % side, i / side);
        vec3 sum = vec3(0.0);
        for (uint y = 0u; y < factor; ++y)
            for (uint x = 0u; x < factor; ++x) sum += unpackRadiance(BakeWords(push.live.data.prefiltered).word[words + (corner.y + y) * kPrefilteredSize + corner.x + x]);
        joined[i] = sum / float(factor * factor);
    }
    barrier(); // the map is joined by all
    words += kPrefilteredSize * kPrefilteredSize;
    if (output_ < kOfLevel1 + kOfLevel2 + kOfLevel3)
    {
        uint level = output_ < kOfLevel1 ? 1u : (output_ < kOfLevel1 + kOfLevel2 ? 2u : 3u);
        uint own = output_ - (level > 1u ? kOfLevel1 : 0u) - (level > 2u ? kOfLevel2 : 0u), n = kPrefilteredSize >> level;
        vec3 axis = directionFromOctahedral((vec2(own % n, own / n) + 0.5) / float(n));
        BakeWords(push.live.data.prefiltered).word[words + output_] = packRadiance(lobeMean(side, axis, kFinestLobe * pow(kLobeGrowth, float(level))));
        return;
    }
    uint texel = output_ - kOfLevel1 - kOfLevel2 - kOfLevel3;
    if (texel >= kIrradianceSize * kIrradianceSize) return;
    vec3 axis = directionFromOctahedral((vec2(texel % kIrradianceSize, texel / kIrradianceSize) + 0.5) / float(kIrradianceSize));
    BakeWords(push.live.data.irradiance).word[irradianceIndex(probe, texel)] = packRadiance(lobeMean(side, axis, 0.0));
}
