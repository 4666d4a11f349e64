#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#define SCONCE_SHAPES_ARE
#include "gbuffer_read.glsl"
#include "moving_shapes.glsl"

// Light that falls on six facings of each shape that moves, of all but the host's own lights: from the cells in the open, as on whatever else no probe
// knows. Dispatch: ceil(6 shapes / 64).
layout(local_size_x = 64) in;

/// Of the world's axes.
vec3 facingOf(uint i)
{
    float side = (i & 1u) == 0u ? 1.0 : -1.0;
    return side * vec3(i < 2u, (i >> 1) == 1u, i > 3u);
}

/// The shape's farthest point along a direction of its own.
vec3 farthestOf(MovingShapeData s, vec3 along)
{
    if (s.kind == kShapeIsBox) return s.half_ * mix(vec3(-1.0), vec3(1.0), greaterThan(along, vec3(-1e-6))) * vec3(greaterThan(abs(along), vec3(1e-6)));
    return s.half_.x * along + vec3(0.0, abs(along.y) > 1e-6 ? sign(along.y) * s.half_.y : 0.0, 0.0);
}

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= movingHead.count * kShapeFacings) return;
    MovingShapeData s = movingShape[index / kShapeFacings];
    vec3 facing = facingOf(index % kShapeFacings);
    vec3 at = sconceFieldPoint(s.centre + fromShape(s, farthestOf(s, toShape(s, facing))));
    vec3 lifted = at + 0.5 * field.voxel * facing;
    int reads = 0;
    vec4 open = vec4(0.0);
    if (field.surfaceSize > 0u) open = cellLightAt(lifted, facing, rankedProbesAt(lifted, reads));
    movingLight[index] = open.w > 0.0 ? open.rgb : irradianceAt(at, facing, lifted, reads);
}
