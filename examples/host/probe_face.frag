#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"
#include "sconce_probe_face.glsl"

// What a probe sees, by this host's materials. Drawn by gbuffer.vert.
layout(location = 0) in vec3 fromProbe;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out uvec4 outTexel;

void main()
{
    Surface s = surfaceAt(fromProbe, normal, uv);
    if (!s.isThere) discard;
    SconceProbeSurface seen;
    vec3 axes = vec3(1.0, 1.0, fieldsZ);
    seen.geometric = axes * sconceProbeNormal(fromProbe, s.across);
    seen.normal = axes * s.smoothed;
    seen.shading = axes * s.shading;
    seen.together = s.together;
    seen.baseColor = s.color.rgb;
    seen.metallic = s.metallic;
    seen.roughness = s.roughness;
    seen.emission = s.emission;
    outTexel = sconceProbeTexel(seen);
}
