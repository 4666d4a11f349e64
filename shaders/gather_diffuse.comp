#version 460
#extension GL_GOOGLE_include_directive : require
#include "light_field.glsl"
#include "gbuffer_read.glsl"

// Diffuse indirect light: prefiltered irradiance of the pixel's ranked probes, weighted by visibility.
// The leaf is looked up at a point dithered by a voxel, so that no border of a voxel shows. Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 4, rgba32f) writeonly uniform image2D diffuse; // rgb: cosine-weighted mean of the arriving radiance (no albedo)

const uint kLookUps = 4u; // dithered look-ups a pixel

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    Pixel p = readPixel(at);
    vec4 sum = vec4(0.0);
    if (p.surface && p.brdf.metallic < 1.0)
    {
        vec3 point = (p.position - field.origin) / field.scale;
        TangentFrame tangents = tangentFrame(p.normal);
        for (uint i = 0u; i < kLookUps; ++i)
        {
            vec2 along = (randomPair(uvec2(at), i, 1u, frame.seed) - 0.5) * 2.0 * field.voxel;
            int reads = 0;
            vec3 lookUp = point + along.x * tangents.tangent + along.y * tangents.bitangent + 0.5 * field.voxel * p.normal;
            sum += weightedIrradianceAt(point, p.normal, lookUp, reads);
        }
    }
    imageStore(diffuse, at, vec4(lightOf(sum), 1.0));
}
