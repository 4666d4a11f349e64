#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#include "gbuffer_read.glsl"

// Cross-bilateral filter over the G-buffer (McGuire et al. 2017, section 5.1: a narrow one for glossy light, a wide one for diffuse).
// Dispatch: ceil(width/8) x ceil(height/8).
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 1, binding = 4, rgba32f) readonly uniform image2D noisy;
layout(set = 1, binding = 5, rgba32f) writeonly uniform image2D smooth_;
layout(scalar, push_constant) uniform Push
{
    int radius;   // pixels
    int stride;   // pixels between taps
    int followRoughness; // 1: a glossy pixel's radius shrinks with its roughness, to nothing for a mirror
};

void main()
{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, ivec2(frame.size)))) return;
    vec4 own = imageLoad(noisy, at);
    Pixel p = readPixel(at);
    if (!p.surface)
    {
        imageStore(smooth_, at, own);
        return;
    }
    float reach = float(radius);
    if (followRoughness != 0) reach *= clamp(p.brdf.roughness * 4.0, 0.0, 1.0);
    vec3 sum = own.rgb;
    float weights = 1.0;
    float toEye = distance(p.position, frame.eye);
    for (int dy = -radius; dy <= radius; dy += stride)
        for (int dx = -radius; dx <= radius; dx += stride)
        {
            ivec2 tap = at + ivec2(dx, dy);
            float far2 = float(dx * dx + dy * dy);
            if ((dx == 0 && dy == 0) || far2 > reach * reach || any(lessThan(tap, ivec2(0))) || any(greaterThanEqual(tap, ivec2(frame.size)))) continue;
            Pixel q = readPixel(tap);
            if (!q.surface) continue;
            float plane = abs(dot(q.position - p.position, p.normal)) / (0.01 * toEye);
            float facing = max(dot(p.normal, q.normal), 0.0);
            float rough = abs(p.brdf.roughness - q.brdf.roughness) * 8.0;
            float weight = exp(-2.0 * far2 / (reach * reach + 1e-6) - plane * plane - rough * rough) * pow(facing, 32.0);
            sum += weight * imageLoad(noisy, tap).rgb;
            weights += weight;
        }
    imageStore(smooth_, at, vec4(sum / weights, own.a));
}
