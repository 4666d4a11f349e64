#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "shared/mix_passes.h"

// Words of a field's light, as its groups' weights have it. Dispatch: any number of groups in a row.
layout(local_size_x = kMixGroup) in;
layout(scalar, push_constant) uniform Push { MixPush push; };

bool isNull(MixWords words) { return uvec2(words) == uvec2(0u); }
// Live light is the last share.
uint mixGroups() { return push.groups + (isNull(push.live) ? 0u : 1u); }
vec3 mixWeight(uint group) { return group < push.groups ? push.weights.value[group] : vec3(1.0); }
uint mixShare(uint group, uint index) { return group < push.groups ? push.shares.word[group * push.stride + index] : push.live.word[index]; }

#include "shared/group_mix.h"

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * kMixGroup)
    {
        if (push.kind == kMixIrradiance && (i & 1u) != 0u) continue;
        push.target.word[i] = push.kind == kMixSurface ? mixedSurface(i) : mixedRadiance(i);
    }
}
