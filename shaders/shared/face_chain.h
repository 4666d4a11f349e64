// The Hi-Z chain of a cube face: where its words lie and what they hold. Shared text, see texel.h; face_chain_build.h makes it.
//
// Words of a face of N x N texels: level 0, then levels 2, 4, ... top, row-major, ceil(N / 2^l)^2 words each, then the far bounds of levels
// 2, 4, ... as halves, two a word. Only the top level may have cells that reach over the face's border.
// Near bound of a cell: a PLANE over it, packed like a texel (texel.h), that no surfel plane of the texels below rises above. q is linear over
// planes, so that the bound of a flat wall is the wall itself: a ray that leaves or grazes it passes in one step where a constant bound
// (Uludag 2014; Wang et al. 2019, section 4.2) is met at every level. Word 0: nothing but sky.
// Far bound: no surfel of the cell is farther, q >= it; 0 when there is sky in it. Both are rounded outward.
#if defined(__cplusplus) || !defined(SCONCE_FACE_CHAIN) // C++ includes it once for each precision
#define SCONCE_FACE_CHAIN

/// Coarsest level of a face's chain, at most 6; the size must be a multiple of 4.
SCONCE_PURE int chainTop(uint size)
{
    int level = 0;
    while (level < 6 && (size & ((1u << level) - 1u)) == 0u && (size >> level) > 1u) level += 2;
    return level;
}

SCONCE_PURE uint chainWidth(uint size, int level) { return (size + (1u << level) - 1u) >> level; }

/// First word of a level, relative to the face; every level below the last is exact.
SCONCE_PURE uint chainOffset(uint size, int level)
{
    uint words2 = (size >> 2) * (size >> 2);
    uint words4 = (size >> 4) * (size >> 4);
    return (level > 0 ? size * size : 0u) + (level > 2 ? words2 : 0u) + (level > 4 ? words4 : 0u);
}

/// Cells of levels 2, 4, ... top.
SCONCE_PURE uint chainCells(uint size, int top) { return chainOffset(size, top) + chainWidth(size, top) * chainWidth(size, top) - size * size; }

/// Words before the far bounds: what a trace reads that leaves them alone.
SCONCE_PURE uint chainNearWords(uint size, int top) { return size * size + (top > 0 ? chainCells(size, top) : 0u); }

SCONCE_PURE uint chainWords(uint size, int top)
{
    return chainNearWords(size, top) + (top > 0 ? (chainCells(size, top) + 1u) / 2u : 0u);
}

/// Far bound q out of its word; `cell` counts the cells of levels 2, 4, ... in the order of the near bounds.
SCONCE_PURE real farBoundIn(uint word, uint cell) { return halfToReal((cell & 1u) != 0u ? word >> 16 : word); }

#endif
