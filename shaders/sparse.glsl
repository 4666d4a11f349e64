// Tracing one pixel of 2, 4, 8 or 16 and making the rest from those about it. After gbuffer_read.glsl.
#include "packed_pixel.glsl"
layout(constant_id = kEveryLogId) const uint kEveryLog = 0u; // log2 of the pixels for each that is traced, 0..4

// A regular lattice: one pixel of each cell, whose place changes from frame to frame, so that a filter over time meets all. For 2 and 8, whose
// cells are twice as wide as high, every other row is shifted by half a cell.
const ivec2 kCell = ivec2(1 << ((kEveryLog + 1u) / 2u), 1 << (kEveryLog / 2u)); // pixels
const float kTent = 1.5;        // cells that a traced pixel reaches to each side
const float kLeastWeight = 0.05; // of the best traced pixel: with less a pixel is traced itself

ivec2 latticePixel(ivec2 cell)
{
    uint turn = bitfieldReverse(frame.seed) >> (32u - max(kEveryLog, 1u)); // far from the turn before it
    ivec2 place = ivec2(turn % uint(kCell.x), (turn / uint(kCell.x)) % uint(kCell.y));
    if ((kEveryLog & 1u) != 0u) place.x = (place.x + (cell.y & 1) * kCell.x / 2) % kCell.x;
    return cell * kCell + place;
}

/// What a traced pixel says of another, [0,1]: 0 across edges, outside the picture and where it lacks the term (Bala, Walter, Greenberg 2003,
/// "Combining Edges and Points for Interactive High-Quality Rendering", interpolate between sparse samples and never over an edge).
float latticeWeight(Surroundings about, ivec2 at, ivec2 tap, uint term)
{
    vec2 away = abs(vec2(tap - at)) / (kTent * vec2(kCell));
    if (any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(frame.size))) || max(away.x, away.y) >= 1.0) return 0.0;
    uint terms;
    Pixel q = readPacked(tap, terms);
    if ((terms & (1u << term)) == 0u) return 0.0;
    return (1.0 - away.x) * (1.0 - away.y) * likeness(about, q);
}

/// The nine cells about a pixel's, its own first.
ivec2 cellAbout(ivec2 at, int i) { return at / kCell + ivec2((i + 1) % 3, ((i + 4) / 3) % 3) - 1; }

/// Whether a pixel of the term is traced: it is of the lattice, or nothing there is like it, or its reflections are sharper than the lattice.
bool isTraced(Pixel p, ivec2 at, uint term)
{
    if (latticePixel(at / kCell) == at) return true;
    if (term == kTermGlossy && filterReach(p.brdf.roughness) < float(kCell.x)) return true;
    Surroundings about = surroundingsOf(p);
    for (int i = 0; i < 9; ++i)
        if (latticeWeight(about, at, latticePixel(cellAbout(at, i)), term) >= kLeastWeight) return false;
    return true;
}
