// What a pass over the light field is bound to, and its constants: shaders/light_field.glsl declares them.
#include "shared/lamps.h"
#include "shared/light_field.h"
#ifndef SCONCE_FIELD_PASSES_H
#define SCONCE_FIELD_PASSES_H
SCONCE_STRUCTS_BEGIN

const uint kFieldBlockBinding = 0u;
const uint kFieldProbesBinding = 1u;
const uint kFieldOctreeBinding = 2u;
const uint kFieldPatchesBinding = 3u;
const uint kFieldDistanceBinding = 4u; // these five: words of FieldData, where kByTexels
const uint kFieldRadianceBinding = 5u;
const uint kFieldIrradianceBinding = 6u;
const uint kFieldPrefilteredBinding = 7u;
const uint kFieldSurfaceBinding = 8u;
const uint kFieldSlotsBinding = 9u; // of each probe: where its maps are, kNoProbe where they are not on the device; where kStreams
const uint kFieldFlagsId = 0u;
const uint kHoldsRadianceId = 1u;
const uint kReadsFarBounds = 1u; // bits of the flags: so that a pass without them pays nothing
const uint kOnOctahedron = 2u;
const uint kHoldsRefined = 8u; // some texels of the surface light are refined
const uint kHoldsPrefiltered = 32u; // there is prefiltered radiance
const uint kHoldsLive = 16u; // rays find live light (live_light.h), besides the radiance that is baked
const uint kStreams = 64u; // the maps of some probes are not on the device (FieldStream)
const uint kOrderShift = 7u; // of the two bits that hold TraceQuality::order
const uint kMapsInBlocks = 512u; // distances and radiance are in blocks of 4 x 4 texels (distance_block.h, radiance_block.h)
const uint kByTexels = 4u; // words are texels of buffers; else they are read by address

// The uniform block: members, for the shared texts name them plainly. Addresses are of the words of FieldData.
#define SCONCE_FIELD_BLOCK \
    LightFieldInfo field; \
    TraceQuality quality; \
    DeviceAddress distanceAddress; \
    DeviceAddress radianceAddress; \
    DeviceAddress irradianceAddress; \
    DeviceAddress prefilteredAddress; \
    DeviceAddress surfaceAddress; \
    DeviceAddress lampAddress; \
    DeviceAddress liveAddress;   /* incident live light of the texels */ \
    DeviceAddress albedoAddress; /* LiveTransport::albedo */ \
    DeviceAddress askedAddress;  /* how often each probe's maps were asked for, where kStreams */ \
    vec3 radianceWeight;         /* of the baked radiance, where there is live light */ \
    uint lampCount;
#ifdef __cplusplus
struct FieldBlock
{
    SCONCE_FIELD_BLOCK
};
SCONCE_CHECK_SIZE(FieldBlock, 320);
#endif

SCONCE_STRUCTS_END
#endif
