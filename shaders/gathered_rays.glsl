#include "shared/bake_passes.h"
#include "shared/brdf.h"
#include "shared/sample_pair.h"
#include "shared/gathered_rays.h"

/// The radiance that a ray brings from the texel where it ended.
vec3 broughtBy(uint link) { return push.tints.value[tintOfLink(link)].xyz * unpackSharedExponent(push.sentBefore.word[texelOfLink(link)]); }
