// Which pixel an invocation works on: a pass runs on the tiles of a list, or over the whole picture. After gbuffer_read.glsl.
layout(constant_id = kTiledId) const bool kTiled = true; // false: over the whole picture, every pixel computed, needed or not
#ifdef SCONCE_LEAVES_LOOK_UPS
#define SCONCE_TILES_ARE coherent // the pass adds to the lists
#else
#define SCONCE_TILES_ARE readonly
#endif
layout(scalar, set = 1, binding = kTileBinding) SCONCE_TILES_ARE buffer SconceTiles
{
    TileRuns runs[kTermCount];
    TileRuns sparseRuns[kTermCount]; // of passes whose workgroups take several tiles each
    TileRuns lookUpRuns[kMostLookUpLists];
    // [list][as many as the picture has]: x | y << 16; then [tile][row]: the terms of its 8 pixels, kTermCount bits each; then [look-ups' list][64 a tile]: x | y << 16, bit 31: of four
    uint tiles[];
};

uint tileCount(uint list)
{
    uvec2 all = (frame.size + kTileSide - 1u) / kTileSide;
    return kTiled ? runs[list].count : all.x * all.y;
}

/// @param index  0..tileCount(list)-1
/// @return  its first pixel
ivec2 tileOrigin(uint list, uint index)
{
    uvec2 all = (frame.size + kTileSide - 1u) / kTileSide;
    if (!kTiled) return int(kTileSide) * ivec2(index % all.x, index / all.x);
    uint tile = tiles[list * all.x * all.y + index];
    return int(kTileSide) * ivec2(tile & 0xffffu, tile >> 16);
}

/// As termsOf(readPixel(at)) for a pixel of the picture.
uint termsAt(ivec2 at)
{
    uvec2 tile = uvec2(at) / kTileSide, all = (frame.size + kTileSide - 1u) / kTileSide;
    uint row = kTermCount * all.x * all.y + kTileSide * (tile.y * all.x + tile.x) + uint(at.y) % kTileSide;
    return (tiles[row] >> (kTermCount * (uint(at.x) % kTileSide))) & ((1u << kTermCount) - 1u);
}

uint workgroupIndex() { return gl_WorkGroupID.y * (kTiled ? kTileRow : gl_NumWorkGroups.x) + gl_WorkGroupID.x; }

/// Dispatch: the list's TileRuns, or ceil(width/8) x ceil(height/8).
/// @return  whether there is a pixel to work on
bool findPixel(uint list, out ivec2 at)
{
    uint index = workgroupIndex();
    if (index >= tileCount(list)) return false;
    at = tileOrigin(list, index) + ivec2(gl_LocalInvocationID.xy);
    return all(lessThan(at, ivec2(frame.size)));
}

/// Whether the pass may leave this pixel out.
bool isNotOf(uint term, uint terms) { return kTiled && (terms & (1u << term)) == 0u; }
