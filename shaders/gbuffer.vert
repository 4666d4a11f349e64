#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene_vertex.glsl"

// The frame's G-buffer: the scene seen by a camera. Depth is reversed and infinite: near/W.
layout(location = 0) out vec3 relative; // to the eye, field units
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;
layout(location = 3) flat out uint material;

void main()
{
    relative = inPosition - view.centre;
    normal = inNormal;
    uv = inUv;
    material = inMaterial;
    gl_Position = view.clip * vec4(relative, 1.0);
}
