#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"

// Diffuse light of all sources but the host's own, read from the surface light of the probes that see the pixel. No sample, no filter. Rough
// reflections are scaled by it, so their pixels have it, too.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = kListId) const uint kList = kTermDiffuse;
layout(set = 1, binding = kSurfaceDiffuseBinding, rgba32f) writeonly uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo); a: SurfaceLight::probes

void main()
{
    ivec2 at;
    if (!findPixel(kList, at)) return;
    Pixel p = readPixel(at);
    uint terms = termsOf(p);
    if (!p.surface || (isNotOf(kTermDiffuse, terms) && (kList == kTermDiffuse || isNotOf(kTermRough, terms)))) return;
    vec3 point = (p.position - field.origin) / field.scale;
    int reads = 0;
    // Bad smooth normals can be bent so far that nothing seems to be of the surface.
    vec3 facing = p.normal;
    SurfaceLight found;
    for (int attempt = 0; attempt < 2; ++attempt)
    {
        SurfaceLight light = surfaceLightAt(point, p.normal, facing, point + 0.5 * field.voxel * facing, reads);
        if (attempt == 0 || light.probes >= 0) found = light;
        if (light.probes >= 0) break;
        facing = geometricNormalAt(at, p);
        if (dot(facing, facing) < 0.5 || dot(facing, p.normal) > kSurfaceBend) break;
    }
    imageStore(diffuse, at, vec4(found.light, float(found.probes)));
}
