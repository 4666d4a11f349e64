#include "tests/support/field_by_rays.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"
#include "runtime/field/field_space.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"

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
                    buildChain(words, faceSize);
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

FieldData gridByRays(const RayScene& rays, glm::ivec3 count, glm::vec3 origin, glm::vec3 step, uint32_t size)
{
    FieldData field;
    field.info = fieldSpace(rays.scene().bounds());
    field.info.chart = gpu::kChartOctahedral;
    field.info.faceSize = size;
    field.info.wordsPerProbe = distanceWordsPerProbe(gpu::kChartOctahedral, size);
    field.info.gridX = uint32_t(count.x);
    field.info.gridY = uint32_t(count.y);
    field.info.gridZ = uint32_t(count.z);
    field.info.gridOrigin = (origin - field.info.origin) / field.info.scale;
    field.info.gridStep = step / field.info.scale;
    field.resolution = size;
    const size_t probes = size_t(count.x) * count.y * count.z;
    field.info.probeCount = uint32_t(probes);
    field.probes.resize(probes);
    field.distance.assign(probes * field.info.wordsPerProbe, 0);
    field.radiance.assign(probes * radianceWordsPerProbe(gpu::kChartOctahedral, size), 0);
    parallelFor(probes,
                [&](size_t probe)
                {
                    twin::LightFieldTwin<float> text(field, {});
                    const glm::ivec3 at(int(probe % count.x), int(probe / count.x % count.y), int(probe / count.x / count.y));
                    const glm::vec3 centre = origin + step * glm::vec3(at);
                    field.probes[probe] = {};
                    field.probes[probe].centre = (centre - field.info.origin) / field.info.scale;
                    uint32_t* words = field.distance.data() + probe * field.info.wordsPerProbe;
                    const uint32_t low = size / gpu::kLowFactor;
                    std::fill(words + size_t(size) * size, words + field.info.wordsPerProbe, 0x7c00u);
                    for (uint32_t y = 0; y < size; ++y)
                        for (uint32_t x = 0; x < size; ++x)
                        {
                            const glm::vec3 d =
                                text.directionFromOctahedral(glm::vec2((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size)));
                            uint32_t& word = words[y * size + x];
                            uint32_t& bounds = words[size_t(size) * size + (y / gpu::kLowFactor) * low + x / gpu::kLowFactor];
                            word = 0x7c00u; // sky
                            if (const auto hit = rays.closest(centre, d))
                            {
                                const glm::vec3 n = glm::dot(hit->geometricNormal, d) > 0.0f ? -hit->geometricNormal : hit->geometricNormal;
                                word = text.realToHalf(hit->t / field.info.scale) | (text.packNormal8(n) << 16);
                            }
                            const uint32_t r = word & 0xffffu;
                            bounds = std::min(bounds & 0xffffu, r) | (std::max(bounds >> 16, r) << 16);
                        }
                });
    return field;
}

} // namespace sconce::testing_support
