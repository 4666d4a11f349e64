#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"
#include "probe_face.glsl"

// The scene as a probe's cube face sees it.
layout(location = 0) in vec3 relative;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint material;
layout(location = 0) out uvec4 outSurface;

void main()
{
    vec2 uvDx = dFdx(uv), uvDy = dFdy(uv);
    vec3 relativeDx = dFdx(relative), relativeDy = dFdy(relative);
    SconceProbeSurface seen;
    seen.geometric = sconceProbeNormal(relative, cross(relativeDx, relativeDy));
#ifdef MASKED
    if (!isThere(material, uv, uvDx, uvDy, gl_FragCoord)) discard;
#endif
    float lengthSquared = dot(normal, normal);
    seen.normal = lengthSquared > 1e-12 ? normal * inversesqrt(lengthSquared) : seen.geometric;
    seen.shading = mappedNormal(material, uv, uvDx, uvDy, seen.normal, relativeDx, relativeDy, seen.together);
    SurfacePoint surface = evaluateMaterial(material, uv, uvDx, uvDy);
    seen.baseColor = surface.baseColor.rgb;
    seen.metallic = surface.metallic;
    seen.roughness = surface.roughness;
    seen.emission = surface.emission;
    outSurface = sconceProbeTexel(seen);
}
