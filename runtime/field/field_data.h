#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/knobs.h"
#include "scene/light_groups.h"
#include "shaders/shared/lamps.h"
#include "shaders/shared/light_field.h"
#include "shaders/shared/live_light.h"
#include "svo/octree.h"

namespace sconce
{

/// The share that some of a scene's lights have in all light that a field holds. Light is linear: the sum of all groups' shares, each times
/// a weight, is the field in other light (shaders/shared/group_mix.h).
struct LightGroup
{
    LightGroupDesc which;                                                  // in the scene
    glm::vec3 sky{0.0f};                                                   // of info.sky
    std::vector<glm::vec3> lamps;                                          // of FieldData::lamps, their radiance
    std::vector<uint32_t> radiance, irradiance, prefiltered, surfaceLight; // as the field's; what is no light in them is the same in all
};

/// What a field needs so that lights of no extent may move in it: where the light that each texel sends goes. Made by a bake, and nothing
/// of it depends on light (shaders/shared/live_light.h).
struct LiveTransport
{
    uint32_t links = 0;                 // a texel, and a place; 0: the field is static
    std::vector<gpu::LiveTexel> texels; // of surface light, all probes
    std::vector<uint32_t> texelLinks;   // [probe][link][texel of the probe], as gpu::kLinkSky and its like
    std::vector<uint32_t> places;       // words of FieldData::surfaceLight that are no texels
    std::vector<uint32_t> placeLinks;   // [link][place]
    std::vector<glm::vec3> tints;       // gpu::kTints colours of metals that links name
    std::vector<uint32_t> albedo;       // [probe][face][y][x], half the radiance's texels a side, 5:6:5, two to a word
    std::vector<Light> lights;          // that the field's light is of, besides its groups'
    bool lit = true;                    // false: the field has no light yet, and these lights are those of the scene
};

inline constexpr uint64_t kMostLiveLinks = 1ull << 32; // of a field's texels: shaders number them by a word

/// A baked light field in host memory: what a .sconce file holds. Layouts of the words: shaders/shared/light_field.h.
struct FieldData
{
    gpu::LightFieldInfo info{};
    std::vector<gpu::ProbeHeader> probes;
    std::vector<uint32_t> distance;    // [probe][info.wordsPerProbe]
    std::vector<uint32_t> radiance;    // [probe][face][y][x] (cube) or [probe][y][x] (octahedral), R11G11B10F, finest level only;
                                       // empty: nothing in the scene is glossy
    std::vector<uint32_t> irradiance;  // [probe][kIrradianceSize^2][2]: R11G11B10F cosine-weighted mean (irradiance / pi) of what surfaces
                                       // reflect, without emission and sky, then
                                       // half mean distance | half variance of distance << 16, field units, cosine-power lobe
    std::vector<uint32_t> prefiltered; // [probe][kPrefilteredWords]: R11G11B10F radiance, layout: shaders/shared/prefiltered.h
    std::vector<uint32_t> patches; // [probe][face][v][u][2], cube faces only: half q | normal 8+8 << 16, then R11G11B10F radiance without
                                   // emission and sky, of what is seen through a window of kPatchSide^2 a face: see patchIrradiance()
    std::vector<uint32_t> surfaceLight; // [probe][face][y][x], info.surfaceSize texels a side, RGB9E5: shaders/shared/surface_light.h; then
                                        // [cell][kCellWords]: light_cells.h; empty: baked without
    std::vector<gpu::Lamp> lamps;       // at most gpu::kMostLamps; only with surface light
    std::vector<uint32_t> lampMaps;     // theirs, one after another; firstWord counts the lamps' own words, too
    std::vector<LightGroup> groups;     // at most kMostLightGroups; what stands above is their sum. Empty: baked as one
    LiveTransport live;                 // with groups: of all light that doesn't move
    Octree octree;
    uint32_t resolution = 0; // as asked for: the side of an octahedral map; cube faces have half of it
    uint32_t bounces = 0;
    std::string sceneName;
    std::vector<std::string> effects; // names of the effects the scene calls for
    std::vector<std::string> why;     // of each probe, why it stands where it does, in words of who placed it; empty: nobody said
    uint32_t fileVersion = 0;         // of the format of the file it was read from; 0: it was not read from one
};

/// The words of a field that hold light, each with those of a group's share; in the order of the file.
struct LightPart
{
    std::vector<uint32_t> FieldData::*words;
    std::vector<uint32_t> LightGroup::*share;
};
inline constexpr LightPart kLightParts[] = {{&FieldData::radiance, &LightGroup::radiance},
                                            {&FieldData::irradiance, &LightGroup::irradiance},
                                            {&FieldData::prefiltered, &LightGroup::prefiltered},
                                            {&FieldData::surfaceLight, &LightGroup::surfaceLight}};

/// Bytes by part, as `sconce info` prints them; normals are 0 in the cube chart, where a texel's plane gradient is its normal.
struct FieldBytes
{
    size_t distance = 0, normals = 0, radiance = 0, irradiance = 0, index = 0; // irradiance: with the patches and surface light
    size_t prefiltered = 0;                                                    // of the radiance
    size_t lamps = 0;                                                          // with their maps: of the irradiance
    size_t surface = 0, cells = 0, refined = 0, hidden = 0; // surface light with all that follows its texels, and that: of the irradiance
    size_t groups = 0;                                      // shares of light groups
    size_t live = 0;                                        // what lets lights move
    size_t total() const { return distance + normals + radiance + irradiance + index + groups + live; }
};
FieldBytes bytesByPart(const FieldData& field);

/// Those of FieldData::live.
size_t bytesOf(const LiveTransport& live);

/// Words of one probe's distance map and the coarsest level of its chain, from chart and size. Faces must be a multiple of 4 from 8 to
/// 2048.
uint32_t coarsestLevel(uint32_t faceSize);
uint32_t distanceWordsPerProbe(uint32_t chart, uint32_t size);
uint32_t radianceWordsPerProbe(uint32_t chart, uint32_t size);
/// Whether maps are in blocks of 4 x 4 texels: distances as of shaders/shared/distance_block.h, [probe][face]: [y / 4][x / 4][8], the
/// chain's other levels and far bounds; radiance as of radiance_block.h, [probe][face][y / 4][x / 4][4]. Only of cube faces, and of light
/// that doesn't change.
bool inBlocks(const gpu::LightFieldInfo& info);
uint32_t blockedDistanceWords(uint32_t faceSize);        // of a probe in blocks
size_t radianceWordsOf(const gpu::LightFieldInfo& info); // of a probe, in blocks or not
inline constexpr uint32_t kIrradianceWordsPerProbe = 2 * gpu::kIrradianceSize * gpu::kIrradianceSize;

/// Texels a side of a chart's map where an octahedral one has `resolution`: cube faces have half of it.
uint32_t chartSize(uint32_t chart, uint32_t resolution);

/// Bytes that every further probe adds to a light field at most, index apart: what a budget of memory is divided by.
/// @param surfaceTexels  BakeSettings::surfaceTexels
/// @param directions     whether the scene has normal textures
/// @param compact        whether its maps are in blocks, which octahedral ones can't be
size_t bytesPerProbe(uint32_t chart, uint32_t resolution, uint32_t surfaceTexels = knobs::surfaceTexels.value, bool directions = false,
                     float refined = knobs::surfaceRefined.value, bool compact = false);

/// Texels a side of a face of the surface light that a bake makes, where so many are asked for; 0 with octahedral maps.
uint32_t surfaceSizeOf(uint32_t chart, uint32_t faceSize, uint32_t surfaceTexels);

/// Cells of light in the open along each axis: shaders/shared/light_cells.h.
glm::ivec3 lightCells(const gpu::LightFieldInfo& info);
inline constexpr size_t kCellsOfProbe = 512; // cells of light in the open, at most; 14 KiB
/// LightFieldInfo::cellShift of a new field: the finest cells, of two voxels or more, that there are at most 512 of for a probe.
int cellShiftOf(const gpu::LightFieldInfo& info);
/// Words of FieldData::surfaceLight that the texels of all probes take: their light, then their tilts where the field has directions.
size_t surfaceTexelWords(const gpu::LightFieldInfo& info);
/// Those of the light of hidden surfaces, after the cells and the refined texels (shaders/shared/hidden_light.h).
size_t hiddenWords(const gpu::LightFieldInfo& info);
/// Words of the map of a lamp that is so many texels a side, all levels.
size_t lampMapWords(uint32_t size);
/// Those that the cells take after them; 0 without surface light.
size_t cellWords(const gpu::LightFieldInfo& info);

} // namespace sconce
