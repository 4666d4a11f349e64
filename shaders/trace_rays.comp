#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_ASKS_FOR_MAPS
#include "light_field.glsl"
#define SCONCE_QUERY sconceQuery
#include "ray_walk.glsl"
#include "trace_rays.glsl"
