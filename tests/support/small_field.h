#pragma once

#include <cstdint>
#include <random>

#include "runtime/field/light_field_file.h"

namespace sconce::testing_support
{

/// No scene's, but whole and of a few kilobytes: with a part of every kind but light groups.
inline FieldData smallField(uint32_t chart = gpu::kChartCube, uint32_t size = 8, uint32_t probes = 3)
{
    FieldData field;
    std::mt19937 random(7);
    field.info.scale = 4.0f;
    field.info.boundsHigh = {1.0f, 2.0f, 3.0f};
    field.info.probeCount = probes;
    field.info.chart = chart;
    field.info.faceSize = size;
    field.info.topLevel = chart == gpu::kChartCube ? coarsestLevel(size) : 0;
    field.info.wordsPerProbe = distanceWordsPerProbe(chart, size);
    field.info.marker = 255;
    field.probes.resize(probes);
    for (gpu::ProbeHeader& probe : field.probes) probe.centre = {float(random() % 100), 0.5f, -1.0f};
    field.distance.resize(size_t(probes) * field.info.wordsPerProbe);
    field.radiance.resize(size_t(probes) * radianceWordsPerProbe(chart, size));
    field.irradiance.resize(size_t(probes) * gpu::kIrradianceSize * gpu::kIrradianceSize * 2);
    field.prefiltered.resize(size_t(probes) * gpu::kPrefilteredWords);
    field.patches.resize(size_t(probes) * 2 * gpu::kPatches);
    field.octree.boundsHigh = {1.0f, 2.0f, 3.0f};
    field.info.voxel = field.octree.voxel = 0.125f;
    field.info.topCells = field.octree.topCells = {2, 2, 2};
    field.info.topShift = field.octree.topShift = 3;
    if (chart == gpu::kChartCube)
    {
        field.info.surfaceSize = 4;
        field.info.cellShift = 3;
        field.info.surfaceDirections = 1;
        field.info.refinedTexels = 2;
        field.info.hidden = 5u << gpu::kHiddenShiftBits | 1u;
        field.surfaceLight.resize(size_t(probes) * 6 * 4 * 4 * 3 / 2 + cellWords(field.info) + size_t(2) * gpu::kFineWords +
                                  hiddenWords(field.info));
        gpu::Lamp lamp{};
        lamp.radiance = glm::vec3(3.0f);
        lamp.far = 2.0f;
        lamp.size = 64;
        lamp.firstWord = sizeof(gpu::Lamp) / 4;
        field.lamps.push_back(lamp);
        field.lampMaps.resize(lampMapWords(64));
    }
    for (auto* words :
         {&field.distance, &field.radiance, &field.irradiance, &field.prefiltered, &field.patches, &field.surfaceLight, &field.lampMaps})
        for (size_t i = 0; i < words->size(); ++i) (*words)[i] = uint32_t(i / 16); // compressible, so that files are small
    field.info.bricks = field.octree.bricks = {2, 1, 1};
    field.octree.leaves = 15;
    field.octree.nodes = 1;
    field.octree.texels.assign(2 * 8 * 4, uint16_t(probes - 1));
    field.octree.texels[0] = 1, field.octree.texels[1] = 0, field.octree.texels[2] = 0, field.octree.texels[3] = 255;
    field.resolution = 2 * size;
    field.bounces = 2;
    field.sceneName = "ca\"fé";
    field.effects = {"sun", "glossy"};
    return field;
}

/// With two light groups, whose shares are not all alike.
inline FieldData groupedField()
{
    FieldData field = smallField();
    for (const char* name : {"sun", "lamps"})
    {
        LightGroup group{
            {name, {}},        glm::vec3(0.1f, 0.2f, 1.0f / 3.0f), {glm::vec3(1.5f)}, field.radiance, field.irradiance, field.prefiltered,
            field.surfaceLight};
        group.which.members.assign(field.groups.size() + 1, "desk*");
        group.radiance[3] = 7 + uint32_t(field.groups.size());
        field.groups.push_back(std::move(group));
    }
    return field;
}

} // namespace sconce::testing_support
