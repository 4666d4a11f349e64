// The Hi-Z chain of a cube face: where its words lie and what they hold. Shared text: GLSL, or C++ inside a struct that names `real`;
// whoever builds chains also defines uint chainWord(uint index) and SCONCE_BUILDS_CHAINS.
//
// Words of a face of N x N texels: level 0, then levels 2, 4, ... top, row-major, ceil(N / 2^l)^2 words each, then the far bounds of levels
// 2, 4, ... as halves, two a word. Only the top level may have cells that reach over the face's border.
// Near bound of a cell: a PLANE over it, packed like a texel (texel.h), that no surfel plane of the texels below rises above. q is linear over
// planes, so that the bound of a flat wall is the wall itself: a ray that leaves or grazes it passes in one step where a constant bound
// (Uludag 2014; Wang et al. 2019, section 4.2) is met at every level. Word 0: nothing but sky.
// Far bound: no surfel of the cell is farther, q >= it; 0 when there is sky in it. Both are rounded outward.

/// Coarsest level of a face's chain, at most 6; the size must be a multiple of 4.
SCONCE_FN int chainTop(uint size)
{
    int level = 0;
    while (level < 6 && (size & ((1u << level) - 1u)) == 0u && (size >> level) > 1u) level += 2;
    return level;
}

SCONCE_FN uint chainWidth(uint size, int level) { return (size + (1u << level) - 1u) >> level; }

/// First word of a level, relative to the face; every level below the last is exact.
SCONCE_FN uint chainOffset(uint size, int level)
{
    uint words2 = (size >> 2) * (size >> 2);
    uint words4 = (size >> 4) * (size >> 4);
    return (level > 0 ? size * size : 0u) + (level > 2 ? words2 : 0u) + (level > 4 ? words4 : 0u);
}

/// Cells of levels 2, 4, ... top.
SCONCE_FN uint chainCells(uint size, int top) { return chainOffset(size, top) + chainWidth(size, top) * chainWidth(size, top) - size * size; }

/// Words before the far bounds: what a trace reads that leaves them alone.
SCONCE_FN uint chainNearWords(uint size, int top) { return size * size + (top > 0 ? chainCells(size, top) : 0u); }

SCONCE_FN uint chainWords(uint size, int top)
{
    return chainNearWords(size, top) + (top > 0 ? (chainCells(size, top) + 1u) / 2u : 0u);
}

/// Far bound q out of its word; `cell` counts the cells of levels 2, 4, ... in the order of the near bounds.
SCONCE_FN real farBoundIn(uint word, uint cell) { return halfToReal((cell & 1u) != 0u ? word >> 16 : word); }

#ifdef SCONCE_BUILDS_CHAINS

struct CellFit
{
    real meanX; // gradients of q a texel: mean over the texels' planes
    real meanY;
    real nearX; // of the nearest texel
    real nearY;
    real fitX;  // least squares through the texels' centres
    real fitY;
    real mean;  // of q
    bool solid; // some texel shows a surface
};

/// Candidates for the gradient of a cell's bounding plane. `first` is the face's first word.
SCONCE_FN CellFit fitCell(uint first, uint size, int level, uint x, uint y)
{
    uint side = 1u << level;
    real n = real(0.0), sq = real(0.0), sx = real(0.0), sy = real(0.0), sxx = real(0.0), sxy = real(0.0), syy = real(0.0);
    real sxq = real(0.0), syq = real(0.0), nearest = real(0.0);
    CellFit fit;
    fit.meanX = real(0.0);
    fit.meanY = real(0.0);
    fit.nearX = real(0.0);
    fit.nearY = real(0.0);
    fit.fitX = real(0.0);
    fit.fitY = real(0.0);
    for (uint j = y * side; j < min((y + 1u) * side, size); ++j)
        for (uint i = x * side; i < min((x + 1u) * side, size); ++i)
        {
            uint word = chainWord(first + j * size + i);
            real q = halfToReal(word);
            if (q == real(0.0)) continue;
            real gx = q * unpackGradient(word >> 16);
            real gy = q * unpackGradient(word >> 24);
            real dx = real(i - x * side) + real(0.5) - real(0.5) * real(side);
            real dy = real(j - y * side) + real(0.5) - real(0.5) * real(side);
            n += real(1.0);
            sq += q;
            sx += dx;
            sy += dy;
            sxx += dx * dx;
            sxy += dx * dy;
            syy += dy * dy;
            sxq += dx * q;
            syq += dy * q;
            fit.meanX += gx;
            fit.meanY += gy;
            if (q > nearest)
            {
                nearest = q;
                fit.nearX = gx;
                fit.nearY = gy;
            }
        }
    fit.solid = n > real(0.0);
    n = max(n, real(1.0));
    fit.mean = sq / n;
    fit.meanX /= n;
    fit.meanY /= n;
    real a = sxx - sx * sx / n, b = sxy - sx * sy / n, d = syy - sy * sy / n;
    real u = sxq - sx * sq / n, v = syq - sy * sq / n;
    real determinant = a * d - b * b;
    if (determinant > real(1e-4) * a * d)
    {
        fit.fitX = (u * d - v * b) / determinant;
        fit.fitY = (a * v - b * u) / determinant;
    }
    return fit;
}

/// The bounding plane of a given gradient over a cell, packed; `best` when that one lies lower at the cell's centre, that is on average.
SCONCE_FN uint lowerPlane(uint first, uint size, int level, uint x, uint y, vec2 gradient, uint best)
{
    uint side = 1u << level;
    real half_ = real(0.5) * real(side);
    real steep = (abs(gradient.x) + abs(gradient.y)) * half_; // the plane must stay in front of the probe over the whole cell
    real keep = steep > real(0.9) ? real(0.9) / steep : real(1.0);
    uint bytes = (packGradient(keep * gradient.x) << 16) | (packGradient(keep * gradient.y) << 24);
    real gx = unpackGradient(bytes >> 16), gy = unpackGradient(bytes >> 24);
    if ((abs(gx) + abs(gy)) * half_ > real(0.97)) return best; // rounded up too far
    real limit = (best & 0xffffu) != 0u ? halfToReal(best) : real(3e38);
    real centre = real(0.0);
    for (uint j = y * side; j < min((y + 1u) * side, size) && centre < limit; ++j)
        for (uint i = x * side; i < min((x + 1u) * side, size); ++i)
        {
            uint word = chainWord(first + j * size + i);
            real q = halfToReal(word);
            if (q == real(0.0)) continue;
            real tx = unpackGradient(word >> 16), ty = unpackGradient(word >> 24);
            real dx = real(i - x * side) + real(0.5) - half_;
            real dy = real(j - y * side) + real(0.5) - half_;
            for (int corner = 0; corner < 4; ++corner)
            {
                real ex = (corner & 1) != 0 ? real(0.5) : real(-0.5);
                real ey = (corner & 2) != 0 ? real(0.5) : real(-0.5);
                centre = max(centre, q * (real(1.0) + tx * ex + ty * ey) / (real(1.0) + gx * (dx + ex) + gy * (dy + ey)));
            }
        }
    centre *= real(1.00001); // above the rounding of the march's own evaluation
    return centre < limit ? realToHalfUp(centre) | bytes : best;
}

/// Near bound of a cell. Cost: five passes over its texels.
SCONCE_FN uint boundingPlane(uint first, uint size, int level, uint x, uint y)
{
    CellFit fit = fitCell(first, size, level, x, y);
    if (!fit.solid) return 0u;
    uint best = lowerPlane(first, size, level, x, y, vec2(real(0.0), real(0.0)), 0u);
    best = lowerPlane(first, size, level, x, y, vec2(fit.fitX / fit.mean, fit.fitY / fit.mean), best);
    best = lowerPlane(first, size, level, x, y, vec2(fit.meanX / fit.mean, fit.meanY / fit.mean), best);
    return lowerPlane(first, size, level, x, y, vec2(fit.nearX / fit.mean, fit.nearY / fit.mean), best);
}

/// Far bound of a cell, a half.
SCONCE_FN uint farBound(uint first, uint size, int level, uint x, uint y)
{
    uint side = 1u << level;
    uint lowest = 0x7bffu; // halves of one sign order as their bits do
    for (uint j = y * side; j < min((y + 1u) * side, size); ++j)
        for (uint i = x * side; i < min((x + 1u) * side, size); ++i)
            lowest = min(lowest, texelBounds(chainWord(first + j * size + i)) >> 16);
    return lowest;
}

/// The word of far bounds that holds cells 2 k and 2 k + 1.
SCONCE_FN uint farBoundPair(uint first, uint size, int top, uint k)
{
    uint pair = 0u;
    for (uint half_ = 0u; half_ < 2u; ++half_)
    {
        uint cell = 2u * k + half_;
        if (cell >= chainCells(size, top)) break;
        int level = 2;
        while (level < top && cell >= chainOffset(size, level + 2) - size * size) level += 2;
        uint at = cell + size * size - chainOffset(size, level);
        uint width = chainWidth(size, level);
        pair |= farBound(first, size, level, at % width, at / width) << (16u * half_);
    }
    return pair;
}
#endif
