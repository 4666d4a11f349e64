// What words the scan for NaN and infinity is told to look at.
#include "shared/gpu_types.h"
#ifndef SCONCE_NAN_SCAN_H
#define SCONCE_NAN_SCAN_H
SCONCE_STRUCTS_BEGIN

const uint kScanFloats = 0u;     // one float a word
const uint kScanHalves = 1u;     // two 16-bit floats
const uint kScanRadiance = 2u;   // R11G11B10F
const uint kScanIrradiance = 3u; // in turns R11G11B10F and two 16-bit floats
const uint kScanNearness = 4u;   // a 16-bit float in the lower half: words of cube faces (texel.h)
const uint kScanDistance = 5u;   // the same, where infinite is the sky: words of octahedral maps

SCONCE_STRUCTS_END
#endif
