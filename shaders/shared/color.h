// R11G11B10F words: radiance and irradiance of the probe maps. Shared text, see texel.h. GLSL has no pack function for this format, so it is
// written here once: unsigned floats with 5 exponent bits and 6, 6, 5 bits of mantissa (Vulkan specification, B10G11R11_UFLOAT_PACK32).

/// Bits of a small unsigned float with the given mantissa width, from the half float of the same exponent range; to nearest, saturated.
SCONCE_FN uint smallFloatBits(real value, int mantissa)
{
    real finite = value > real(0.0) ? min(value, real(64000.0)) : real(0.0); // also turns NaN into 0
    uint half16 = packHalf2x16(vec2f(float(finite), 0.0f)) & 0x7fffu;
    int drop = 10 - mantissa;
    uint rounded = (half16 + (1u << (drop - 1))) >> drop;
    uint largest = (31u << mantissa) - 1u;
    return min(rounded, largest);
}

SCONCE_FN real smallFloatValue(uint bits, int mantissa) { return real(unpackHalf2x16(bits << (10 - mantissa)).x); }

SCONCE_FN uint packRadiance(vec3 c) { return smallFloatBits(c.x, 6) | (smallFloatBits(c.y, 6) << 11) | (smallFloatBits(c.z, 5) << 22); }

SCONCE_FN vec3 unpackRadiance(uint w)
{
    return vec3(smallFloatValue(w & 0x7ffu, 6), smallFloatValue((w >> 11) & 0x7ffu, 6), smallFloatValue(w >> 22, 5));
}
