#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef MASKED
#define SCONCE_POSITIONS_ONLY
#endif
#include "scene_vertex.glsl"

// Depth of the scene from a light. With MASKED, what shadow_masked.frag needs to cut holes.
#ifdef MASKED
layout(location = 0) out vec2 outUv;
layout(location = 1) flat out uint outMaterial;
#endif

void main()
{
    gl_Position = view.clip * vec4(inPosition - view.centre, 1.0);
#ifdef MASKED
    outUv = inUv;
    outMaterial = inMaterial;
#endif
}
