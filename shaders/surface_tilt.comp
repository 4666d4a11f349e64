#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "light_field.glsl"
#include "surface_texels.glsl"
#include "gathered_rays.glsl"

// Bake: from which side the light of a probe's texels comes, after the last bounce: as surface_bounce.comp, by the same rays, each by the slope of its
// direction.
// Dispatch: ceil(surfaceSize/8) twice x 6.

void main()
{
    uvec3 texel;
    uint ofProbe, index;
    if (!findTexel(texel, ofProbe, index)) return;
    SurfacePoint surface = surfacePointAt(push.probe, int(texel.z), int(texel.x), int(texel.y));
    vec3 normal = normalOfTexel(index, surface), sum = vec3(0.0);
    TangentFrame tangents = tangentFrame(normal);
    float grazing = unpackGrazing(push.texels.value[index].normal);
    Ends ends = Ends(0.0, 0.0, 0.0);
    for (uint i = 0u; i < push.rays; ++i)
    {
        uint link = push.links.word[i * texelsOfProbe() + ofProbe];
        if (!countEnd(ends, link)) continue;
        vec3 slope = slopeOf(gatherDirection(tangents, pixelOfTexel(texel), i, grazing), normal);
        sum += luminance(broughtBy(link)) * slope;
    }
    vec4 tilt = push.tilts.value[index];
    tilt.zw = tilt.xy + perRay(ends) * alongPlane(sum, normal);
    push.tilts.value[index] = tilt;
}
