#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_FIELD_SET 0
#include "light_field.glsl"
#include "opponents/grid_light.glsl"

vec3 bounceIrradiance(vec3 point, vec3 normal, vec3 viewer)
{
    vec3 sum = vec3(0.0), view = viewer - point;
    if (!canGather(point, normal)) return sum;
    float weights = 1e-30;
    GridCell cell = gridCellOf(point);
    for (int corner = 0; corner < kGridCorners; ++corner)
    {
        uint probe;
        float weight = gridWeight(cell, corner, point, normal, view / max(length(view), 1e-6), probe);
        sum += weight * probeIrradiance(probe, normal);
        weights += weight;
    }
    return sum / weights;
}
#include "bake_bounce.glsl"
