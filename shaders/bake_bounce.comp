#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_FIELD_SET 0
#include "light_field.glsl"

/// The leaf is asked half a voxel off the surface, on the side that the probe sees.
vec3 bounceIrradiance(vec3 point, vec3 normal, vec3 viewer)
{
    int reads = 0;
    return irradianceAt(point, normal, point + 0.5 * field.voxel * normal, reads);
}
#include "bake_bounce.glsl"
