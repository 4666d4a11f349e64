// The bounds of a chain's cells (face_chain.h), from the texels below. Shared text: GLSL, or C++ inside a struct that names `real` and defines
// uint chainWord(uint index).

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
