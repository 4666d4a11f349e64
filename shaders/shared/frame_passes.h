// The interfaces of the passes of a frame: bindings of their set 1, ids of their constants, push constants.
#include "shared/gpu_types.h"
#ifndef SCONCE_FRAME_PASSES_H
#define SCONCE_FRAME_PASSES_H
SCONCE_STRUCTS_BEGIN

// Of every pass: the host's G-buffer, the FrameView, and the lists of tiles of those that run on tiles.
const uint kDepthBinding = 0u;
const uint kNormalRoughnessBinding = 1u;
const uint kBaseColorMetallicBinding = 2u;
const uint kFrameBinding = 3u;
const uint kTileBinding = 8u;
const uint kPackedBinding = 13u; // packed_pixel.glsl
const uint kMovingBinding = 12u; // shapes that move, of passes that ask them
const uint kPictureBeforeBinding = 6u; // screen_trace.glsl
const uint kScreenBinding = 7u;

// Of each pass.
const uint kTraceLightBinding = 4u; // trace_glossy.comp
const uint kTraceCountsBinding = 5u;
const uint kFillLightBinding = 4u; // reconstruct.comp
const uint kMovingLightBinding = 4u; // moving_light.comp
const uint kGatherDiffuseBinding = 4u; // gather_light.comp
const uint kGatherRoughBinding = 5u;
const uint kSurfaceDiffuseBinding = 4u; // surface_light.comp
const uint kLampDiffuseBinding = 4u; // lamp_light.comp
const uint kLampRoughBinding = 5u;
const uint kLampGlossyBinding = 6u;
const uint kLampMirrorBinding = 7u;
const uint kFilterFromBinding = 4u; // denoise.comp
const uint kFilterToBinding = 5u;
const uint kBlendLightBinding = 4u; // temporal.comp
const uint kBlendBeforeBinding = 5u;
const uint kBlendPointsBeforeBinding = 6u;
const uint kBlendAfterBinding = 7u;
const uint kBlendPointsAfterBinding = 9u;
const uint kDirectNormalBinding = 4u; // direct.comp
const uint kDirectLightBinding = 5u;
const uint kAreaNormalBinding = 4u; // area_light.comp
const uint kAreaDiffuseBinding = 5u;
const uint kComposeDirectBinding = 4u; // compose.comp
const uint kComposeDiffuseBinding = 5u;
const uint kComposeRoughBinding = 6u;
const uint kComposeGlossyBinding = 7u;
const uint kComposeMirrorBinding = 8u;
const uint kComposeBeautyBinding = 9u;
const uint kComposeDiffuseLayerBinding = 10u;
const uint kComposeGlossyLayerBinding = 11u;

// Constants, numbered over all passes, after the light field's (field_passes.h).
const uint kTiledId = 2u;
const uint kTermId = 3u;
const uint kEveryLogId = 4u; // trace_glossy.comp, reconstruct.comp, classify_tiles.comp
const uint kCountId = 5u;    // trace_glossy.comp
const uint kBlendedId = 6u;  // denoise.comp
const uint kLookUpListId = 7u;  // passes by look-ups
const uint kGatherDiffuseId = 8u;
const uint kGatherRoughId = 9u;
const uint kByPatchesId = 10u;
const uint kMadeId = 11u; // compose.comp
const uint kDiffuseLayerId = 12u;
const uint kGlossyLayerId = 13u;
const uint kBySurfaceId = 14u; // gather_light.comp
const uint kLookUpRestId = 15u;  // surface_light.comp, lamp_light.comp: the list that it leaves look-ups to
const uint kIsRestId = 16u;      // of both
const uint kLookUpTermsId = 17u; // classify_tiles.comp: of the first list, the bits of its terms; then of the next; 0: it lists none
const uint kLookUpKindId = 21u;  // of the first list, kLookUpsPerPixel...; then of the next

const uint kLampTermsId = 25u; // lamp_light.comp: bits of the terms that are made
const uint kLampEachId = 26u;  // lamp_light.comp
const uint kMovingId = 27u;    // trace_glossy.comp, temporal.comp: whether shapes move
const uint kMovingBoxesId = 29u; // moving_light.comp: of boxes, else of round shapes
const uint kSurfaceProbesId = 31u; // surface_light.comp
const uint kUntintedId = 30u;    // trace_glossy.comp, reconstruct.comp: the filters after it work on light before the surface's tint, and give it back
const uint kScreenId = 32u;      // trace_glossy.comp: rays meet what the picture of the frame before shows
const uint kMovingLooksId = 28u; // moving_light.comp: the field has prefiltered radiance, which tells what a shape hides

struct DenoisePush
{
    int stride;          // pixels between taps
    int followRoughness; // 1: the reach shrinks with roughness, to nothing for a mirror
    int last;            // 1: of a term's steps the last, which gives reflections their surface's tint
};
SCONCE_CHECK_SIZE(DenoisePush, 12);

struct DirectPush
{
    vec3 origin;     // of field space, world metres
    float scale;     // metres per field unit
    vec3 sky;        // W/(m^2 sr)
    uint lightCount; // delta lights at the front of the list
};
SCONCE_CHECK_SIZE(DirectPush, 32);

struct AreaPush
{
    vec3 origin;  // of field space, world metres
    float scale;  // metres per field unit
    uint samples; // of the emitters, and as many of the sky, a pixel
};
SCONCE_CHECK_SIZE(AreaPush, 20);

SCONCE_STRUCTS_END
#endif
