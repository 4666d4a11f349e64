// What the bake's compute passes over one probe share.
#include "shared/bake_passes.h"
#include "shared/light_field.h"
#include "shared/pure_text.h"

layout(scalar, push_constant) uniform Push { BakePush push; };

bool isNull(BakeWords words) { return uvec2(words) == uvec2(0u); }

/// Position of a texel's centre on its face, in [-1,1].
vec2 texelOnFace(uvec2 texel, uint faceSize) { return (vec2(texel) + 0.5) * (2.0 / float(faceSize)) - 1.0; }

/// @param up  [0,1): what is added to a channel's step before the rest is cut off; one of its own for each texel keeps the mean true, on
///            which the sum of all bounces hangs
uint packAlbedo(vec3 a, float up)
{
    uvec3 c = min(uvec3(clamp(a, 0.0, 1.0) * vec3(31.0, 63.0, 31.0) + up), uvec3(31u, 63u, 31u));
    return c.x | (c.y << 5) | (c.z << 11);
}
