#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame_passes.h"
layout(constant_id = kSurfaceProbesId) const int kBlended = 2; // probes
#define SCONCE_SURFACE_PROBES kBlended
#define SCONCE_ASKS_FOR_MAPS
#include "light_field.glsl"
#include "gbuffer_read.glsl"
#define SCONCE_LEAVES_LOOK_UPS
#include "tiles.glsl"
#include "packed_pixel.glsl"
#define SCONCE_READS_PIXEL readPacked
#include "lookups.glsl"

// Diffuse light of all sources but the host's own, read from the surface light of the probes that see the pixel. No sample, no filter. Rough
// reflections are scaled by it, so their pixels have it, too. What no probe shows, and pixels as large as texels, are left to a second dispatch: where
// lanes are vectors, few that search would have all wait.
// Dispatch: see lookups.glsl.
layout(local_size_x = 64) in;
layout(set = 1, binding = kSurfaceDiffuseBinding, rgba16f) writeonly uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo); a: SurfaceLight::probes

const float kMostOfTexel = 0.5; // of its width, that four pixels of one look-up span
const float kMostOfSoft = 1.0;  // the same where the sharpest shadows are those of lamps, which are not in it

/// Of what no texel shows by its shading normal: bad smooth normals can be bent so far that nothing seems to be of the surface.
SurfaceLight lightOfRest(LookUp l, Pixel p, vec3 point)
{
    int reads = 0;
    vec3 facing = p.normal;
    SurfaceLight found;
    for (int attempt = 0; attempt < 2; ++attempt)
    {
        SurfaceLight light = surfaceLightOf(point, p.normal, facing, point + 0.5 * field.voxel * facing, reads);
        if (attempt == 0 || light.probes >= 0) found = light;
        if (light.probes >= 0) break;
        facing = geometricNormalAt(l.at, readPixel(l.at));
        if (dot(facing, facing) < 0.5 || dot(facing, p.normal) > kSurfaceBend) break;
    }
    return found;
}

void main()
{
    LookUp lookUp;
    if (!findLookUp(lookUp)) return;
    Pixel p = readLookUp(lookUp);
    if (!p.surface) return;
    vec3 point = (p.position - field.origin) / field.scale;
    int reads = 0;
    SurfaceLight found;
    if (kIsRest) found = lightOfRest(lookUp, p, point);
    else
    {
        SurfaceSeen seen = surfaceLightSeen(point, p.normal, point + 0.5 * field.voxel * p.normal, reads);
        found = seen.light;
        // Where texels are as fine as pixels, light changes from one to the next; where none shows the middle, one may show a pixel.
        bool alone = lookUp.across > (lampCount > 0u ? kMostOfSoft : kMostOfTexel) * field.scale * (found.probes > 0 ? seen.width : field.voxel);
        if (found.probes == 0 || alone)
        {
            leave(lookUp, alone);
            return;
        }
    }
    for (int i = 0; i < lookUp.pixels; ++i)
    {
        ivec2 at = pixelOf(lookUp, i);
        vec3 normal = field.surfaceDirections != 0u && lookUp.pixels > 1 ? readPacked(at).normal : p.normal;
        imageStore(diffuse, at, storedLight(vec4(lightOn(normal, found), float(found.probes))));
    }
}
