// What the bake's compute passes over one probe share.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shared/gpu_types.h"
#include "shared/light_field.h"
#include "shared/texel.h"
#define SCONCE_HAS_CHART
#include "shared/chart.h"
#include "shared/color.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BakeWords { uint word[]; };

layout(scalar, push_constant) uniform Push
{
    BakeWords words;    // distance words of the probe
    BakeWords radiance; // R11G11B10F
    BakeWords surface;  // reflectance 5:6:5, shading normal << 16; 0: sky
    BakeWords extra;    // a pass's other buffer
    vec3 centre;        // of the probe, field space
    float nearPlane;    // W of depth 1, field units
    uint size;          // texels a side of a face (or of the octahedral map)
    uint faceWords;     // distance words a face
    uint chart;
    uint level;         // chain: the level written
    vec3 sky;
    float skyDistance;  // that the moments count for sky, field units
    BakeWords emitted;  // emission a radiance texel, R11G11B10F; null: the scene has no emitters
};

bool isNull(BakeWords words) { return uvec2(words) == uvec2(0u); }

/// Position of a texel's centre on its face, in [-1,1].
vec2 texelOnFace(uvec2 texel, uint faceSize) { return (vec2(texel) + 0.5) * (2.0 / float(faceSize)) - 1.0; }

vec3 unpackAlbedo(uint bits)
{
    return vec3(float(bits & 31u) / 31.0, float((bits >> 5) & 63u) / 63.0, float((bits >> 11) & 31u) / 31.0);
}

/// @param up  [0,1): what is added to a channel's step before the rest is cut off; one of its own for each texel keeps the mean true, on
///            which the sum of all bounces hangs
uint packAlbedo(vec3 a, float up)
{
    uvec3 c = min(uvec3(clamp(a, 0.0, 1.0) * vec3(31.0, 63.0, 31.0) + up), uvec3(31u, 63u, 31u));
    return c.x | (c.y << 5) | (c.z << 11);
}
