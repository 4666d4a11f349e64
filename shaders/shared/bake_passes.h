// What the bake's compute passes over one probe are told.
#include "shared/gpu_types.h"
#ifndef SCONCE_BAKE_PASSES_H
#define SCONCE_BAKE_PASSES_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BakeWords { uint word[]; };
#endif
SCONCE_STRUCTS_BEGIN

const uint kBakeSurfaceBinding = 0u; // layout: bake_gbuffer.frag
const uint kBakeDepthBinding = 1u;

struct BakePush
{
    SCONCE_ADDRESS(BakeWords) words;    // distance words of the probe
    SCONCE_ADDRESS(BakeWords) radiance; // R11G11B10F
    SCONCE_ADDRESS(BakeWords) surface;  // reflectance 5:6:5, shading normal << 16; 0: sky
    SCONCE_ADDRESS(BakeWords) extra;    // a pass's other buffer; of a bounce, the radiance that is direct
    vec3 centre;        // of the probe, field space
    float nearPlane;    // W of depth 1, field units
    uint size;          // texels a side of a face (or of the octahedral map)
    uint faceWords;     // distance words a face
    uint chart;
    uint level;         // chain: the level written; gathers: cells a side
    vec3 sky;
    float skyDistance;  // that the moments count for sky, field units
    SCONCE_ADDRESS(BakeWords) emitted; // emission a radiance texel, R11G11B10F; null: the scene has no emitters
};
SCONCE_CHECK_SIZE(BakePush, 88);

SCONCE_STRUCTS_END
#endif
