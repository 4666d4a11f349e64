#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"

// Bake: an octahedral irradiance or moments map, gathered from coarse cells. Irradiance: cosine-weighted mean radiance, irradiance / pi.
// MOMENTS: mean and variance of the distance under the lobe cos^50 (McGuire et al. 2017, section 5.2). Writes every second word.
// `push.level` is the cells a side. Dispatch: ceil(kIrradianceSize/8) twice.
layout(local_size_x = 8, local_size_y = 8) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Cells { vec4 value[]; };

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= kIrradianceSize || at.y >= kIrradianceSize) return;
    vec3 direction = directionFromOctahedral((vec2(at) + 0.5) / float(kIrradianceSize));
    Cells cells = Cells(uvec2(push.extra));
    BakeWords irradiance = push.words; // this pass reads no distances
    uint width = push.level;
    int faces = push.chart == kChartCube ? 6 : 1;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int face = 0; face < faces; ++face)
        for (uint y = 0u; y < width; ++y)
            for (uint x = 0u; x < width; ++x)
            {
                vec2 uv = texelOnFace(uvec2(x, y), width);
                vec3 d = push.chart == kChartCube ? normalize(faceDirection(face, vec3(uv, 1.0))) : directionFromOctahedral(0.5 * uv + 0.5);
                float weight = max(dot(d, direction), 0.0);
#ifdef MOMENTS
                if (weight < 0.8) continue; // 0.8^50 = 1.4e-5
                weight *= weight;                                                        // cos^2
                float w4 = weight * weight, w8 = w4 * w4, w16 = w8 * w8, w32 = w16 * w16; // cos^4 ... cos^32
                weight = w32 * w16 * weight;                                             // cos^50
#endif
                vec4 cell = cells.value[(uint(face) * width + y) * width + x];
                weight *= cell.w;
                sum += weight * cell.xyz;
                weights += weight;
            }
    sum /= max(weights, 1e-20);
    uint index = 2u * (at.y * kIrradianceSize + at.x);
#ifdef MOMENTS
    irradiance.word[index + 1u] = realToHalf(sum.x) | (realToHalf(max(sum.y - sum.x * sum.x, 0.0)) << 16);
#else
    irradiance.word[index] = packRadianceDithered(sum, ditherOf(at.y * kIrradianceSize + at.x)); // as in bake_bounce.comp
#endif
}
