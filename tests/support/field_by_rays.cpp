#include "tests/support/field_by_rays.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "runtime/field_space.h"
#include "runtime/quality.h"
#include "runtime/tracer_cpu.h"
#include "svo/parallel.h"

namespace sconce::testing_support
{

gpu::TraceQuality defaultQuality()
{
    return Quality{}.trace;
}

FieldData fieldByRays(const RayScene& rays, std::span<const glm::vec3> positions, uint32_t faceSize, const OctreeSettings& settings)
{
    FieldData field;
    field.info = fieldSpace(rays.scene().bounds());
    field.info.chart = gpu::kChartCube;
    field.info.faceSize = faceSize;
    field.info.topLevel = coarsestLevel(faceSize);
    field.info.wordsPerProbe = distanceWordsPerProbe(gpu::kChartCube, faceSize);
    field.info.probeCount = uint32_t(positions.size());
    field.resolution = 2 * faceSize;
    field.probes.resize(positions.size());
    field.distance.assign(size_t(field.info.wordsPerProbe) * positions.size(), 0);
    field.radiance.assign(size_t(radianceWordsPerProbe(gpu::kChartCube, faceSize)) * positions.size(), 0);
    parallelFor(6 * positions.size(),
                [&](size_t i)
                {
                    twin::LightFieldTwin<float> text(field, {});
                    const size_t probe = i / 6;
                    const int face = int(i % 6), size = int(faceSize);
                    uint32_t* words =
                        field.distance.data() + probe * field.info.wordsPerProbe + size_t(face) * (field.info.wordsPerProbe / 6);
                    for (int y = 0; y < size; ++y)
                        for (int x = 0; x < size; ++x)
                        {
                            const glm::vec3 texel(2.0f * (float(x) + 0.5f) / float(size) - 1.0f,
                                                  2.0f * (float(y) + 0.5f) / float(size) - 1.0f, 1.0f);
                            const auto hit = rays.closest(positions[probe], text.faceDirection(face, texel)); // not unit: t is W
                            if (!hit) continue;
                            const glm::vec3 n = text.faceCoordinates(face, hit->geometricNormal);
                            const float facing = glm::dot(n, texel);
                            const float perTexel = facing != 0.0f ? 2.0f / (float(size) * facing) : 0.0f;
                            words[y * size + x] = text.packTexel(field.info.scale / hit->t, n.x * perTexel, n.y * perTexel);
                        }
                    buildChain(words, faceSize, field.info.topLevel);
                });
    for (size_t probe = 0; probe < positions.size(); ++probe)
    {
        field.probes[probe] = {};
        field.probes[probe].centre = (positions[probe] - field.info.origin) / field.info.scale;
        summariseProbe(field, probe);
    }
    auto tree = buildOctree({field.info, field.probes, field.distance}, settings);
    if (!tree) throw std::runtime_error(tree.error().message);
    attachOctree(field, *tree);
    return field;
}

} // namespace sconce::testing_support
