// What the pass that mixes a field's light of its groups is told.
#include "shared/gpu_types.h"
#ifndef SCONCE_MIX_PASSES_H
#define SCONCE_MIX_PASSES_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer MixWords { uint word[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MixWeights { vec3 value[]; };
#endif
SCONCE_STRUCTS_BEGIN

const uint kMixGroup = 64u; // invocations

// Words of FieldData by what they hold.
const uint kMixRadiance = 0u;   // R11G11B10F
const uint kMixIrradiance = 1u; // the same and moments, which stay, in turns
const uint kMixSurface = 2u;    // surface light, with all that follows its texels

struct MixPush
{
    SCONCE_ADDRESS(MixWords) target;    // words of the field
    SCONCE_ADDRESS(MixWords) shares;    // [group][stride]
    SCONCE_ADDRESS(MixWeights) weights; // of the groups
    SCONCE_ADDRESS(MixWords) live;      // a share more, of live light; null: none
    uint count;  // words to mix
    uint groups;
    uint kind;   // kMix...
    uint stride; // words of a share
};
SCONCE_CHECK_SIZE(MixPush, 48);

SCONCE_STRUCTS_END
#endif
