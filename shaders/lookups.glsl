// The look-ups of a pass, each for one pixel or for 2x2 that show one flat surface: classify_tiles.comp lists them, so that no invocation idles beside an
// edge. After tiles.glsl. Dispatch: the list's TileRuns.
#include "look_up_rows.glsl"
#ifndef SCONCE_READS_PIXEL
#define SCONCE_READS_PIXEL readPixel
#endif
layout(constant_id = kLookUpListId) const uint kLookUpList = 0u;

struct LookUp
{
    ivec2 at;   // its pixel, the first where it is for four
    int pixels; // 1 or 4
    float across; // of four, from the first to the last, metres; readLookUp() sets it
};

uint lookUpWord(uint list, uint index)
{
    uvec2 all = (frame.size + kTileSide - 1u) / kTileSide;
    return (kTermCount + kTileSide + 64u * list) * all.x * all.y + index;
}

/// @return  whether there is one for this invocation
bool findLookUp(out LookUp found)
{
    uint index = 64u * (gl_WorkGroupID.y * kTileRow + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    if (index >= lookUpRuns[kLookUpList].count) return false;
    uint word = tiles[lookUpWord(kLookUpList, index)];
    found.at = ivec2(word & 0xffffu, (word >> 16) & 0x7fffu);
    found.pixels = (word & kLookUpOfQuad) != 0u ? 4 : 1;
    return true;
}

ivec2 pixelOf(LookUp l, int i) { return l.at + ivec2(i & 1, i >> 1); }

/// Its pixel, or what is in the middle of four: their place, normal and roughness; the rest as the first has it.
Pixel readLookUp(inout LookUp l)
{
    Pixel p = SCONCE_READS_PIXEL(l.at);
    l.across = 0.0;
    if (l.pixels == 1) return p;
    Pixel q = SCONCE_READS_PIXEL(l.at + 1); // across: halfway between is the middle
    l.across = distance(p.position, q.position);
    p.position = 0.5 * (p.position + q.position);
    p.normal = normalize(p.normal + q.normal);
    p.brdf.roughness = 0.5 * (p.brdf.roughness + q.brdf.roughness);
    p.view = viewerOfLobes(p.normal, normalize(frame.eye - p.position), p.retro);
    return p;
}

#ifdef SCONCE_LEAVES_LOOK_UPS
// Of a pass that leaves some look-ups to a second dispatch: where lanes are vectors, few that take long would have all wait.
layout(constant_id = kLookUpRestId) const uint kRest = 0u;  // the list that look-ups are left to
layout(constant_id = kIsRestId) const bool kIsRest = false; // this is the second dispatch

/// Leaves a look-up, or each of its pixels alone.
void leave(LookUp l, bool alone)
{
    uint count = alone ? uint(l.pixels) : 1u;
    uint index = atomicAdd(lookUpRuns[kRest].count, count);
    uint rows = rowsOfLookUps(index + count);
    if (rows > rowsOfLookUps(index)) atomicMax(lookUpRuns[kRest].y, rows);
    for (uint i = 0u; i < count; ++i)
    {
        uvec2 at = uvec2(pixelOf(l, int(i)));
        tiles[lookUpWord(kRest, index + i)] = at.x | (at.y << 16) | (!alone && l.pixels > 1 ? kLookUpOfQuad : 0u);
    }
}
#endif
