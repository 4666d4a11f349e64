// Words of a probe's distance map, packed and unpacked. Shared text: included by GLSL, and by C++ inside a struct that names `real` (pure.h).
//
// Level 0: bits 0..15 half float q = 1/W at the texel's centre (0: sky), bits 16..23 and 24..31 signed bytes gx, gy: the surfel's plane.
//   q over the texel = q (1 + g.x dx + g.y dy), dx, dy in texels from the centre, g = kGradientScale s |s|, s = byte / 127.
//   0 where all bits of q are 0: sky, which has no plane.
// Level 2, 4, ...: a bounding plane of the cell, packed alike, dx, dy in texels from the cell's centre; see face_chain.h.
// Octahedral level 0: bits 0..15 half float r (0x7c00: sky), bits 16..31 octahedral normal, 8 + 8 bits. Low level: (min r, max r).
#if defined(__cplusplus) || !defined(SCONCE_TEXEL) // C++ includes it once for each precision
#define SCONCE_TEXEL

SCONCE_CONST real kGradientScale = real(0.15);

/// Of the lower 16 bits.
SCONCE_PURE real halfToReal(uint bits) { return real(unpackHalf2x16(bits).x); }

/// Half float bits of a non-negative number, to nearest, saturated at the largest half.
SCONCE_PURE uint realToHalf(real value) { return packHalf2x16(vec2f(float(min(value, real(65504.0))), 0.0f)) & 0xffffu; }

SCONCE_PURE uint realToHalfUp(real value)
{
    uint bits = realToHalf(value);
    return (halfToReal(bits) < value && bits < 0x7bffu) ? bits + 1u : bits;
}

SCONCE_PURE uint realToHalfDown(real value)
{
    uint bits = realToHalf(value);
    return (halfToReal(bits) > value && bits > 0u) ? bits - 1u : bits;
}

/// g: relative gradient of q a texel; beyond +-kGradientScale it saturates.
SCONCE_PURE uint packGradient(real g)
{
    real s = sqrt(min(abs(g) / kGradientScale, real(1.0)));
    int byte = int(floor(s * real(127.0) + real(0.5)));
    return uint(g < real(0.0) ? -byte : byte) & 0xffu;
}

/// Of the lowest byte.
SCONCE_PURE real unpackGradient(uint byte)
{
    real s = real(int(byte << 24) >> 24);
    return (kGradientScale / real(16129.0)) * s * abs(s); // 127^2
}

SCONCE_PURE uint packTexel(real q, real gx, real gy)
{
    return realToHalf(q) | (packGradient(gx) << 16) | (packGradient(gy) << 24);
}

/// Bounds of q over a level 0 texel, rounded outward: half maximum | half minimum << 16.
SCONCE_PURE uint texelBounds(uint word)
{
    real q = halfToReal(word);
    real spread = real(0.5) * (abs(unpackGradient(word >> 16)) + abs(unpackGradient(word >> 24)));
    return realToHalfUp(q * (real(1.0) + spread) * real(1.000001)) | (realToHalfDown(q * (real(1.0) - spread) * real(0.999999)) << 16);
}

#endif
