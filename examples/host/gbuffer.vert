#version 460
#extension GL_GOOGLE_include_directive : require
#include "gbuffer_push.glsl"

layout(location = 0) in vec3 inPosition;
layout(location = 1) in vec3 inNormal;
layout(location = 2) in vec2 inUv;
layout(location = 0) out vec3 fromEye;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;

void main()
{
    fromEye = inPosition - eye;
    normal = inNormal;
    uv = inUv;
    gl_Position = clipFromRelative * vec4(fromEye, 1.0);
}
