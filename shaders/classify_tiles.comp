#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"

// Lists the tiles in which some pixel has a term, for each term, and those of the terms that are gathered, and keeps each pixel's terms for the filters,
// which ask them of every neighbour. The order of a list varies from run to run; no pixel depends on it.
// `runs` and `sparseRuns` start as (kTileRow, 0, 1, 0). Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kEveryLogId) const uint kEveryLog = 0u; // log2 of the tiles that a workgroup of a sparse pass takes
layout(scalar, set = 1, binding = kTileBinding) buffer SconceTiles
{
    TileRuns runs[kListCount];
    TileRuns sparseRuns[kListCount];
    uint tiles[];
};
shared uint tileTerms;
shared uint rowTerms[kTileSide];

void main()
{
    if (gl_LocalInvocationIndex == 0u) tileTerms = 0u;
    if (gl_LocalInvocationIndex < kTileSide) rowTerms[gl_LocalInvocationIndex] = 0u;
    barrier(); // no term may be set before all are cleared
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, ivec2(frame.size))))
    {
        uint terms = termsOf(readPixel(at));
        if (terms != 0u)
        {
            atomicOr(tileTerms, terms);
            atomicOr(rowTerms[gl_LocalInvocationID.y], terms << (kTermCount * gl_LocalInvocationID.x));
        }
    }
    barrier(); // a tile's terms are those of all its pixels
    uint list = gl_LocalInvocationIndex, all = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    if (list < kTileSide) tiles[kListCount * all + kTileSide * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + list] = rowTerms[list];
    uint wanted = list == kListGathered ? (1u << kTermDiffuse) | (1u << kTermRough) : 1u << list;
    if (list >= kListCount || (tileTerms & wanted) == 0u) return;
    uint index = atomicAdd(runs[list].count, 1u);
    atomicMax(runs[list].y, index / kTileRow + 1u);
    if (kEveryLog > 0u) atomicMax(sparseRuns[list].y, (index >> kEveryLog) / kTileRow + 1u);
    tiles[list * all + index] = gl_WorkGroupID.x | (gl_WorkGroupID.y << 16);
}
