#include "runtime/field_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/tracer_cpu.h"

namespace sconce
{

gpu::LightFieldInfo fieldSpace(const Bounds& bounds)
{
    gpu::LightFieldInfo info{};
    const float diagonal = std::max(bounds.diagonal(), 1e-30f);
    info.scale = std::exp2(std::round(std::log2(diagonal)));
    const float grain = info.scale / 4096.0f;
    info.origin = glm::round(bounds.centre() / grain) * grain;
    info.sceneLow = (bounds.low - info.origin) / info.scale;
    info.sceneHigh = (bounds.high - info.origin) / info.scale;
    info.diagonal = diagonal / info.scale;
    return info;
}

void buildChain(uint32_t* faceWords, uint32_t faceSize, uint32_t topLevel)
{
    const FieldData none;
    twin::LightFieldTwin<float> text(none, {});
    uint32_t* finer = faceWords;
    for (uint32_t level = 2; level <= topLevel; level += 2)
    {
        const uint32_t below = faceSize >> (level - 2), width = faceSize >> level;
        uint32_t* words = finer + size_t(below) * below;
        for (uint32_t y = 0; y < width; ++y)
            for (uint32_t x = 0; x < width; ++x)
            {
                uint32_t joined = 0xffffu << 16; // maximum 0, minimum above any half
                for (uint32_t child = 0; child < 16; ++child)
                {
                    const uint32_t word = finer[size_t(4 * y + child / 4) * below + 4 * x + child % 4];
                    joined = text.joinBounds(joined, level == 2 ? text.texelBounds(word) : word);
                }
                words[size_t(y) * width + x] = joined;
            }
        finer = words;
    }
}

void summariseProbe(FieldData& field, size_t probe)
{
    twin::LightFieldTwin<float> text(field, {});
    gpu::ProbeHeader& header = field.probes[probe];
    const uint32_t size = field.info.faceSize;
    float nearest = 4.0f * field.info.diagonal, farthest = 0.0f;
    std::vector<float> distances(size_t(size) * size);
    for (int face = 0; face < 6; ++face)
    {
        const uint32_t* words = field.distance.data() + probe * field.info.wordsPerProbe + size_t(face) * (field.info.wordsPerProbe / 6);
        for (uint32_t y = 0; y < size; ++y)
            for (uint32_t x = 0; x < size; ++x)
            {
                const float q = text.halfToReal(words[y * size + x]);
                const glm::vec2 uv(2.0f * (float(x) + 0.5f) / float(size) - 1.0f, 2.0f * (float(y) + 0.5f) / float(size) - 1.0f);
                const float distance = q > 0.0f ? std::sqrt(1.0f + glm::dot(uv, uv)) / q : 2.0f * field.info.diagonal;
                distances[y * size + x] = distance;
                nearest = std::min(nearest, distance);
                if (q > 0.0f) farthest = std::max(farthest, distance);
            }
        std::nth_element(distances.begin(), distances.begin() + ptrdiff_t(distances.size() / 2), distances.end());
        const float median = std::min(distances[distances.size() / 2], field.info.diagonal);
        ((face & 1) ? header.influenceLow : header.influenceHigh)[face >> 1] = median;
    }
    header.freeRadius = nearest;
    header.farthest = farthest;
}

void attachOctree(FieldData& field, const Octree& octree)
{
    field.octree = octree;
    field.info.boundsLow = octree.boundsLow;
    field.info.boundsHigh = octree.boundsHigh;
    field.info.voxel = octree.voxel;
    field.info.topCells = octree.topCells;
    field.info.topShift = octree.topShift;
    field.info.bricks = octree.bricks;
    field.info.marker = octree.marker;
}

} // namespace sconce
