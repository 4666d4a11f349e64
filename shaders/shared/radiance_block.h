// Radiance of 4 x 4 texels in four words: BC6H, unsigned, in the one of its modes that has one pair of endpoints of 10 bits and 16 steps from one to the
// other (bits 0 to 4 are 00011; Khronos Data Format Specification 1.3, section 21.3, "BC6H"). Shared text, see texel.h.
#if defined(__cplusplus) || !defined(SCONCE_RADIANCE_BLOCK) // C++ includes it once for each precision
#define SCONCE_RADIANCE_BLOCK

SCONCE_CONST uint kBlockMode = 3u;
SCONCE_CONST uint kBlockSide = 4u;

/// How far from the first endpoint to the second the i-th of 16 steps is, of 64.
SCONCE_PURE uint blockStep(uint i) { return (i * 64u + 7u) / 15u; }

/// Of an endpoint's 10 bits, 16.
SCONCE_PURE uint widenEndpoint(uint bits) { return bits == 0u ? 0u : bits == 1023u ? 65535u : ((bits << 16) + 32768u) >> 10; }

/// Bits of the half float that is a share (of 64) of the way from one widened endpoint to another.
SCONCE_PURE uint blockHalf(uint first, uint second, uint share)
{
    return ((((64u - share) * first + share * second + 32u) >> 6) * 31u) >> 6;
}

/// @param texel  4 y + x
SCONCE_PURE uint blockIndex(uvec4 block, uint texel)
{
    uint bits = texel < 8u ? block.z : block.w;
    return texel == 0u ? (bits >> 1) & 7u : (bits >> (4u * (texel & 7u))) & 15u; // the first texel's highest bit is always 0, and left out
}

/// W/(m^2 sr). @param texel  4 y + x
SCONCE_PURE vec3 blockRadiance(uvec4 block, uint texel)
{
    uint share = blockStep(blockIndex(block, texel));
    uint red = blockHalf(widenEndpoint((block.x >> 5) & 1023u), widenEndpoint((block.y >> 3) & 1023u), share);
    uint green = blockHalf(widenEndpoint((block.x >> 15) & 1023u), widenEndpoint((block.y >> 13) & 1023u), share);
    uint blue = blockHalf(widenEndpoint((block.x >> 25) | ((block.y & 7u) << 7)), widenEndpoint((block.y >> 23) | ((block.z & 1u) << 9)), share);
    return vec3(halfToReal(red), halfToReal(green), halfToReal(blue));
}

#endif
