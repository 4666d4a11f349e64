#include "runtime/field/field_space.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/field/face_chain_text.h"
#include "runtime/field/tracer_cpu.h"

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

void buildChain(uint32_t* faceWords, uint32_t faceSize)
{
    chain_text::Text text{faceWords};
    const int top = text.chainTop(faceSize);
    for (int level = 2; level <= top; level += 2)
    {
        const uint32_t width = text.chainWidth(faceSize, level);
        uint32_t* words = faceWords + text.chainOffset(faceSize, level);
        for (uint32_t i = 0; i < width * width; ++i) words[i] = text.boundingPlane(0, faceSize, level, i % width, i / width);
    }
    const uint32_t near = text.chainNearWords(faceSize, top);
    for (uint32_t k = near; k < text.chainWords(faceSize, top); ++k) faceWords[k] = text.farBoundPair(0, faceSize, top, k - near);
}

void summariseProbe(FieldData& field, size_t probe)
{
    twin::LightFieldTwin<float> text(field, {});
    gpu::ProbeHeader& header = field.probes[probe];
    const uint32_t size = field.info.faceSize;
    float nearest = 4.0f * field.info.diagonal, farthest = 0.0f;
    double inverse = 0.0, solid = 0.0; // over all directions, weighted by the texels' solid angles
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
                const double weight = std::pow(1.0 + double(glm::dot(uv, uv)), -1.5);
                solid += weight;
                if (q > 0.0f) inverse += weight / distance;
            }
        std::nth_element(distances.begin(), distances.begin() + ptrdiff_t(distances.size() / 2), distances.end());
        const float median = std::min(distances[distances.size() / 2], field.info.diagonal);
        ((face & 1) ? header.influenceLow : header.influenceHigh)[face >> 1] = median;
    }
    header.freeRadius = nearest;
    header.farthest = farthest;
    header.harmonic = float(solid / std::max(inverse, 1e-6 * solid)); // a million field units where there is nothing but sky
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
