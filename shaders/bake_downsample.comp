#version 460
#extension GL_GOOGLE_include_directive : require
#include "bake_probe.glsl"

// Bake: a probe's map averaged over coarse cells, by solid angle: what the gathers of irradiance and of distance moments sum over.
// MOMENTS writes (mean r, mean r^2, 0, solid angle), else (mean radiance, solid angle). `push.level` is the cells a side.
// Dispatch: ceil(cells/8) twice x 6 (cube) or 1 (octahedral).
layout(local_size_x = 8, local_size_y = 8) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Cells { vec4 value[]; };

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    uint cells = push.level;
    if (at.x >= cells || at.y >= cells) return;
    uint span = push.size / cells;
    vec3 sum = vec3(0.0);
    float solidAngle = 0.0;
    for (uint y = at.y * span; y < (at.y + 1u) * span; ++y)
        for (uint x = at.x * span; x < (at.x + 1u) * span; ++x)
        {
            vec2 uv = texelOnFace(uvec2(x, y), push.size);
            float weight, stretch = 1.0; // of the texel: its solid angle, and r * q
            if (push.chart == kChartCube)
            {
                stretch = sqrt(1.0 + dot(uv, uv));
                weight = 4.0 / float(push.size * push.size) / (stretch * stretch * stretch);
            }
            else
            {
                // On the octahedron |x| + |y| + |z| = 1 an area dx dy seen along z subtends dx dy / |p|^3.
                vec2 folded = abs(uv.x) + abs(uv.y) > 1.0 ? 1.0 - abs(uv.yx) : abs(uv);
                float z = 1.0 - folded.x - folded.y;
                float l = sqrt(dot(folded, folded) + z * z);
                weight = 4.0 / float(push.size * push.size) / (l * l * l);
            }
#ifdef MOMENTS
            uint word = push.words.word[(push.chart == kChartCube ? at.z * push.faceWords : 0u) + y * push.size + x] & 0xffffu;
            float r = push.skyDistance;
            if (push.chart == kChartCube && word != 0u) r = min(stretch / halfToReal(word), push.skyDistance);
            if (push.chart == kChartOctahedral && word != 0x7c00u) r = min(halfToReal(word), push.skyDistance);
            sum += weight * vec3(r, r * r, 0.0);
#else
            uint index = ((push.chart == kChartCube ? at.z * push.size : 0u) + y) * push.size + x;
            vec3 seen = unpackRadiance(push.radiance.word[index]);
            // Only what surfaces reflect: emission and sky light surfaces through the list of lights.
            if (push.surface.word[index] == 0u) seen = vec3(0.0);
            else if (!isNull(push.emitted)) seen = max(seen - unpackRadiance(push.emitted.word[index]), vec3(0.0));
            sum += weight * seen;
#endif
            solidAngle += weight;
        }
    Cells(uvec2(push.extra)).value[(at.z * cells + at.y) * cells + at.x] = vec4(sum / solidAngle, solidAngle);
}
