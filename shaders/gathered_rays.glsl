#include "shared/bake_passes.h"
#include "shared/brdf.h"
#include "shared/sample_pair.h"
#include "shared/gathered_rays.h"

/// The radiance that a ray brings from the texel where it ended.
vec3 broughtBy(uint link)
{
    vec4 tint = push.tints.value[tintOfLink(link)];
    uint kept = (push.bounce + kSentKept - 1u - uint(tint.w)) % kSentKept;
    return tint.xyz * unpackSharedExponent(push.sentKept.word[kept * push.texelCount + texelOfLink(link)]);
}
