#version 460
#extension GL_GOOGLE_include_directive : require
#include "drawn_faces.glsl"

// A host's vertices, in the world's metres, each with its material.
layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec4 inBaseMetallic;
layout(location = 3) in vec4 inEmissionRoughness;
layout(location = 0) out vec3 relative;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec4 baseMetallic;
layout(location = 3) flat out vec4 emissionRoughness;

void main()
{
    relative = inPosition - centre;
    normal = inNormal;
    baseMetallic = inBaseMetallic;
    emissionRoughness = inEmissionRoughness;
    gl_Position = clipFromRelative * vec4(relative, 1.0);
}
