#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shared/nan_scan.h"

// Debugging: the place of the first number of some words that is NaN or infinite. Dispatch: any number of groups in a row.
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Words { uint word[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Found { uint place; };
layout(scalar, push_constant) uniform Push
{
    Words words;
    Found found; // least place of a bad word, as runtime/vulkan/nan_scan.cpp set it before
    uint count;  // words
    uint before; // words of the same picture in the pieces scanned before
    uint kind;   // kScan...
    uint stride; // words an item: of each item those are looked at whose bit of `mask` is set
    uint mask;
};

bool badFloat(uint bits) { return (bits & 0x7f800000u) == 0x7f800000u; }
bool badHalf(uint bits) { return (bits & 0x7c00u) == 0x7c00u; }
bool badHalves(uint bits) { return badHalf(bits) || badHalf(bits >> 16); }
bool badSmallFloats(uint bits) { return (bits >> 6 & 31u) == 31u || (bits >> 17 & 31u) == 31u || bits >> 27 == 31u; }

bool isBad(uint bits, uint index)
{
    if (kind == kScanFloats) return badFloat(bits);
    if (kind == kScanHalves) return badHalves(bits);
    if (kind == kScanRadiance) return badSmallFloats(bits);
    if (kind == kScanIrradiance) return (index & 1u) == 0u ? badSmallFloats(bits) : badHalves(bits);
    if (kind == kScanNearness) return badHalf(bits);
    return badHalf(bits) && (bits & 0x3ffu) != 0u; // kScanDistance: infinite is the sky
}

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * 64u)
        if ((mask >> (i % stride) & 1u) != 0u && isBad(words.word[i], i)) atomicMin(found.place, before + i);
}
