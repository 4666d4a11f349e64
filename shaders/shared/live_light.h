// What the passes that light a field anew while it runs are told: runtime/field/live_light.h.
#include "shared/bake_passes.h"
#include "shared/lights.h"
#ifndef SCONCE_LIVE_LIGHT_H
#define SCONCE_LIVE_LIGHT_H
#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LiveLights { GpuLight light[]; };
#endif
SCONCE_STRUCTS_BEGIN

/// What light needs of a texel of surface light to be made anew: its material, and how far what it sees is.
struct LiveTexel
{
    uint albedo; // packRootOfColor: of light that surfaces send, see TriangleGather::Target::sending
    uint direct; // RGB9E5: what is sent of light straight from lights, over what arrives
    uint normal; // as SurfaceTexel's, with packReach() at kReachShift
};
SCONCE_CHECK_SIZE(LiveTexel, 12);
const uint kReachShift = 17u;
const uint kReachMask = 127u;

SCONCE_BUFFER(LiveTexels, LiveTexel)

/// Device addresses of all that the passes read and write, of which buffer is said (as numbers: SCONCE_ADDRESS in gpu_types.h). Light is RGB9E5 where nothing else is said; texels are of all probes.
struct LiveData
{
    DeviceAddress texels; // LiveTexels
    DeviceAddress links; // BakeWords: [probe][link][texel of the probe]
    DeviceAddress places; // BakeWords: words of FieldData::surfaceLight that are no texels: a facing of a cell, a hidden surface
    DeviceAddress placeLinks; // BakeWords: [link][place]
    DeviceAddress refined; // BakeWords: texels that are
    DeviceAddress tints; // SurfaceFloats: kTints colours of metals
    DeviceAddress lights; // LiveLights
    DeviceAddress probes; // BakeWords: that this step is about
    DeviceAddress direct; // BakeWords: light straight from lights: irradiance / pi
    DeviceAddress bounced; // BakeWords: light that surfaces send, before it is filtered
    DeviceAddress tilts; // BakeWords: packTilt() of the same; 0: the field has no directions
    DeviceAddress sent; // BakeWords: radiance that the texels send
    DeviceAddress sentNext; // BakeWords: the same after the bounce
    DeviceAddress incident; // BakeWords: direct and bounced light: what rays find
    DeviceAddress surface; // BakeWords: the live lights' share of FieldData::surfaceLight
    DeviceAddress irradiance; // BakeWords: and of FieldData::irradiance
    DeviceAddress prefiltered; // BakeWords: and of FieldData::prefiltered
};
SCONCE_CHECK_SIZE(LiveData, 136);

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LiveAddresses { LiveData data; };
#endif

struct LivePush
{
    SCONCE_ADDRESS(LiveAddresses) live;
    uint links;      // a texel, and a place
    uint lights;
    uint places;
    uint first;      // of the probes in the list
    float offset;    // field units that a ray starts off its surface
    uint unused;     // to a multiple of 8
};
SCONCE_CHECK_SIZE(LivePush, 32);

const uint kLiveShadowRays = 8u; // a point, at most: of more lights they are drawn
const uint kLivePoints = 2u;     // a side, of a texel, that direct light is asked for
const uint kLiveGroup = 64u;     // invocations of a workgroup over places and over a probe's lobes
const float kMostLiveAlbedo = 0.99f; // so that light between mirrors dies away

SCONCE_STRUCTS_END
#endif
