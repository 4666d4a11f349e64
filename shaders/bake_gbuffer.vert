#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene_vertex.glsl"

// The scene as a probe's cube face sees it: clip = (U, V, near, W), so that depth is near / W and never clipped at the far end.
layout(location = 0) out vec3 outRelative; // probe-relative, field units
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec2 outUv;
layout(location = 3) flat out uint outMaterial;

void main()
{
    outRelative = inPosition - view.centre;
    outNormal = inNormal;
    outUv = inUv;
    outMaterial = inMaterial;
    gl_Position = view.clip * vec4(outRelative, 1.0);
}
