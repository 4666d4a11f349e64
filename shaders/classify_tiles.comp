#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"
#define SCONCE_PACKS
#include "packed_pixel.glsl"
#include "look_up_rows.glsl"

// Lists the tiles in which some pixel has a term, for each term, and keeps each pixel's terms for the filters,
// which ask them of every neighbour; packs what filters ask of a pixel; and lists what passes look up. The order of a list varies from run to run; no pixel depends on it.
// All runs start as (kTileRow, 0, 1, 0). Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kTiledId) const bool kTiled = true; // false: look-ups of every pixel, needed or not
layout(constant_id = kEveryLogId) const uint kEveryLog = 0u; // log2 of the tiles that a workgroup of a sparse pass takes
layout(constant_id = kLookUpTermsId) const uint kTermsOfFirst = 0u;
layout(constant_id = kLookUpTermsId + 1u) const uint kTermsOfSecond = 0u;
layout(constant_id = kLookUpTermsId + 2u) const uint kTermsOfThird = 0u;
layout(constant_id = kLookUpTermsId + 3u) const uint kTermsOfFourth = 0u;
layout(constant_id = kLookUpKindId) const uint kKindOfFirst = kLookUpsPerPixel;
layout(constant_id = kLookUpKindId + 1u) const uint kKindOfSecond = kLookUpsPerPixel;
layout(constant_id = kLookUpKindId + 2u) const uint kKindOfThird = kLookUpsPerPixel;
layout(constant_id = kLookUpKindId + 3u) const uint kKindOfFourth = kLookUpsPerPixel;
layout(scalar, set = 1, binding = kTileBinding) buffer SconceTiles
{
    TileRuns runs[kTermCount];
    TileRuns sparseRuns[kTermCount];
    TileRuns lookUpRuns[kMostLookUpLists];
    uint tiles[];
};
const uint kIsSurface = 1u << kTermCount;

// How much pixels of one look-up may differ from their mean.
const float kTurn = 0.99;      // least cosine between normals
const float kTurnOfBent = 0.7;
const float kOff = 0.1;        // distance off the plane over that along it
const float kOffOfBent = 0.3;
const float kRoughness = 0.05;

shared uint tileTerms;
shared uint rowTerms[kTileSide];
shared uint pixelTerms[64];  // bits of terms, kIsSurface
shared vec4 pixelPlace[64];  // position, roughness
shared vec3 pixelNormal[64];
shared uint foundCount[kMostLookUpLists], foundFirst[kMostLookUpLists];
shared uint found[kMostLookUpLists * 64u];

uint termsOfList(uint list) { return list == 0u ? kTermsOfFirst : list == 1u ? kTermsOfSecond : list == 2u ? kTermsOfThird : kTermsOfFourth; }
uint kindOfList(uint list) { return list == 0u ? kKindOfFirst : list == 1u ? kKindOfSecond : list == 2u ? kKindOfThird : kKindOfFourth; }

uint quadPixel(uint first, uint i) { return first + (i & 1u) + (i >> 1) * kTileSide; }

bool isOneSurface(uint first, uint kind)
{
    bool bent = kind == kLookUpsBent;
    vec4 place[4], middle = vec4(0.0);
    vec3 normal[4], mean = vec3(0.0);
    for (int i = 0; i < 4; ++i)
    {
        place[i] = pixelPlace[quadPixel(first, uint(i))];
        normal[i] = pixelNormal[quadPixel(first, uint(i))];
        middle += 0.25 * place[i], mean += normal[i];
    }
    mean = normalize(mean);
    bool isOne = true;
    for (int i = 0; i < 4; ++i)
    {
        vec4 off = place[i] - middle;
        isOne = isOne && dot(mean, normal[i]) > (bent ? kTurnOfBent : kTurn) &&
                abs(dot(mean, off.xyz)) <= (bent ? kOffOfBent : kOff) * length(off.xyz) && (bent || abs(off.w) < kRoughness);
    }
    return isOne;
}

/// The look-ups of a quad for a list.
void find(uint list, uint quad)
{
    uint first = 2u * (quad % 4u) + 2u * kTileSide * (quad / 4u), ofList = termsOfList(list), wanted = 0u;
    bool alike = kindOfList(list) != kLookUpsPerPixel && (pixelTerms[first] & ofList) != 0u;
    for (uint i = 0u; i < 4u; ++i)
    {
        uint terms = pixelTerms[quadPixel(first, i)];
        alike = alike && (terms & ofList) == (pixelTerms[first] & ofList);
        if ((terms & (kTiled ? ofList : kIsSurface)) != 0u) wanted |= 1u << i;
    }
    uvec2 at = kTileSide * gl_WorkGroupID.xy + uvec2(first % kTileSide, first / kTileSide);
    if (alike && isOneSurface(first, kindOfList(list)))
        found[64u * list + atomicAdd(foundCount[list], 1u)] = at.x | (at.y << 16) | kLookUpOfQuad;
    else
        for (uint i = 0u; i < 4u; ++i)
            if ((wanted & (1u << i)) != 0u) found[64u * list + atomicAdd(foundCount[list], 1u)] = (at.x + (i & 1u)) | ((at.y + (i >> 1)) << 16);
}

void main()
{
    uint invocation = gl_LocalInvocationIndex, tileCount = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    if (invocation == 0u) tileTerms = 0u;
    if (invocation < kTileSide) rowTerms[invocation] = 0u;
    if (invocation < kMostLookUpLists) foundCount[invocation] = 0u;
    barrier(); // no term may be set before all are cleared
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    uint terms = 0u;
    if (all(lessThan(at, ivec2(frame.size))))
    {
        Pixel p = readPixel(at);
        terms = termsOf(p) | (p.surface ? kIsSurface : 0u);
        pixelPlace[invocation] = vec4(p.position, lobeOf(p));
        pixelNormal[invocation] = p.normal;
        imageStore(packedPixels, at, uvec4(packedOf(p, terms & (kIsSurface - 1u)), 0u, 0u));
        if (terms != 0u)
        {
            atomicOr(tileTerms, terms & (kIsSurface - 1u));
            atomicOr(rowTerms[gl_LocalInvocationID.y], (terms & (kIsSurface - 1u)) << (kTermCount * gl_LocalInvocationID.x));
        }
    }
    pixelTerms[invocation] = terms;
    barrier(); // a tile's terms are those of all its pixels
    for (uint i = invocation; i < 16u * kMostLookUpLists; i += 64u)
        if (termsOfList(i / 16u) != 0u) find(i / 16u, i % 16u);
    uint list = invocation;
    if (list < kTileSide) tiles[kTermCount * tileCount + kTileSide * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + list] = rowTerms[list];
    if (list < kTermCount && (tileTerms & (1u << list)) != 0u)
    {
        uint index = atomicAdd(runs[list].count, 1u);
        // Only the first of a row makes it one more: tiles of the whole picture change these words, one after the other.
        if (index % kTileRow == 0u) atomicMax(runs[list].y, index / kTileRow + 1u);
        if (kEveryLog > 0u && index % (kTileRow << kEveryLog) == 0u) atomicMax(sparseRuns[list].y, (index >> kEveryLog) / kTileRow + 1u);
        tiles[list * tileCount + index] = gl_WorkGroupID.x | (gl_WorkGroupID.y << 16);
    }
    barrier(); // the quads' look-ups are all found
    if (invocation < kMostLookUpLists && foundCount[invocation] > 0u)
    {
        foundFirst[invocation] = atomicAdd(lookUpRuns[invocation].count, foundCount[invocation]);
        uint rows = rowsOfLookUps(foundFirst[invocation] + foundCount[invocation]);
        if (rows > rowsOfLookUps(foundFirst[invocation])) atomicMax(lookUpRuns[invocation].y, rows);
    }
    barrier(); // their place in the list is known
    for (uint of = 0u; of < kMostLookUpLists; ++of)
        if (invocation < foundCount[of]) tiles[(kTermCount + kTileSide + 64u * of) * tileCount + foundFirst[of] + invocation] = found[64u * of + invocation];
}
