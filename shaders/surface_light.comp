#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#include "tiles.glsl"

// Diffuse light of all sources but the host's own, read from the surface light of the probes that see the pixel. No sample, no filter.
// Dispatch: see findPixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = kSurfaceDiffuseBinding, rgba32f) writeonly uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo); a: SurfaceLight::probes

void main()
{
    ivec2 at;
    if (!findPixel(kTermDiffuse, at)) return;
    Pixel p = readPixel(at);
    if (!p.surface || isNotOf(kTermDiffuse, termsOf(p))) return;
    vec3 point = (p.position - field.origin) / field.scale;
    int reads = 0;
    SurfaceLight found = surfaceLightAt(point, p.normal, point + 0.5 * field.voxel * p.normal, reads);
    imageStore(diffuse, at, vec4(found.light, float(found.probes)));
}
