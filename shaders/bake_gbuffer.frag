#version 460
#extension GL_GOOGLE_include_directive : require
#include "material.glsl"
#include "shared/brdf.h"
#include "bake_seen.glsl"
#include "shared/color.h"

// What a probe's texel shows, in one 4 x 32-bit texel: (root of the surface's hemispherical albedo, 3 x 10), (shading normal, and how much of light
// straight from lights counts: packSeen), (geometric normal, octahedral 2 x 16), (emission, R11G11B10F). Both normals face the probe.
layout(location = 0) in vec3 relative;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) flat in uint material;
layout(location = 0) out uvec4 outSurface;

void main()
{
    vec2 uvDx = dFdx(uv), uvDy = dFdy(uv);
    vec3 relativeDx = dFdx(relative), relativeDy = dFdy(relative);
    vec3 across = cross(relativeDx, relativeDy);
#ifdef MASKED
    if (!isThere(material, uv, uvDx, uvDy, gl_FragCoord)) discard;
#endif
    float area = dot(across, across);
    vec3 geometric = area > 0.0 ? across * inversesqrt(area) : -normalize(relative); // edge-on: some finite normal
    if (dot(geometric, relative) > 0.0) geometric = -geometric;
    float lengthSquared = dot(normal, normal);
    vec3 smooth_ = lengthSquared > 1e-12 ? normal * inversesqrt(lengthSquared) : geometric;
    float together;
    vec3 shading = mappedNormal(material, uv, uvDx, uvDy, smooth_, relativeDx, relativeDy, together);
    if (dot(smooth_, geometric) < 0.0) shading = -shading;
    SurfacePoint surface = evaluateMaterial(material, uv, uvDx, uvDy);
    BrdfSurface reflecting = BrdfSurface(clamp(surface.baseColor.rgb, 0.0, 1.0), surface.metallic, surface.roughness);
    vec3 albedo = hemisphericalAlbedo(reflecting);
    float grazing = (1.0 - reflecting.metallic) * grazingOfRoughness(reflecting.roughness);
    // Of many normals each sees less of the hemisphere over their plane than their mean does, and less of a light along the mean.
    float ofAll = 0.5 + 0.5 * together;
    outSurface = uvec4(packRootOfColor(ofAll * albedo), packSeen(shading, together / ofAll, shareToAllSides(reflecting), grazing),
                       packUnorm2x16(octahedralFromDirection(geometric)), packRadiance(surface.emission));
}
