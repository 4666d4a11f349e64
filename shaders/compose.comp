#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"

// The frame's picture: direct + diffuse indirect + glossy indirect. Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D direct;
layout(set = 1, binding = 5, rgba32f) readonly uniform image2D glossy;
layout(set = 1, binding = 6, rgba32f) uniform image2D diffuse; // in: cosine-weighted mean radiance; out: radiance reflected to the eye
layout(set = 1, binding = 7, rgba32f) writeonly uniform image2D beauty;
layout(scalar, push_constant) uniform Push { uint effects; }; // bit 0 diffuse, bit 1 glossy

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    vec3 light = imageLoad(direct, at).rgb;
    Pixel p = readPixel(at);
    if (p.surface)
    {
        if ((effects & 1u) != 0u)
        {
            // what the specular lobe takes first: Fresnel at the mean half angle of light spread over the hemisphere
            vec3 kept = vec3(1.0) - fresnelSchlick(reflectanceAtNormal(p.brdf), 0.5 * dot(p.normal, p.view) + 0.45);
            vec3 reflected = imageLoad(diffuse, at).rgb * p.brdf.baseColor * (1.0 - p.brdf.metallic) * kept;
            imageStore(diffuse, at, vec4(reflected, 1.0));
            light += reflected;
        }
        if ((effects & 2u) != 0u) light += imageLoad(glossy, at).rgb;
    }
    imageStore(beauty, at, vec4(light, 1.0));
}
