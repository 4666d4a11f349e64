#pragma once

#include <algorithm>

#include "runtime/field/field_space.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce::testing_support
{

/// Probes in a box of [-1,1]^3 that a hole-free wall at x = 0 divides: even ones see x < 0, odd ones x > 0, in two rows along y.
/// Closed-form maps, no octree.
inline FieldData dividedBox(uint32_t faceSize, uint32_t probes = 2)
{
    using glm::vec3;
    FieldData field;
    Bounds bounds;
    bounds.add(vec3(-1.0f));
    bounds.add(vec3(1.0f));
    field.info = fieldSpace(bounds);
    field.info.chart = gpu::kChartCube;
    field.info.faceSize = faceSize;
    field.info.topLevel = coarsestLevel(faceSize);
    field.info.wordsPerProbe = distanceWordsPerProbe(gpu::kChartCube, faceSize);
    field.info.probeCount = probes;
    field.probes.resize(probes);
    field.distance.resize(size_t(field.info.wordsPerProbe) * probes);
    twin::LightFieldTwin<float> text(field, {});
    const uint32_t row = (probes + 1) / 2;
    for (uint32_t probe = 0; probe < probes; ++probe)
    {
        const float side = probe % 2 == 0 ? -1.0f : 1.0f;
        const vec3 centre(0.5f * side, row == 1 ? 0.0f : 1.8f * float(probe / 2) / float(row - 1) - 0.9f, 0.0f);
        const vec3 low(side < 0 ? -1.0f : 0.0f, -1.0f, -1.0f), high(side < 0 ? 0.0f : 1.0f, 1.0f, 1.0f);
        field.probes[probe] = {};
        field.probes[probe].centre = (centre - field.info.origin) / field.info.scale;
        for (int face = 0; face < 6; ++face)
        {
            uint32_t* words =
                field.distance.data() + size_t(probe) * field.info.wordsPerProbe + size_t(face) * (field.info.wordsPerProbe / 6);
            for (uint32_t i = 0; i < faceSize * faceSize; ++i)
            {
                const float u = 2.0f * (float(i % faceSize) + 0.5f) / float(faceSize) - 1.0f,
                            v = 2.0f * (float(i / faceSize) + 0.5f) / float(faceSize) - 1.0f;
                const vec3 d = text.faceDirection(face, vec3(u, v, 1.0f));
                float w = 1e9f;
                vec3 wall(0.0f); // the axis whose wall is met, in the face's coordinates
                for (int a = 0; a < 3; ++a)
                {
                    const float to = d[a] != 0.0f ? ((d[a] > 0.0f ? high[a] : low[a]) - centre[a]) / d[a] : w;
                    if (to >= w) continue;
                    w = to;
                    wall = vec3(0.0f);
                    wall[a] = d[a] > 0.0f ? 1.0f : -1.0f;
                }
                wall = text.faceCoordinates(face, wall);
                const float perTexel = 2.0f / (float(faceSize) * glm::dot(wall, vec3(u, v, 1.0f)));
                words[i] = text.packTexel(field.info.scale / w, wall.x * perTexel, wall.y * perTexel);
            }
            buildChain(words, faceSize);
        }
        summariseProbe(field, probe);
    }
    return field;
}

} // namespace sconce::testing_support
