#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "shared/brdf.h"
#include "shared/sample_pair.h"
#include "shared/live_light.h"
#include "shared/gathered_rays.h"

// Live light: of the places of surface light that are no texels. Dispatch: any number of groups in a row.
layout(local_size_x = kLiveGroup) in;
layout(scalar, push_constant) uniform Push { LivePush push; };

void light(uint place)
{
    vec3 sum = vec3(0.0);
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.links; ++i)
    {
        uint link = BakeWords(push.live.data.placeLinks).word[i * push.places + place];
        if (countEnd(ends, link))
            sum += SurfaceFloats(push.live.data.tints).value[tintOfLink(link)].xyz * unpackSharedExponent(BakeWords(push.live.data.sent).word[texelOfLink(link)]);
    }
    BakeWords(push.live.data.surface).word[BakeWords(push.live.data.places).word[place]] = packKnownLight(perRay(ends) * sum);
}

void main()
{
    for (uint place = gl_GlobalInvocationID.x; place < push.places; place += gl_NumWorkGroups.x * kLiveGroup) light(place);
}
