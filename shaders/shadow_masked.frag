#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"

// Cuts the holes of alpha-masked materials into a depth map.
layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint material;

void main()
{
    if (!isThere(material, uv, dFdx(uv), dFdy(uv), gl_FragCoord)) discard;
}
