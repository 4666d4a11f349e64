#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define SCONCE_SCENE_SET 1
#include "light_field.glsl"
#include "shared/bake_passes.h"

// Bake: the light of a cell on one of its six facings, at a place in the open that the cell's probes see. See shared/light_cells.h.
// Dispatch: rows of kCellRow groups.
layout(local_size_x = kCellGroup) in;
layout(scalar, push_constant) uniform Push { SurfacePush push; };
#include "surface_rays.glsl"
vec3 sent; // by what rays ended at
uint endOfRay(vec3 point, vec3 direction, vec3 plane, vec2 lots, out float t, out vec3 emitted)
{
    emitted = vec3(0.0);
    return endThroughField(point, direction, vec3(0.0), lots, t);
}
void keepLink(uint i, uint link)
{
    if (link < kLinkDark) sent += broughtBy(link);
}
#include "shared/surface_gather.h"

void light(uint index)
{
    uint facing = index % 6u;
    ivec3 count = lightCells();
    ivec2 row = quotient(int(index / 6u), count.x), layer = quotient(row.x, count.y);
    ivec3 cell = ivec3(row.y, layer.y, layer.x);
    sent = vec3(0.0);
    uint place = openPlace(cell), first = cellWords(cell);
    if (facing == 0u) push.sent.word[first + 6u] = place;
    if (place == 0u)
    {
        push.sent.word[first + facing] = 0u;
        return;
    }
    vec3 point = cellPlace(cell, place), axis = faceDirection(int(facing), vec3(0.0, 0.0, 1.0));
    Gathered got = gatherAt(point, axis, axis, uvec2(index / 6u, facing), 0.0);
    push.sent.word[first + facing] = knowsTooLittle(got.ends, float(push.rays)) ? 0u : packKnownLight(got.light + perRay(got.ends) * sent);
}

void main()
{
    ivec3 count = lightCells();
    uint facings = 6u * uint(count.x * count.y * count.z);
    uint index = gl_GlobalInvocationID.y * kCellRow * kCellGroup + gl_GlobalInvocationID.x;
    if (index < facings) light(index);
}
