// Shapes that move: what a frame holds of them, which the light field doesn't know. moving_text.h asks them.
#include "shared/gpu_types.h"
#ifndef SCONCE_MOVING_SHAPES_H
#define SCONCE_MOVING_SHAPES_H
SCONCE_STRUCTS_BEGIN

const uint kMostMovingShapes = 256u; // a frame
const uint kShapesOfGroup = 8u;      // neighbours, behind one sphere that rays ask first
const uint kMostShapeGroups = kMostMovingShapes / kShapesOfGroup;
const uint kShapeFacings = 6u;       // +x, -x, +y, -y, +z, -z of the world

const uint kShapeIsRound = 0u; // a sphere, or a capsule along its y
const uint kShapeIsBox = 1u;

struct MovingShapeData
{
    vec3 centre;    // world, metres
    float reach;    // radius of the sphere about the centre that holds it
    vec4 turn;      // unit quaternion, its axes to the world's
    vec3 half_;     // metres: of a box from its middle to its faces; else radius, from the middle to the ends' centres, 0
    uint kind;
    vec3 albedo;    // of light that it scatters, [0,1]
    float slack;    // metres that what is drawn of it may lie off it
    vec3 emission;  // W/(m^2 sr), to all sides
    uint unused;
};
SCONCE_CHECK_SIZE(MovingShapeData, 80);

/// Ahead of the shapes in their buffer.
struct MovingShapesHead
{
    uint count;
    uint groups;                     // of kShapesOfGroup each, the last of fewer
    vec4 group[kMostShapeGroups];    // world: middle and radius of a sphere that holds its shapes
};
SCONCE_CHECK_SIZE(MovingShapesHead, 520);

SCONCE_STRUCTS_END
#endif
