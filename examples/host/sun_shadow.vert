#version 460
layout(location = 0) in vec3 inPosition;
layout(push_constant) uniform Push { mat4 clipFromWorld; };

void main() { gl_Position = clipFromWorld * vec4(inPosition, 1.0); }
