#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#define SCONCE_QUERY sconceQuery
#include "trace_rays.glsl"
