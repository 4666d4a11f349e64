#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"

// What Sconce reads of a pixel, and its emission. Normals are turned to the viewer's side, in this host's world.
layout(location = 0) in vec3 fromEye;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 outNormalRoughness;
layout(location = 1) out vec4 outBaseColorMetallic;
layout(location = 2) out vec4 outEmission;

void main()
{
    Surface s = surfaceAt(fromEye, normal, uv);
    if (!s.isThere) discard;

    vec3 view = normalize(-fromEye), flat_ = dot(s.across, s.across) > 0.0 ? normalize(s.across) : s.smoothed;
    if (dot(flat_, view) < 0.0) flat_ = -flat_;
    vec3 shading = dot(s.smoothed, flat_) < 0.0 ? -s.shading : s.shading;
    if (dot(shading, view) <= 0.0) shading = flat_; // interpolated or bent away from the eye
    outNormalRoughness = vec4(shading, s.roughness);
    outBaseColorMetallic = vec4(s.color.rgb, s.metallic);
    outEmission = vec4(s.emission, 1.0);
}
