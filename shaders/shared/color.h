// Words of light. Shared text, see texel.h. GLSL has no pack functions for these formats, so they are written here once.
// R11G11B10F, radiance and irradiance of the probe maps: unsigned floats with 5 exponent bits and 6, 6, 5 bits of mantissa (Vulkan
// specification, B10G11R11_UFLOAT_PACK32). RGB9E5, surface light: three mantissas of 9 bits with one exponent (E5B9G9R9_UFLOAT_PACK32).
#if defined(__cplusplus) || !defined(SCONCE_COLOR) // C++ includes it once for each precision
#define SCONCE_COLOR

/// Bits of a small unsigned float with the given mantissa width, from the half float of the same exponent range; saturated.
/// @param up  [0,1): the share of a step that is added before the rest is cut off; 0.5 rounds to nearest
SCONCE_PURE uint smallFloatBits(real value, int mantissa, real up)
{
    real finite = value > real(0.0) ? min(value, real(64000.0)) : real(0.0); // also turns NaN into 0
    uint half16 = packHalf2x16(vec2f(float(finite), 0.0f)) & 0x7fffu;
    int drop = 10 - mantissa;
    uint rounded = (half16 + uint(up * real(1 << drop))) >> drop;
    uint largest = (31u << mantissa) - 1u;
    return min(rounded, largest);
}

SCONCE_PURE real smallFloatValue(uint bits, int mantissa) { return real(unpackHalf2x16(bits << (10 - mantissa)).x); }

/// @param up  see smallFloatBits; one of its own for each texel keeps the mean of many texels, whose steps are 1.6 % (blue 3 %) apart, true
SCONCE_PURE uint packRadianceDithered(vec3 c, real up)
{
    return smallFloatBits(c.x, 6, up) | (smallFloatBits(c.y, 6, up) << 11) | (smallFloatBits(c.z, 5, up) << 22);
}

SCONCE_PURE uint packRadiance(vec3 c) { return packRadianceDithered(c, real(0.5)); }

/// A colour in [0,1] by its root, 10 bits a channel: steps of 0.2 % at 1 and finer below.
SCONCE_PURE uint packRootOfColor(vec3 c)
{
    vec3 root = sqrt(clamp(c, vec3(real(0.0)), vec3(real(1.0)))) * real(1023.0) + real(0.5);
    return uint(root.x) | (uint(root.y) << 10) | (uint(root.z) << 20);
}

SCONCE_PURE vec3 unpackRootOfColor(uint w)
{
    vec3 root = vec3(real(w & 1023u), real((w >> 10) & 1023u), real((w >> 20) & 1023u)) / real(1023.0);
    return root * root;
}

/// An offset of its own for every texel, [0,1): the golden ratio's multiples (Weyl), as a sequence over the texels' numbers.
SCONCE_PURE real ditherOf(uint texel) { return real((texel * 2654435769u) >> 8) / real(16777216.0); }

SCONCE_PURE vec3 unpackRadiance(uint w)
{
    return vec3(smallFloatValue(w & 0x7ffu, 6), smallFloatValue((w >> 11) & 0x7ffu, 6), smallFloatValue(w >> 22, 5));
}

/// To nearest, saturated at 65,408; the steps of all channels are those of the largest: 0.2 to 0.4 % of it.
SCONCE_PURE uint packSharedExponent(vec3 c)
{
    real r = c.x > real(0.0) ? min(c.x, real(65408.0)) : real(0.0); // also turns NaN into 0
    real g = c.y > real(0.0) ? min(c.y, real(65408.0)) : real(0.0);
    real b = c.z > real(0.0) ? min(c.z, real(65408.0)) : real(0.0);
    real largest = max(max(r, g), b);
    // The exponent of the next power of two, of a number that is not denormal: its bits say it.
    int exponent = max(int((floatBitsToUint(float(largest)) >> 23) & 255u) - 126, -15);
    if (floor(largest * exp2(real(9 - exponent)) + real(0.5)) > real(511.0)) ++exponent;
    real scale = exp2(real(9 - exponent));
    return uint(floor(r * scale + real(0.5))) | (uint(floor(g * scale + real(0.5))) << 9) | (uint(floor(b * scale + real(0.5))) << 18) |
           (uint(exponent + 15) << 27);
}

/// Relative luminance of linear RGB with BT.709's primaries.
SCONCE_PURE real luminance(vec3 color) { return dot(color, vec3(real(0.2126), real(0.7152), real(0.0722))); }

SCONCE_PURE vec3 unpackSharedExponent(uint w)
{
    real scale = uintBitsToFloat(((w >> 27) + (127u - 24u)) << 23); // 2^(exponent - 15 - 9)
    return scale * vec3(real(w & 511u), real((w >> 9) & 511u), real((w >> 18) & 511u));
}

/// Reflectance of 5:6:5 bits.
SCONCE_PURE vec3 unpackAlbedo(uint bits)
{
    return vec3(real(bits & 31u) / real(31.0), real((bits >> 5) & 63u) / real(63.0), real((bits >> 11) & 31u) / real(31.0));
}

#endif
