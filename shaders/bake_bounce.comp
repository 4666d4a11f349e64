#version 460
#extension GL_GOOGLE_include_directive : require
#define SCONCE_FIELD_SET 0
#include "light_field.glsl"

// Bake: one more bounce. Every texel's radiance is its direct one plus what it reflects of the light field's own irradiance (Jacobi
// iteration of the light transport over the probes' texels). That irradiance leaves out emission and sky: they are in the direct one. Dispatch: ceil(N/8) twice x 6 (cube) or 1 (octahedral).
layout(local_size_x = 8, local_size_y = 8) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ProbeWords { uint word[]; };
layout(scalar, push_constant) uniform Push
{
    ProbeWords words;
    ProbeWords radiance; // out
    ProbeWords surface;
    ProbeWords direct;
    vec3 centre;
    float nearPlane;
    uint size;
    uint faceWords;
    uint chart;
    uint level;
    vec3 sky;
    float skyDistance;
    ProbeWords emitted;
};

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= size || at.y >= size) return;
    uint index = (at.z * size + at.y) * size + at.x;
    uint material = surface.word[index];
    uint word = words.word[(chart == kChartCube ? at.z * faceWords : 0u) + at.y * size + at.x];
    uint far = chart == kChartCube ? 0u : 0x7c00u;
    uint own = direct.word[index];
    if ((word & 0xffffu) == far)
    {
        radiance.word[index] = own;
        return;
    }
    vec2 uv = (vec2(at.xy) + 0.5) / float(size);
    vec3 relative = chart == kChartCube ? faceDirection(int(at.z), vec3(2.0 * uv - 1.0, 1.0)) / halfToReal(word)
                                        : directionFromOctahedral(uv) * halfToReal(word);
    vec3 albedo = vec3(float(material & 31u) / 31.0, float((material >> 5) & 63u) / 63.0, float((material >> 11) & 31u) / 31.0);
    vec3 normal = unpackNormal8(material >> 16);
    vec3 p = centre + relative;
    int reads = 0;
    // The leaf is asked half a voxel off the surface, on the side that the probe sees.
    vec3 gathered = irradianceAt(p, normal, p + 0.5 * field.voxel * normal, reads);
    // Rounded to nearest, the last bounces would all be rounded away, in every texel alike.
    radiance.word[index] = packRadianceDithered(unpackRadiance(own) + albedo * gathered, ditherOf(index));
}
