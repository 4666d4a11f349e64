#version 460
#extension GL_GOOGLE_include_directive : require
#include "probe_face.glsl"

layout(location = 0) in vec3 relative;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec4 baseMetallic;
layout(location = 3) flat in vec4 emissionRoughness;
layout(location = 0) out uvec4 texel;

void main()
{
    SconceProbeSurface surface;
    surface.geometric = sconceProbeNormal(relative, cross(dFdx(relative), dFdy(relative)));
    surface.normal = surface.shading = normalize(normal);
    surface.together = 1.0;
    surface.baseColor = baseMetallic.rgb;
    surface.metallic = baseMetallic.a;
    surface.roughness = emissionRoughness.a;
    surface.emission = emissionRoughness.rgb;
    texel = sconceProbeTexel(surface);
}
