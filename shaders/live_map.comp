#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "shared/live_light.h"

// Live light: the finest level of a probe's prefiltered radiance, of what its texels send to all sides, as rays find it: not what they send to
// gathering rays, of which some go on. Dispatch: kPrefilteredSize/8 twice x probes.
layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, push_constant) uniform Push { LivePush push; };

const int kSubsamples = 2; // a side

void main()
{
    uint probe = BakeWords(push.live.data.probes).word[push.first + gl_GlobalInvocationID.z];
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kSubsamples * kSubsamples; ++i)
    {
        vec2 within = (vec2(i % kSubsamples, i / kSubsamples) + 0.5) / float(kSubsamples);
        vec3 direction = directionFromOctahedral((vec2(gl_GlobalInvocationID.xy) + within) / float(kPrefilteredSize));
        int face = dominantFace(direction);
        vec3 uvw = faceCoordinates(face, direction);
        ivec2 at = clamp(ivec2((uvw.xy / uvw.z * 0.5 + 0.5) * float(field.surfaceSize)), ivec2(0), ivec2(int(field.surfaceSize) - 1));
        ivec2 coarse = clamp(ivec2((uvw.xy / uvw.z * 0.5 + 0.5) * float(field.faceSize / 2u)), ivec2(0), ivec2(int(field.faceSize / 2u) - 1));
        sum += liveAlbedoOf(probe, face, coarse.x, coarse.y) *
               unpackSharedExponent(BakeWords(push.live.data.incident).word[surfaceIndex(probe, face, at.x, at.y)]);
    }
    BakeWords(push.live.data.prefiltered).word[probe * kPrefilteredWords + gl_GlobalInvocationID.y * kPrefilteredSize + gl_GlobalInvocationID.x] =
        packRadiance(sum / float(kSubsamples * kSubsamples));
}
