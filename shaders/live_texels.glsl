// What the passes of live light over texels share: one invocation a texel of the probes that a step is about. After light_field.glsl.
// Dispatch: ceil(surfaceSize/8) twice x 6 x probes.
#include "shared/brdf.h"
#include "shared/sample_pair.h"
#include "shared/live_light.h"
#include "shared/gathered_rays.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, push_constant) uniform Push { LivePush push; };

uint texelsOfProbe() { return 6u * field.surfaceSize * field.surfaceSize; }

struct Texel
{
    uint probe;
    ivec3 at;     // x, y, face
    uint ofProbe; // index
    uint index;   // of all
    bool inside;  // of the map
};

Texel texelOfInvocation()
{
    Texel t;
    uvec3 id = gl_GlobalInvocationID;
    t.probe = BakeWords(push.live.data.probes).word[push.first + id.z / 6u];
    t.at = ivec3(id.xy, id.z % 6u);
    t.ofProbe = (uint(t.at.z) * field.surfaceSize + id.y) * field.surfaceSize + id.x;
    t.index = t.probe * texelsOfProbe() + t.ofProbe;
    t.inside = id.x < field.surfaceSize && id.y < field.surfaceSize;
    return t;
}

/// The radiance that a link brings.
vec3 broughtBy(uint link) { return SurfaceFloats(push.live.data.tints).value[tintOfLink(link)].xyz * unpackSharedExponent(BakeWords(push.live.data.sent).word[texelOfLink(link)]); }
