// What words the scan for NaN and infinity is told to look at.
#include "shared/gpu_types.h"
#ifndef SCONCE_NAN_SCAN_H
#define SCONCE_NAN_SCAN_H
#ifndef __cplusplus
#extension GL_EXT_buffer_reference : require
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ScanWords { uint word[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ScanFound { uint place; };
#endif
SCONCE_STRUCTS_BEGIN

const uint kScanFloats = 0u;     // one float a word
const uint kScanHalves = 1u;     // two 16-bit floats
const uint kScanRadiance = 2u;   // R11G11B10F
const uint kScanIrradiance = 3u; // in turns R11G11B10F and two 16-bit floats
const uint kScanNearness = 4u;   // a 16-bit float in the lower half: words of cube faces (texel.h)
const uint kScanDistance = 5u;   // the same, where infinite is the sky: words of octahedral maps

struct NanScanPush
{
    SCONCE_ADDRESS(ScanWords) words;
    SCONCE_ADDRESS(ScanFound) found; // least place of a bad word, as runtime/vulkan/nan_scan.cpp set it before
    uint count;  // words
    uint before; // words of the same picture in the pieces scanned before
    uint kind;   // kScan...
    uint stride; // words an item: of each item those are looked at whose bit of `mask` is set
    uint mask;
    uint unused; // to a multiple of 8
};
SCONCE_CHECK_SIZE(NanScanPush, 40);

SCONCE_STRUCTS_END
#endif
