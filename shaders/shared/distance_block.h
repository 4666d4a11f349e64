// Distances of 4 x 4 texels in eight words: up to four planes, which of them each texel lies on, and how far off it it is. Shared text, see texel.h.
//
// Words 0 to 3: a plane each, about the block's middle: bits 0..15 half float q, whose highest and two lowest bits are the plane's precision instead, 0
// to 7; bits 16..23 and 24..31 its gradients as a texel's, in steps of twice the size. A word 0 is sky. Word 4 + y: a byte a texel of row y: bits 0 and 1
// its plane, the others, signed, q of the texel over its plane's, less 1, in steps of blockUnit().
#if defined(__cplusplus) || !defined(SCONCE_DISTANCE_BLOCK) // C++ includes it once for each precision
#define SCONCE_DISTANCE_BLOCK

SCONCE_CONST uint kDistanceBlockWords = 8u;
SCONCE_CONST int kBlockPlanes = 4;
SCONCE_CONST real kBlockGradients = real(2.0); // a plane's largest gradient over a texel's: what a texel saturates at hides what its plane does
SCONCE_CONST real kLeastRise = real(0.25);     // of q over the middle's: a plane doesn't reach the eye's within its block

/// Words of a face of N x N texels that blocks have fewer than texels.
SCONCE_PURE uint wordsOfBlocksSaved(uint size) { return (size / 4u) * (size / 4u) * (16u - kDistanceBlockWords); }

SCONCE_PURE uint blockPrecision(uint plane) { return (plane & 3u) | ((plane >> 13) & 4u); }

/// A step of a texel's share off its plane: 2^-5 to 2^-12.
SCONCE_PURE real blockUnit(uint fineness) { return uintBitsToFloat((127u - 5u - fineness) << 23); }

/// q of a block's plane at a texel of it, x and y in [0,4), over that of its middle.
SCONCE_PURE real blockRise(uint plane, uint x, uint y)
{
    real gx = kBlockGradients * unpackGradient(plane >> 16);
    real gy = kBlockGradients * unpackGradient(plane >> 24);
    return max(real(1.0) + gx * (real(x) - real(1.5)) + gy * (real(y) - real(1.5)), kLeastRise);
}

/// q of the plane where it is `rise` times its middle's.
SCONCE_PURE real blockQ(uint plane, real rise) { return halfToReal(plane & 0x7ffcu) * rise; }

/// The plane's gradients there, relative to that q, in their bits of a texel's word. Their bytes are roots (packGradient), so that the quotient is one
/// of the bytes.
SCONCE_PURE uint blockGradients(uint plane, real rise)
{
    real times = sqrt(kBlockGradients) * inversesqrt(rise);
    real sx = clamp(real(int(plane << 8) >> 24) * times, real(-127.0), real(127.0));
    real sy = clamp(real(int(plane) >> 24) * times, real(-127.0), real(127.0));
    return ((uint(int(floor(sx + real(0.5)))) & 0xffu) << 16) | (uint(int(floor(sy + real(0.5)))) << 24);
}

/// Which of a block's planes a texel of a row lies on.
SCONCE_PURE uint blockPlane(uint row, uint x) { return (row >> (8u * x)) & 3u; }

/// The texel as a word of level 0. @param plane  its plane's word @param row  word 4 + y
SCONCE_PURE uint blockTexel(uint plane, uint row, uint x, uint y)
{
    real rise = blockRise(plane, x, y);
    real share = real(int(row << (24u - 8u * x)) >> 26) * blockUnit(blockPrecision(plane));
    return realToHalf(blockQ(plane, rise) * (real(1.0) + share)) | blockGradients(plane, rise);
}

#endif
