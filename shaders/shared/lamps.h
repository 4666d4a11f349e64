// Emitters whose shadows are sharper than texels of surface light: lamps. Their light is no part of surface light, of probes' radiance or of what
// gathering rays meet; it is evaluated where it falls, by polygon_light.h, behind a map of what they see. A field holds Lamp[count], then words.
#include "shared/gpu_types.h"
#ifndef SCONCE_LAMPS_H
#define SCONCE_LAMPS_H
SCONCE_STRUCTS_BEGIN

const uint kMostLamps = 4u;
const uint kLampBlock = 8u; // texels, or blocks, a side of a block of the map, of which there are two levels
const uint kLampFar = 0xffffu; // of a texel: nothing is met

/// Field space. Its map is a picture from its middle: x and y are tangents of the angles to its normal along two axes, and a texel holds how far along
/// the normal the nearest surface is, 16 bits from `near` to `far`, two to a word. Then blocks of texels and blocks of those: least | most << 16.
struct Lamp
{
    vec3 corner[4]; // counter-clockwise seen from where its light goes; of a triangle one comes twice
    vec3 radiance;
    vec3 centre;
    float reach;    // radius of a disc as large
    vec3 axisX;     // unit, in its plane
    vec3 axisY;
    vec3 normal;    // unit, to where its light goes
    vec2 low;       // of the map's window, tangents
    vec2 perTangent; // texels
    float near;     // along the normal
    float far;
    uint size;      // texels a side; a multiple of kLampBlock squared
    uint firstWord; // of its map, counted from the field's first lamp
};
SCONCE_CHECK_SIZE(Lamp, 144);

SCONCE_STRUCTS_END
#endif
