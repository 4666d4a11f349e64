#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"
#include "gather_votes.glsl"
#include "gather_light.glsl"
