// Shapes that move (shared/moving_shapes.h), for passes that ask them. After gbuffer_read.glsl. Define SCONCE_SHAPES_ARE where a pass writes their light.
#include "shared/moving_shapes.h"
#include "shared/polygon_light.h"
#include "shared/moving_text.h"
#ifndef SCONCE_SHAPES_ARE
#define SCONCE_SHAPES_ARE readonly
#endif
layout(scalar, set = 1, binding = kMovingBinding) SCONCE_SHAPES_ARE buffer SconceMovingShapes
{
    MovingShapesHead movingHead;
    MovingShapeData movingShape[kMostMovingShapes];
    vec3 movingLight[kMostMovingShapes * kShapeFacings]; // mean of the arriving radiance, weighted by the cosine, on each facing
};

const float kOfShape = 0.3; // cosine of a surface's normal to the shape's, beyond which it is taken for the shape's own

vec3 toShape(MovingShapeData s, vec3 v) { return turnedBy(-s.turn.xyz, s.turn.w, v); }
vec3 fromShape(MovingShapeData s, vec3 v) { return turnedBy(s.turn.xyz, s.turn.w, v); }

ShapeDistance distanceTo(MovingShapeData s, vec3 at)
{
    if (s.kind == kShapeIsBox) return distanceToBox(at, s.half_);
    return distanceToRound(at, s.half_.x, s.half_.y);
}

/// Whether a surface point is one of the shape's own: what is drawn of it need not lie on it.
bool isOfShape(MovingShapeData s, vec3 at, vec3 normal)
{
    ShapeDistance d = distanceTo(s, at);
    return d.away < s.slack && dot(d.outward, normal) > kOfShape;
}

/// What a shape sends towards a normal of its own, of the world.
vec3 radianceOfShape(uint index, vec3 normal)
{
    MovingShapeData s = movingShape[index];
    vec3 weight = normal * normal;
    vec3 light = vec3(0.0);
    for (uint axis = 0u; axis < 3u; ++axis) light += weight[axis] * movingLight[index * kShapeFacings + 2u * axis + (normal[axis] < 0.0 ? 1u : 0u)];
    return s.emission + s.albedo * light;
}

/// Puts a shape before a ray's hit where it stands there.
/// @param normal  of the surface that the ray starts on, or 0
void meetShapes(vec3 origin, vec3 direction, vec3 normal, inout RayHit hit)
{
    float nearest = hit.status == kMiss || !(hit.t > 0.0) ? 1e30 : hit.t;
    uint met = kMostMovingShapes;
    vec3 outward = vec3(0.0);
    for (uint group = 0u; group < movingHead.groups; ++group)
    {
        vec3 to = movingHead.group[group].xyz - origin;
        float radius = movingHead.group[group].w, along = max(dot(to, direction), 0.0);
        vec3 off = to - along * direction;
        if (dot(off, off) > radius * radius || along - radius > nearest) continue;
        uint last = min((group + 1u) * kShapesOfGroup, movingHead.count);
        for (uint i = group * kShapesOfGroup; i < last; ++i)
        {
            MovingShapeData s = movingShape[i];
            vec3 from = toShape(s, origin - s.centre), way = toShape(s, direction);
            float t = s.kind == kShapeIsBox ? rayToBox(from, way, s.half_) : rayToRound(from, way, s.half_.x, s.half_.y);
            if (!(t > 0.0 && t < nearest)) continue;
            if (dot(normal, normal) > 0.0 && isOfShape(s, from, toShape(s, normal))) continue;
            nearest = t;
            met = i;
            outward = fromShape(s, distanceTo(s, from + t * way).outward);
        }
    }
    if (met == kMostMovingShapes) return;
    hit.t = nearest;
    hit.status = kHit;
    hit.position = origin + nearest * direction;
    hit.normal = outward;
    hit.radiance = radianceOfShape(met, outward);
}
