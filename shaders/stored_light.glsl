// Light as images of half floats hold it: each pass stores through these, whatever its device does with what half floats can't hold.
#include "shared/frame.h"

/// No more than kMostLight, and rounded here: a device may cut the last bits off instead, which darkens, the more so the more often light is blended.
/// @param rounding  0.5: to the nearest; random in [0,1): right in the mean, so that steps finer than a half float's aren't lost
vec4 storedLight(vec4 light, float rounding)
{
    const vec4 most = vec4(kMostLight);
    vec4 rounded = uintBitsToFloat((floatBitsToUint(light) + uint(rounding * 8192.0)) & 0xffffe000u); // 13 bits more than half floats have
    return mix(rounded, most, greaterThan(light, most)); // not min(): NaN must stay what a scan for it finds
}
vec4 storedLight(vec4 light) { return storedLight(light, 0.5); }

/// Of what the eye sees straight, a lamp, which may be brighter than kMostLight: the light over a, a power of two.
vec4 storedBright(vec3 light)
{
    float most = max(max(light.r, light.g), light.b);
    float scale = most > kMostLight ? exp2(min(ceil(log2(most / kMostLight)), 15.0)) : 1.0;
    return storedLight(vec4(light / scale, scale));
}
vec3 brightLight(vec4 stored) { return stored.rgb * stored.a; }
