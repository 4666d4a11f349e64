#version 460
#extension GL_GOOGLE_include_directive : require
#include "opponents/baseline.glsl"
#define SCONCE_QUERY opponentQuery
#include "opponents/baseline_walk.glsl"
#include "trace_rays.glsl"
