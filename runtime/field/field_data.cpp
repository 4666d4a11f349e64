#include "runtime/field/field_data.h"

#include <algorithm>
#include <cassert>

#include "shaders/shared/pure.h"

namespace sconce
{

FieldBytes bytesByPart(const FieldData& field)
{
    FieldBytes bytes;
    const size_t distanceBytes = field.distance.size() * sizeof(uint32_t);
    if (field.info.chart == gpu::kChartOctahedral)
    {
        // The upper 16 bits of every full-resolution word are the normal; the low-resolution words are all distance.
        bytes.normals = size_t(field.info.probeCount) * field.info.faceSize * field.info.faceSize * sizeof(uint16_t);
    }
    bytes.distance = distanceBytes - bytes.normals;
    bytes.prefiltered = field.prefiltered.size() * sizeof(uint32_t);
    bytes.radiance = field.radiance.size() * sizeof(uint32_t) + bytes.prefiltered;
    bytes.surface = field.surfaceLight.size() * sizeof(uint32_t);
    bytes.refined = field.surfaceLight.empty() ? 0 : size_t(gpu::kFineWords) * field.info.refinedTexels * sizeof(uint32_t);
    bytes.hidden = field.surfaceLight.empty() ? 0 : hiddenWords(field.info) * sizeof(uint32_t);
    bytes.cells = field.surfaceLight.empty() ? 0 : cellWords(field.info) * sizeof(uint32_t);
    bytes.lamps = field.lamps.size() * sizeof(gpu::Lamp) + field.lampMaps.size() * sizeof(uint32_t);
    bytes.irradiance = (field.irradiance.size() + field.patches.size()) * sizeof(uint32_t) + bytes.surface + bytes.lamps;
    for (const LightGroup& group : field.groups)
        for (const LightPart& part : kLightParts) bytes.groups += (group.*part.share).size() * sizeof(uint32_t);
    bytes.live = bytesOf(field.live);
    bytes.index = field.octree.bytes() + field.probes.size() * sizeof(gpu::ProbeHeader);
    return bytes;
}

size_t bytesOf(const LiveTransport& live)
{
    return live.texels.size() * sizeof(gpu::LiveTexel) +
           (live.texelLinks.size() + live.places.size() + live.placeLinks.size() + live.albedo.size()) * sizeof(uint32_t) +
           live.tints.size() * sizeof(glm::vec3);
}

uint32_t coarsestLevel(uint32_t faceSize)
{
    assert(faceSize > 0);
    return uint32_t(Pure<float>::chainTop(faceSize));
}

uint32_t distanceWordsPerProbe(uint32_t chart, uint32_t size)
{
    if (chart == gpu::kChartOctahedral) return size * size + (size / gpu::kLowFactor) * (size / gpu::kLowFactor);
    return 6 * Pure<float>::chainWords(size, coarsestLevel(size));
}

uint32_t radianceWordsPerProbe(uint32_t chart, uint32_t size)
{
    return (chart == gpu::kChartOctahedral ? 1u : 6u) * size * size;
}

uint32_t blockedDistanceWords(uint32_t faceSize)
{
    return distanceWordsPerProbe(gpu::kChartCube, faceSize) - 6 * Pure<float>::wordsOfBlocksSaved(faceSize);
}

bool inBlocks(const gpu::LightFieldInfo& info)
{
    return info.chart == gpu::kChartCube && info.faceSize >= Pure<float>::kBlockSide &&
           info.wordsPerProbe == blockedDistanceWords(info.faceSize);
}

size_t radianceWordsOf(const gpu::LightFieldInfo& info)
{
    return radianceWordsPerProbe(info.chart, info.faceSize) / (inBlocks(info) ? 4 : 1);
}

uint32_t chartSize(uint32_t chart, uint32_t resolution)
{
    return chart == gpu::kChartCube ? resolution / 2 : resolution;
}

uint32_t surfaceSizeOf(uint32_t chart, uint32_t faceSize, uint32_t surfaceTexels)
{
    return chart == gpu::kChartCube ? std::min(surfaceTexels, faceSize) : 0;
}

size_t bytesPerProbe(uint32_t chart, uint32_t resolution, uint32_t surfaceTexels, bool directions, float refined, bool compact)
{
    const uint32_t size = chartSize(chart, resolution), surface = surfaceSizeOf(chart, size, surfaceTexels);
    const size_t maps = compact ? blockedDistanceWords(size) + radianceWordsPerProbe(chart, size) / 4
                                : distanceWordsPerProbe(chart, size) + radianceWordsPerProbe(chart, size);
    const size_t words = maps + kIrradianceWordsPerProbe + gpu::kPrefilteredWords;
    const size_t patches = chart == gpu::kChartCube && surface == 0 ? size_t(2) * gpu::kPatches : 0;
    const size_t cells = surface > 0 ? gpu::kCellWords * kCellsOfProbe : 0;
    const size_t texels = size_t(6) * surface * surface, tilts = directions ? texels / 2 : 0;
    const size_t finer = gpu::kFineWords * size_t(std::ceil(refined * double(texels)));
    return (words + patches + texels + tilts + cells + finer) * sizeof(uint32_t) + sizeof(gpu::ProbeHeader);
}

glm::ivec3 lightCells(const gpu::LightFieldInfo& info)
{
    const int more = (1 << info.cellShift) - 1;
    return ((glm::ivec3(info.topCells) << info.topShift) + more) >> info.cellShift;
}

int cellShiftOf(const gpu::LightFieldInfo& info)
{
    gpu::LightFieldInfo finer = info;
    finer.surfaceSize = 1;
    for (finer.cellShift = 1; finer.cellShift < 15 && cellWords(finer) > gpu::kCellWords * kCellsOfProbe * info.probeCount;)
        ++finer.cellShift;
    return finer.cellShift;
}

size_t surfaceTexelWords(const gpu::LightFieldInfo& info)
{
    const size_t texels = size_t(6) * info.surfaceSize * info.surfaceSize * info.probeCount;
    return texels + (info.surfaceDirections != 0 ? (texels + 1) / 2 : 0);
}

size_t lampMapWords(uint32_t size)
{
    const size_t blocks = size / gpu::kLampBlock, larger = blocks / gpu::kLampBlock;
    return size_t(size) * size / 2 + blocks * blocks + larger * larger;
}

size_t hiddenWords(const gpu::LightFieldInfo& info)
{
    return size_t(2) * (info.hidden >> gpu::kHiddenShiftBits);
}

size_t cellWords(const gpu::LightFieldInfo& info)
{
    const glm::ivec3 count = lightCells(info);
    return info.surfaceSize > 0 ? gpu::kCellWords * size_t(count.x) * size_t(count.y) * size_t(count.z) : 0;
}

} // namespace sconce
