#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/nan_scan.h"

// Debugging: the place of the first number of some words that is NaN or infinite. Dispatch: any number of groups in a row.
layout(local_size_x = 64) in;
layout(scalar, push_constant) uniform Push { NanScanPush push; };

bool badFloat(uint bits) { return (bits & 0x7f800000u) == 0x7f800000u; }
bool badHalf(uint bits) { return (bits & 0x7c00u) == 0x7c00u; }
bool badHalves(uint bits) { return badHalf(bits) || badHalf(bits >> 16); }
bool badSmallFloats(uint bits) { return (bits >> 6 & 31u) == 31u || (bits >> 17 & 31u) == 31u || bits >> 27 == 31u; }

bool isBad(uint bits, uint index)
{
    if (push.kind == kScanFloats) return badFloat(bits);
    if (push.kind == kScanHalves) return badHalves(bits);
    if (push.kind == kScanRadiance) return badSmallFloats(bits);
    if (push.kind == kScanIrradiance) return (index & 1u) == 0u ? badSmallFloats(bits) : badHalves(bits);
    if (push.kind == kScanNearness) return badHalf(bits);
    return badHalf(bits) && (bits & 0x3ffu) != 0u; // kScanDistance: infinite is the sky
}

void main()
{
    for (uint i = gl_GlobalInvocationID.x; i < push.count; i += gl_NumWorkGroups.x * 64u)
        if ((push.mask >> (i % push.stride) & 1u) != 0u && isBad(push.words.word[i], i)) atomicMin(push.found.place, push.before + i);
}
