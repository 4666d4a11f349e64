#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"
#include "stored_light.glsl"
#include "shared/chart.h"

// See gbuffer.vert. Normals are turned to the viewer's side: every surface has two.
layout(location = 0) in vec3 relative;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint material;
layout(location = 0) out vec4 outNormalRoughness;
layout(location = 1) out vec4 outBaseColorMetallic;
layout(location = 2) out vec4 outDirect;         // emission: what direct.comp adds to
layout(location = 3) out uint outGeometricNormal; // octahedral, 2 x 16 bits
layout(constant_id = kRoughnessOverrideId) const float kRoughnessOverride = -1.0; // >= 0: every surface has this roughness

void main()
{
    vec2 uvDx = dFdx(uv), uvDy = dFdy(uv);
    vec3 across = dFdx(relative), down = dFdy(relative);
    if (!isThere(material, uv, uvDx, uvDy, gl_FragCoord)) discard;
    SurfacePoint point = evaluateMaterial(material, uv, uvDx, uvDy);
    vec3 view = normalize(-relative);
    // Through a telescope neighbouring pixels differ by less than positions are exact to: then the plane is the vertices' word.
    vec3 plane = cross(across, down);
    float finest = min(dot(across, across), dot(down, down)), squared = dot(normal, normal);
    vec3 smooth_ = squared > 1e-12 ? normalize(normal) : view;
    vec3 geometric = finest > 1e-11 * dot(relative, relative) && dot(plane, plane) > 1e-37 ? normalize(plane) : smooth_;
    if (dot(geometric, view) < 0.0) geometric = -geometric;
    vec3 shading = mappedNormal(material, uv, uvDx, uvDy, smooth_, across, down);
    if (dot(smooth_, geometric) < 0.0) shading = -shading;
    if (dot(shading, view) <= 0.0) shading = geometric; // interpolated or bent away from the eye
    outNormalRoughness = vec4(shading, (kRoughnessOverride >= 0.0 ? kRoughnessOverride : point.roughness) + sconceMaterials[material].retro);
    outBaseColorMetallic = vec4(point.baseColor.rgb, point.metallic);
    outDirect = storedBright(point.emission);
    outGeometricNormal = packUnorm2x16(octahedralFromDirection(geometric));
}
