#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SCENE_SET 1
#include "light_field.glsl"
#include "shared/bake_passes.h"

// Bake: the light of a cell on one of its six facings, at a place in the open that the cell's probes see. See shared/light_cells.h.
// Dispatch: ceil(6 x cells / kCellGroup).
layout(local_size_x = kCellGroup) in;
layout(scalar, push_constant) uniform Push { SurfacePush push; };
#include "surface_rays.glsl"

const int kPlacesTried = 32;
const float kLeastClearance = 0.5; // finest voxels to the surfaces that the probe sees about the place

/// A place in the cell that a probe of its leaf sees, the nearest to nothing first; without kCellKnown where there is none.
uint openPlace(ivec3 cell)
{
    for (int i = 0; i < kPlacesTried; ++i)
    {
        // From the middle on by the sequence R3 (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
        vec3 within = fract(0.5 + float(i) * vec3(0.8191725, 0.6710436, 0.5497005));
        uvec3 steps = uvec3(within * kCellPlaces);
        uint place = steps.x | (steps.y << 10) | (steps.z << 20) | kCellKnown;
        vec3 point = cellPlace(cell, place);
        int reads = 0;
        uvec4 ranked = rankedProbesAt(point, reads);
        for (int k = 0; k < kRanked; ++k)
        {
            vec3 from = point - probeHeader(ranked[k]).centre;
            vec3 plane = planeSeen(ranked[k], from);
            if (1.0 - dot(plane, from) > kLeastClearance * field.voxel * length(plane)) return place;
        }
    }
    return 0u;
}

void main()
{
    uint index = gl_GlobalInvocationID.x, facing = index % 6u;
    ivec3 count = lightCells();
    ivec2 row = quotient(int(index / 6u), count.x), layer = quotient(row.x, count.y);
    ivec3 cell = ivec3(row.y, layer.y, layer.x);
    if (cell.z >= count.z) return;
    uint place = openPlace(cell), first = cellWords(cell);
    if (facing == 0u) push.sent.word[first + 6u] = place;
    if (place == 0u)
    {
        push.sent.word[first + facing] = 0u;
        return;
    }
    vec3 point = cellPlace(cell, place), axis = faceDirection(int(facing), vec3(0.0, 0.0, 1.0));
    TangentFrame tangents = tangentFrame(axis);
    uvec2 pixel = uvec2(index / 6u, facing);
    vec3 sky = vec3(0.0), sum = vec3(0.0);
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.rays; ++i)
    {
        float t;
        uint link = endOfRay(point, gatherDirection(tangents, pixel, i), vec3(0.0), pairOfRay(pixel, i, kLinkStream), t);
        if (link == kLinkSky) sky += field.sky;
        if (countEnd(ends, link)) sum += unpackSharedExponent(push.sentBefore.word[link]);
    }
    vec3 light = sky / max(ends.all, 1.0) + perRay(ends) * sum;
    float variance;
    vec3 tilt;
    if (lightsHeader.emitterCount > 0u) light += emittersAt(point, axis, axis, pixel, variance, tilt);
    push.sent.word[first + facing] = ends.all - ends.surfaces + ends.known < kLeastKnown * float(push.rays) ? 0u : packKnownLight(light);
}
