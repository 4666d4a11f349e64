#include "runtime/field/light_field_file.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <span>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <zstd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/limits.h"
#include "base/numbers.h"
#include "base/safe_file.h"
#include "runtime/field/live_light.h"

namespace sconce
{

namespace
{

static_assert(std::endian::native == std::endian::little, "the file is little-endian and is copied as it is");

using Bytes = std::vector<std::byte>;

constexpr char kMagic[8] = {'\x89', 'S', 'C', 'O', 'N', 'C', 'E', '\n'}; // not text, and a transfer that rewrites line ends damages it
constexpr char kEnd[8] = {'S', 'C', 'O', 'N', 'C', 'E', '.', '\n'};
constexpr uint64_t kChunkBytes = 16u << 20;    // a section is cut into blocks of at most this many bytes
constexpr uint64_t kMapBytes = 256u << 10;     // and, of maps, of about so many, but whole probes
constexpr uint64_t kZstdMaxRatio = 128u << 10; // a zstd block of 4 bytes stands for at most 128 KiB; more is no real file
constexpr int kZstdLevel = 3;
constexpr uint32_t kMaxBlocks = 1u << 20;

/// The header's layout and place are the same in every version, so that a newer file can be told from a damaged one.
struct Header
{
    char magic[8];
    uint32_t version;
    uint32_t blocks;
    uint64_t fileBytes;
    uint64_t tableChecksum;
    uint64_t headerChecksum; // of the bytes before it
};
static_assert(sizeof(Header) == 40);

enum class Codec : uint32_t
{
    raw = 0,
    zstd = 1
};

struct Block
{
    uint32_t section; // Section
    uint32_t chunk;   // 0, 1, ... within the section
    Codec codec;
    uint32_t reserved; // 0
    uint64_t offset;   // from the start of the file; blocks lie one after another without gaps
    uint64_t storedBytes;
    uint64_t rawBytes;
    uint64_t checksum; // XXH3-64 of the stored bytes
};
static_assert(sizeof(Block) == 48);

struct Footer
{
    uint64_t headerChecksum; // the header's again: a file cut short and padded is noticed
    char end[8];
};

/// Sections in the order in which they are written.
enum Section : uint32_t
{
    meta,
    info,
    probes,
    distance,
    radiance,
    irradiance,
    octree,
    octreeTexels,
    prefiltered, // since version 3
    patches,     // since version 4
    surface,     // since version 5
    lamps,       // these two since version 6
    lampMaps,
    groupShares, // since version 7: of each group its radiance, irradiance, prefiltered radiance, surface light
    liveTexels,  // these since version 8: of LiveTransport
    liveLinks,   // of texels
    livePlaces,
    livePlaceLinks,
    liveTints,
    liveAlbedo,
    sectionCount
};
constexpr const char* kSectionNames[sectionCount] = {"meta",          "info",        "probes",           "distance",     "radiance",
                                                     "irradiance",    "octree",      "octree texels",    "prefiltered",  "patches",
                                                     "surface light", "lamps",       "lamp maps",        "light groups", "live texels",
                                                     "live links",    "live places", "live place links", "live tints",   "live albedo"};

/// The scalar part of an Octree.
struct OctreeHeader
{
    float boundsLow[3], boundsHigh[3], voxel;
    int32_t topCells[3], topShift;
    uint32_t bricks[3], marker, leaves, nodes;
};
static_assert(sizeof(OctreeHeader) == 68);

uint64_t checksum(std::span<const std::byte> bytes)
{
    return XXH3_64bits(bytes.data(), bytes.size());
}

template <class T> std::span<const std::byte> bytesOf(const T& value)
{
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(std::span(&value, 1));
}

std::string blockName(const Block& block)
{
    const std::string name = block.section < sectionCount ? kSectionNames[block.section] : fmt::format("unknown section {}", block.section);
    return block.section == meta || block.section == info || block.section == octree ? name : fmt::format("{} {}", name, block.chunk);
}

/// a * b * ..., or nothing on overflow.
std::optional<uint64_t> product(std::initializer_list<uint64_t> factors)
{
    uint64_t result = 1;
    for (uint64_t factor : factors)
        if (__builtin_mul_overflow(result, factor, &result)) return {};
    return result;
}

/// Of the cells of light in the open; nothing where the octree's grid is impossible, which octreeProblem() says in words.
std::optional<uint64_t> wordsOfCells(const OctreeHeader& tree, int cellShift)
{
    if (cellShift < 0 || cellShift > 15) return {};
    gpu::LightFieldInfo grid{};
    grid.surfaceSize = 1;
    grid.cellShift = cellShift;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (tree.topShift < 0 || tree.topShift > 15 || tree.topCells[axis] < 1 || (int64_t(tree.topCells[axis]) << tree.topShift) > 1 << 16)
            return {};
        grid.topCells[axis] = tree.topCells[axis];
    }
    grid.topShift = tree.topShift;
    return cellWords(grid);
}

/// What is wrong with the sizes, as a sentence; empty when every array has the length that info and octree call for.
std::string sizeProblem(const gpu::LightFieldInfo& i, const OctreeHeader& tree, const uint64_t (&rawBytes)[sectionCount])
{
    if (i.chart != gpu::kChartCube && i.chart != gpu::kChartOctahedral) return fmt::format("its chart {} is unknown", i.chart);
    if (i.faceSize < 8 || i.faceSize > 4096 || i.faceSize % 4 != 0)
        return fmt::format("its map size {} is not a multiple of 4 from 8 to 4096", i.faceSize);
    if (i.surfaceSize > i.faceSize || (i.surfaceSize > 0 && i.chart != gpu::kChartCube))
        return fmt::format("its surface light of {} texels a side does not fit its maps", i.surfaceSize);
    if (i.hidden != 0 && i.hidden >> gpu::kHiddenShiftBits == 0) return "its light of hidden surfaces has no slots";
    if (i.surfaceDirections > 1) return fmt::format("its surface light's directions are {}, not 0 or 1", i.surfaceDirections);
    if (i.probeCount > kMostProbes) return fmt::format("its probe count {} is above {}", i.probeCount, kMostProbes);
    if (i.wordsPerProbe != distanceWordsPerProbe(i.chart, i.faceSize) && !inBlocks(i))
        return "its words per probe disagree with its map size";
    if (i.chart == gpu::kChartCube && i.topLevel != coarsestLevel(i.faceSize)) return "its coarsest level disagrees with its map size";
    if (tree.marker != kMostProbesOf8Bits && tree.marker != kMostProbes)
        return fmt::format("its octree's marker {} is neither 255 nor 65535", tree.marker);
    const uint64_t n = i.probeCount;
    std::optional<uint64_t> texels = product({n, 6, i.surfaceSize, i.surfaceSize});
    if (texels && i.surfaceDirections != 0) *texels += (*texels + 1) / 2; // at most 2^53 before
    const std::optional<uint64_t> cells = i.surfaceSize > 0 ? wordsOfCells(tree, i.cellShift) : 0;
    const std::optional<uint64_t> expected[sectionCount] = {
        rawBytes[meta],
        sizeof(gpu::LightFieldInfo),
        n * sizeof(gpu::ProbeHeader),
        product({n, i.wordsPerProbe, 4}),
        product({n, radianceWordsOf(i), 4}),
        n * kIrradianceWordsPerProbe * sizeof(uint32_t),
        sizeof(OctreeHeader),
        product({tree.bricks[0], tree.bricks[1], tree.bricks[2], 8 * 4 * sizeof(uint16_t)}),
        product({n, gpu::kPrefilteredWords, 4}),
        product({n, gpu::kPatches, 8}),
        texels && cells ? product({*texels + *cells + uint64_t(gpu::kFineWords) * i.refinedTexels + hiddenWords(i), 4}) : std::nullopt,
        rawBytes[lamps], // lampProblem() looks at these two
        rawBytes[lampMaps],
        rawBytes[groupShares], // groupProblem() looks at these
        rawBytes[liveTexels],  // and liveProblem() at these
        rawBytes[liveLinks],
        rawBytes[livePlaces],
        rawBytes[livePlaceLinks],
        rawBytes[liveTints],
        rawBytes[liveAlbedo],
    };
    for (uint32_t section = 0; section < sectionCount; ++section)
    {
        const bool optional = section == radiance || section == prefiltered || section == patches ||
                              section == surface; // what no surface of the scene calls for is left out
        if (expected[section] != rawBytes[section] && !(optional && rawBytes[section] == 0))
            return fmt::format("its section '{}' has {} bytes where its info calls for another size", kSectionNames[section],
                               rawBytes[section]);
    }
    return {};
}

constexpr float kFarthest = 1e6f; // field units, of which a scene is about one across: beyond it sums and squares stay no numbers

bool isNear(vec3 place)
{
    return glm::all(glm::lessThanEqual(glm::abs(place), vec3(kFarthest))); // not NaN
}

/// What is wrong with the octree; empty when every descent ends at a leaf inside the texture that names probes which are there.
std::string octreeProblem(const FieldData& field)
{
    const gpu::LightFieldInfo& i = field.info;
    const Octree& tree = field.octree;
    if (glm::ivec3(i.topCells) != tree.topCells || i.topShift != tree.topShift || glm::uvec3(i.bricks) != tree.bricks ||
        i.marker != tree.marker || glm::vec3(i.boundsLow) != tree.boundsLow || i.voxel != tree.voxel)
        return "its octree disagrees with its info";
    if (!(tree.voxel > 0.0f && tree.voxel <= kFarthest)) return "its octree's voxel is not a size that a voxel has";
    if (tree.topShift < 0 || tree.topShift > 15) return fmt::format("its octree's depth {} is not from 0 to 15", tree.topShift);
    uint64_t topBricks = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (tree.topCells[axis] < 1 || tree.topCells[axis] > 65535 || (int64_t(tree.topCells[axis]) << tree.topShift) > (1 << 24))
            return "its octree's top grid has an impossible size";
        topBricks *= uint64_t(tree.topCells[axis] + 1) / 2;
    }
    const uint64_t bricks = uint64_t(tree.bricks.x) * tree.bricks.y * tree.bricks.z;
    if (topBricks > bricks) return "its octree's top grid is larger than its texture";

    // Every brick at every level it is reached at, each once, so that a cycle ends the walk and not the program.
    std::vector<uint16_t> seenAt(bricks, 0);
    std::vector<std::pair<uint32_t, int>> queue;
    const auto reach = [&](uint64_t brick, int level)
    {
        if ((seenAt[brick] >> level & 1) != 0) return;
        seenAt[brick] = uint16_t(seenAt[brick] | 1u << level);
        queue.emplace_back(uint32_t(brick), level);
    };
    for (uint64_t brick = 0; brick < topBricks; ++brick) reach(brick, tree.topShift);
    while (!queue.empty())
    {
        const auto [brick, level] = queue.back();
        queue.pop_back();
        const glm::uvec3 corner =
            2u * glm::uvec3(brick % tree.bricks.x, brick / tree.bricks.x % tree.bricks.y, brick / tree.bricks.x / tree.bricks.y);
        for (uint32_t child = 0; child < 8; ++child)
        {
            const glm::uvec3 at = corner + glm::uvec3(child & 1, child >> 1 & 1, child >> 2);
            const uint16_t* t = &tree.texels[4 * (at.x + 2ull * tree.bricks.x * (at.y + 2ull * tree.bricks.y * at.z))];
            if (t[3] == tree.marker)
            {
                const uint64_t next = tree.marker == 255 ? t[0] + 256ull * t[1] + 65536ull * t[2] : t[0] + 65536ull * t[1];
                if (level == 0) return fmt::format("octree brick {} goes on below the finest voxels", brick);
                if (next >= bricks) return fmt::format("octree brick {} points outside its texture", brick);
                reach(next, level - 1);
            }
            else if (std::max({t[0], t[1], t[2], t[3]}) >= field.probes.size())
                return fmt::format("octree brick {} names a probe that is not there", brick);
        }
    }
    return {};
}

/// What is wrong with the lamps; empty when each has its map.
std::string lampProblem(const FieldData& field)
{
    if (field.lamps.size() > gpu::kMostLamps) return fmt::format("it has {} lamps, above {}", field.lamps.size(), gpu::kMostLamps);
    if (!field.lamps.empty() && field.surfaceLight.empty()) return "it has lamps and no surface light";
    size_t next = field.lamps.size() * sizeof(gpu::Lamp) / sizeof(uint32_t);
    for (size_t i = 0; i < field.lamps.size(); ++i)
    {
        const gpu::Lamp& lamp = field.lamps[i];
        if (lamp.size == 0 || lamp.size > knobs::lampTexels.most || lamp.size % (gpu::kLampBlock * gpu::kLampBlock) != 0)
            return fmt::format("the map of lamp {} has an impossible size", i);
        float numbers[offsetof(gpu::Lamp, size) / sizeof(float)];
        std::memcpy(numbers, &lamp, sizeof(numbers));
        if (!std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); }))
            return fmt::format("lamp {} holds a number that is not finite", i);
        if (lamp.firstWord != next) return fmt::format("the map of lamp {} is not where it belongs", i);
        next += lampMapWords(lamp.size);
    }
    const size_t words = field.lamps.size() * sizeof(gpu::Lamp) / sizeof(uint32_t) + field.lampMaps.size();
    return next == words ? "" : "its lamps' maps have another size than its lamps say";
}

/// What is wrong with the light groups; empty when the shares have the field's places.
std::string groupProblem(const FieldData& field)
{
    if (field.groups.size() > kMostLightGroups)
        return fmt::format("it has {} light groups, above {}", field.groups.size(), kMostLightGroups);
    if (!field.groups.empty() && field.surfaceLight.empty()) return "it has light groups and no surface light";
    const size_t texels = size_t(6) * field.info.surfaceSize * field.info.surfaceSize * field.info.probeCount;
    for (const LightGroup& group : field.groups)
    {
        const std::string& name = group.which.name;
        if (!finite(group.sky) || group.lamps.size() != field.lamps.size() ||
            !std::ranges::all_of(group.lamps, [](vec3 x) { return finite(x); }))
            return fmt::format("the sky or the lamps of light group '{}' are not as the field's", name);
        for (const LightPart& part : kLightParts)
            if ((group.*part.share).size() != (field.*part.words).size())
                return fmt::format("the shares of light group '{}' have another size than the field's light", name);
        for (size_t texel = 0; texel < texels; ++texel)
        {
            const uint32_t word = group.surfaceLight[texel], own = field.surfaceLight[texel];
            if (std::max(word, own) >= gpu::kRefinedWord && word != own)
                return fmt::format("texel {} of light group '{}' is refined to other ones than the field's", texel, name);
        }
    }
    return {};
}

/// What is wrong with what lets lights move; empty when every link leads to a texel.
std::string liveProblem(const FieldData& field)
{
    const LiveTransport& live = field.live;
    const gpu::LightFieldInfo& i = field.info;
    if (live.links == 0) return bytesOf(live) > 0 ? "it has live light without links" : "";
    if (live.links > knobs::liveLinks.most) return fmt::format("it has {} live links a texel, above {}", live.links, knobs::liveLinks.most);
    const uint64_t texels = uint64_t(6) * i.surfaceSize * i.surfaceSize * i.probeCount, half = i.faceSize / 2;
    if (field.groups.empty() || field.surfaceLight.empty()) return "it has live light without light groups or surface light";
    if (const uint64_t links = std::max<uint64_t>(texels, live.places.size()) * live.links; links > kMostLiveLinks)
        return fmt::format("it has {} live links, above {}", links, kMostLiveLinks);
    if (live.texels.size() != texels || live.texelLinks.size() != texels * live.links ||
        live.placeLinks.size() != live.places.size() * live.links || live.tints.size() != gpu::kTints ||
        live.albedo.size() != (6 * half * half * i.probeCount + 1) / 2)
        return "its live light has another size than its surface light";
    const auto lost = [&](uint32_t link) {
        return link < gpu::kLinkDark &&
               ((link & ((1u << gpu::kLinkTexelBits) - 1)) >= texels || link >> gpu::kLinkTexelBits >= gpu::kTints);
    };
    if (std::ranges::any_of(live.texelLinks, lost) || std::ranges::any_of(live.placeLinks, lost))
        return "a link of its live light leads to no texel";
    if (std::ranges::any_of(live.places, [&](uint32_t word) { return word < texels || word >= field.surfaceLight.size(); }))
        return "a place of its live light is not in its surface light";
    if (!std::ranges::all_of(live.tints, [](vec3 tint) { return finite(tint); })) return "a tint of its live light is not finite";
    if (std::string fault = lightFault(live.lights); !fault.empty()) return "of its live lights " + fault;
    return {};
}

/// What is wrong with the values that addressing relies on; empty when all is well.
std::string contentProblem(const FieldData& field)
{
    const gpu::LightFieldInfo& i = field.info;
    if (!finite(i.origin) || !(i.scale > 0.0f) || !std::isfinite(i.scale) || !finite(i.sky))
        return "its info holds a number that is not finite";
    for (const vec3& place : {vec3(i.boundsLow), vec3(i.boundsHigh), vec3(i.sceneLow), vec3(i.sceneHigh), vec3(i.gridOrigin),
                              vec3(i.gridStep), vec3(i.diagonal)})
        if (!isNear(place)) return "its bounds lie where no scene's do";
    if (i.diagonal < 0.0f) return "its diagonal is negative";
    for (size_t p = 0; p < field.probes.size(); ++p)
    {
        const gpu::ProbeHeader& probe = field.probes[p];
        if (!isNear(probe.centre) || !isNear(probe.influenceLow) || !isNear(probe.influenceHigh) ||
            !isNear({probe.freeRadius, probe.farthest, probe.harmonic}))
            return fmt::format("the centre or the distances of probe {} lie where no scene's do", p);
    }
    if (!field.why.empty() && field.why.size() != field.info.probeCount)
        return fmt::format("it says why {} probes are where they are, and has {}", field.why.size(), field.info.probeCount);
    if (std::string problem = lampProblem(field); !problem.empty()) return problem;
    if (std::string problem = groupProblem(field); !problem.empty()) return problem;
    if (std::string problem = liveProblem(field); !problem.empty()) return problem;
    const bool grid = i.gridX != 0;
    if (grid && (std::max({i.gridX, i.gridY, i.gridZ}) > kMostProbes || uint64_t(i.gridX) * i.gridY * i.gridZ != i.probeCount))
        return fmt::format("its grid of {}x{}x{} has not the {} probes that there are", i.gridX, i.gridY, i.gridZ, i.probeCount);
    const size_t texels = size_t(6) * i.surfaceSize * i.surfaceSize * i.probeCount;
    for (size_t texel = 0; texel < std::min(texels, field.surfaceLight.size()); ++texel)
        if (const uint32_t word = field.surfaceLight[texel]; word >= gpu::kRefinedWord && word - gpu::kRefinedWord >= i.refinedTexels)
            return fmt::format("texel {} of its surface light names finer ones that are not there", texel);
    if (field.octree.texels.empty()) return grid || field.probes.empty() ? "" : "it has neither an octree nor a grid to find its probes by";
    return octreeProblem(field);
}

OctreeHeader headerOf(const Octree& tree)
{
    OctreeHeader h{};
    for (int axis = 0; axis < 3; ++axis)
    {
        h.boundsLow[axis] = tree.boundsLow[axis];
        h.boundsHigh[axis] = tree.boundsHigh[axis];
        h.topCells[axis] = tree.topCells[axis];
        h.bricks[axis] = tree.bricks[axis];
    }
    h.voxel = tree.voxel;
    h.topShift = tree.topShift;
    h.marker = tree.marker;
    h.leaves = tree.leaves;
    h.nodes = tree.nodes;
    return h;
}

void applyHeader(const OctreeHeader& h, Octree& tree)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        tree.boundsLow[axis] = h.boundsLow[axis];
        tree.boundsHigh[axis] = h.boundsHigh[axis];
        tree.topCells[axis] = h.topCells[axis];
        tree.bricks[axis] = h.bricks[axis];
    }
    tree.voxel = h.voxel;
    tree.topShift = h.topShift;
    tree.marker = h.marker;
    tree.leaves = h.leaves;
    tree.nodes = h.nodes;
}

std::string metaText(const FieldData& field)
{
    nlohmann::ordered_json json;
    json["scene"] = field.sceneName;
    json["resolution"] = field.resolution;
    json["bounces"] = field.bounces;
    json["effects"] = field.effects;
    json["probes"] = field.info.probeCount;
    if (!field.why.empty()) json["why"] = field.why;
    const auto numbers = [](vec3 v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    for (const LightGroup& group : field.groups)
    {
        nlohmann::ordered_json one = {{"name", group.which.name}, {"members", group.which.members}, {"sky", numbers(group.sky)}};
        one["lamps"] = nlohmann::ordered_json::array();
        for (const vec3& radiance : group.lamps) one["lamps"].push_back(numbers(radiance));
        json["groups"].push_back(one);
    }
    if (field.live.links > 0) json["live"] = {{"links", field.live.links}, {"lit", field.live.lit}};
    for (const Light& light : field.live.lights)
        json["live"]["lights"].push_back({{"name", light.name},
                                          {"type", uint32_t(light.type)},
                                          {"position", numbers(light.position)},
                                          {"direction", numbers(light.direction)},
                                          {"intensity", numbers(light.intensity)},
                                          {"range", light.range},
                                          {"inner_cone", light.innerCone},
                                          {"outer_cone", light.outerCone}});
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Three numbers; false where they are none.
bool applyNumbers(const nlohmann::json& json, vec3& value)
{
    if (!json.is_array() || json.size() != 3) return false;
    for (int i = 0; i < 3; ++i)
    {
        if (!json[size_t(i)].is_number()) return false;
        value[i] = json[size_t(i)].get<float>();
    }
    return true;
}

/// The light groups but their words.
bool applyGroups(const nlohmann::json& json, std::vector<LightGroup>& groups)
{
    if (!json.is_array() || json.size() > kMostLightGroups) return false;
    for (const nlohmann::json& one : json)
    {
        LightGroup group;
        if (!one.is_object() || !one.contains("name") || !one["name"].is_string() || !one.contains("members") ||
            !one["members"].is_array() || !one.contains("sky") || !applyNumbers(one["sky"], group.sky) || !one.contains("lamps") ||
            !one["lamps"].is_array() || one["lamps"].size() > gpu::kMostLamps)
            return false;
        group.which.name = one["name"].get<std::string>();
        for (const nlohmann::json& member : one["members"])
        {
            if (!member.is_string()) return false;
            group.which.members.push_back(member.get<std::string>());
        }
        for (const nlohmann::json& lamp : one["lamps"])
            if (!applyNumbers(lamp, group.lamps.emplace_back())) return false;
        groups.push_back(std::move(group));
    }
    return true;
}

/// Links and lights of live light.
bool applyLive(const nlohmann::json& json, LiveTransport& live)
{
    if (!json.is_object() || !json.contains("links") || !json["links"].is_number_unsigned()) return false;
    live.links = uint32_t(std::min<uint64_t>(json["links"].get<uint64_t>(), UINT32_MAX));
    if (json.contains("lit") && !json["lit"].is_boolean()) return false;
    live.lit = json.value("lit", true);
    if (!json.contains("lights")) return true;
    if (!json["lights"].is_array() || json["lights"].size() > kMostLiveLights) return false;
    for (const nlohmann::json& one : json["lights"])
    {
        Light light;
        const auto number = [&](const char* key, float& value)
        {
            if (!one.contains(key) || !one[key].is_number()) return false;
            value = one[key].get<float>();
            return true;
        };
        const auto three = [&](const char* key, vec3& value) { return one.contains(key) && applyNumbers(one[key], value); };
        if (!one.is_object() || !one.contains("name") || !one["name"].is_string() || !one.contains("type") ||
            !one["type"].is_number_unsigned() || one["type"].get<uint64_t>() > uint64_t(LightType::spot) ||
            !three("position", light.position) || !three("direction", light.direction) || !three("intensity", light.intensity) ||
            !number("range", light.range) || !number("inner_cone", light.innerCone) || !number("outer_cone", light.outerCone))
            return false;
        light.name = one["name"].get<std::string>();
        light.type = LightType(one["type"].get<uint32_t>());
        live.lights.push_back(std::move(light));
    }
    return true;
}

/// False when the text is not what metaText() writes.
bool applyMeta(std::string_view text, FieldData& field)
{
    const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) return false;
    const auto number = [&](const char* key, uint32_t& value)
    {
        const auto it = json.find(key);
        if (it == json.end() || !it->is_number_unsigned()) return false;
        value = uint32_t(std::min<uint64_t>(it->get<uint64_t>(), UINT32_MAX));
        return true;
    };
    if (!number("resolution", field.resolution) || !number("bounces", field.bounces)) return false;
    const auto scene = json.find("scene"), effects = json.find("effects");
    if (scene == json.end() || !scene->is_string() || effects == json.end()) return false;
    field.sceneName = scene->get<std::string>();
    const auto texts = [](const nlohmann::json& list, std::vector<std::string>& to)
    {
        if (!list.is_array() || !std::ranges::all_of(list, [](const nlohmann::json& one) { return one.is_string(); })) return false;
        to = list.get<std::vector<std::string>>();
        return true;
    };
    if (!texts(*effects, field.effects)) return false;
    if (const auto why = json.find("why"); why != json.end() && !texts(*why, field.why)) return false;
    return (!json.contains("groups") || applyGroups(json["groups"], field.groups)) &&
           (!json.contains("live") || applyLive(json["live"], field.live));
}

/// An open file of known size.
class Reader
{
public:
    static Result<Reader> open(const std::filesystem::path& file)
    {
        Reader reader;
        reader.name = file.string();
        std::error_code error;
        if (std::filesystem::is_directory(file, error)) return reader.failure("it is a folder");
        reader.size = std::filesystem::file_size(file, error);
        if (error) return reader.failure(error.message());
        reader.stream.open(file, std::ios::binary);
        if (!reader.stream) return reader.failure("it cannot be opened");
        return reader;
    }

    Status read(uint64_t offset, std::span<std::byte> bytes)
    {
        stream.clear();
        stream.seekg(std::streamoff(offset));
        stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
        if (!stream) return failure(fmt::format("reading {} bytes at offset {} failed", bytes.size(), offset));
        return success();
    }

    Error failure(const std::string& reason) const
    {
        return {ErrorCode::fileError, fmt::format("Cannot read light field '{}': {}.", name, reason)};
    }
    Error damage(const std::string& what) const
    {
        return {ErrorCode::badInput, fmt::format("Light field '{}' is damaged: {}. Bake it again or restore it from a copy.", name, what)};
    }

    std::string name;
    uint64_t size = 0;

private:
    std::ifstream stream;
};

struct Table
{
    Header header{};
    std::vector<Block> blocks;
};

/// What is wrong with the table's entries; empty when blocks lie gapless between table and footer, sections in order.
std::string tableProblem(const Table& table, uint64_t fileBytes)
{
    uint64_t at = sizeof(Header) + table.blocks.size() * sizeof(Block);
    uint32_t section = 0, chunk = 0;
    for (const Block& block : table.blocks)
    {
        // Sections in order and without gaps: no byte of the file is left that no checksum covers.
        const std::string name = fmt::format("block '{}'", blockName(block));
        if (block.section >= sectionCount || block.section < section) return fmt::format("{} is not where it belongs", name);
        chunk = block.section == section ? chunk : 0;
        section = block.section;
        if (block.chunk != chunk++) return fmt::format("{} is out of sequence", name);
        if (block.offset != at || block.storedBytes > fileBytes - at) return fmt::format("{} lies outside the file", name);
        if (block.codec != Codec::raw && block.codec != Codec::zstd) return fmt::format("{} has an unknown codec", name);
        if (block.rawBytes > kChunkBytes || block.reserved != 0) return fmt::format("{} has an impossible size", name);
        if (block.codec == Codec::raw ? block.rawBytes != block.storedBytes : block.rawBytes / kZstdMaxRatio > block.storedBytes)
            return fmt::format("{} has sizes that contradict each other", name);
        at += block.storedBytes;
    }
    return at + sizeof(Footer) == fileBytes ? "" : "its blocks do not end where the file ends";
}

/// Header, table and footer, in that order; every finding goes to the report as a row (a sound one too).
Result<Table> readTable(Reader& reader, VerifyReport& report)
{
    report.fileBytes = reader.size;
    Table table;
    const auto row = [&](const char* name, uint64_t offset, uint64_t bytes, std::string problem) {
        report.blocks.push_back({name, offset, bytes, bytes, std::move(problem)});
    };
    const auto damaged = [&](const char* name, uint64_t offset, uint64_t bytes, const std::string& problem)
    {
        row(name, offset, bytes, problem);
        return reader.damage(problem);
    };

    if (reader.size < sizeof(Header))
        return damaged("header", 0, reader.size, fmt::format("it has {} bytes, fewer than a header", reader.size));
    if (Status status = reader.read(0, std::as_writable_bytes(std::span(&table.header, 1))); !status) return status.error();
    const Header& header = table.header;
    // Magic and checksum first: no field of the header is believed before them.
    if (std::memcmp(header.magic, kMagic, sizeof(kMagic)) != 0)
        return damaged("header", 0, sizeof(Header), "it does not begin as a .sconce file does");
    if (header.headerChecksum != checksum(bytesOf(header).first(offsetof(Header, headerChecksum))))
        return damaged("header", 0, sizeof(Header), "its header does not match its checksum");
    report.version = header.version;
    if (header.version < kOldestFieldFileVersion || header.version > kFieldFileVersion)
    {
        row("header", 0, sizeof(Header), fmt::format("format version {}", header.version));
        return Error{ErrorCode::badInput,
                     fmt::format("Light field '{}' has format version {}; this program reads versions {} to {}{}", reader.name,
                                 header.version, kOldestFieldFileVersion, kFieldFileVersion,
                                 header.version > kFieldFileVersion ? ". Use a newer Sconce, or bake it again." : ". Bake it again.")};
    }
    if (header.fileBytes != reader.size)
        return damaged("header", 0, sizeof(Header),
                       fmt::format("it has {} bytes instead of {}; it was cut short or added to", reader.size, header.fileBytes));
    row("header", 0, sizeof(Header), "");

    // A table of made-up length must not be allocated: it is held against the file's size.
    const uint64_t tableBytes = uint64_t(header.blocks) * sizeof(Block);
    if (header.blocks > kMaxBlocks || tableBytes > reader.size - sizeof(Header))
        return damaged("table", sizeof(Header), tableBytes, "its block table is larger than the file");
    table.blocks.resize(header.blocks);
    if (Status status = reader.read(sizeof(Header), std::as_writable_bytes(std::span(table.blocks))); !status) return status.error();
    if (checksum(std::as_bytes(std::span(table.blocks))) != header.tableChecksum)
        return damaged("table", sizeof(Header), tableBytes, "its block table does not match its checksum");
    if (const std::string problem = tableProblem(table, reader.size); !problem.empty())
        return damaged("table", sizeof(Header), tableBytes, problem);
    row("table", sizeof(Header), tableBytes, "");

    Footer footer{};
    const uint64_t footerOffset = reader.size - sizeof(Footer);
    if (Status status = reader.read(footerOffset, std::as_writable_bytes(std::span(&footer, 1))); !status) return status.error();
    // The footer repeats the header's checksum: both ends are of the same save.
    if (footer.headerChecksum != header.headerChecksum || std::memcmp(footer.end, kEnd, sizeof(kEnd)) != 0)
        return damaged("footer", footerOffset, sizeof(Footer), "its footer is not the one its header calls for");
    row("footer", footerOffset, sizeof(Footer), "");
    return table;
}

/// Reads a block, checks it and decodes it into `raw`, which has block.rawBytes bytes.
Status readBlock(Reader& reader, const Block& block, Bytes& stored, std::span<std::byte> raw)
{
    stored.resize(block.storedBytes);
    if (Status status = reader.read(block.offset, stored); !status) return status;
    if (checksum(stored) != block.checksum) return reader.damage(fmt::format("block '{}' does not match its checksum", blockName(block)));
    if (block.codec == Codec::raw)
    {
        std::ranges::copy(stored, raw.begin());
        return success();
    }
    const size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
    if (ZSTD_isError(size) || size != raw.size()) return reader.damage(fmt::format("block '{}' cannot be decompressed", blockName(block)));
    return success();
}

/// Of a section whose blocks these are, from a byte on. Blocks of which it asks nothing aren't read.
Status readRange(Reader& reader, std::span<const Block> blocks, uint64_t from, std::span<std::byte> out, Bytes& stored, Bytes& raw)
{
    uint64_t at = 0; // of the block in its section
    for (const Block& block : blocks)
    {
        const uint64_t first = std::max(from, at), last = std::min(from + out.size(), at + block.rawBytes);
        if (first < last)
        {
            raw.resize(block.rawBytes);
            if (Status status = readBlock(reader, block, stored, raw); !status) return status;
            std::ranges::copy(std::span(raw).subspan(first - at, last - first), out.begin() + std::ptrdiff_t(first - from));
        }
        at += block.rawBytes;
    }
    return success();
}

std::vector<Block> blocksOfSection(const Table& table, Section section)
{
    std::vector<Block> found;
    std::ranges::copy_if(table.blocks, std::back_inserter(found), [&](const Block& block) { return block.section == section; });
    return found;
}

/// Bytes of a section's blocks but the last: of the maps as many probes as come to kMapBytes, at least one, so that they can be read one by
/// one; of the shares of light groups, most of which is radiance of maps, as much.
uint64_t blockBytes(Section section, uint64_t bytes, const gpu::LightFieldInfo& info)
{
    const uint64_t probe = section == distance || section == radiance ? bytes / std::max(info.probeCount, 1u)
                           : section == groupShares                   ? radianceWordsOf(info) * sizeof(uint32_t)
                                                                      : 0;
    return probe == 0 || probe > kChunkBytes ? kChunkBytes : probe * std::max<uint64_t>(1, kMapBytes / probe);
}

uint64_t blocksOf(uint64_t bytes, uint64_t ofBlock)
{
    return std::max<uint64_t>(1, (bytes + ofBlock - 1) / ofBlock); // an empty section has one block, of 0 bytes
}

/// Appends the section in blocks, and each block's entry to the table.
Status appendSection(SafeFile& file, Section section, std::span<const std::byte> raw, uint64_t most, uint64_t& offset,
                     std::vector<Block>& blocks)
{
    Bytes packed(ZSTD_compressBound(std::min<uint64_t>(raw.size(), most)));
    uint32_t chunk = 0;
    do
    {
        const std::span<const std::byte> piece = raw.first(std::min<uint64_t>(raw.size(), most));
        raw = raw.subspan(piece.size());
        const size_t size = ZSTD_compress(packed.data(), packed.size(), piece.data(), piece.size(), kZstdLevel);
        const bool smaller = !ZSTD_isError(size) && size < piece.size();
        const std::span<const std::byte> stored = smaller ? std::span<const std::byte>(packed).first(size) : piece;
        blocks.push_back({section, chunk++, smaller ? Codec::zstd : Codec::raw, 0, offset, stored.size(), piece.size(), checksum(stored)});
        offset += stored.size();
        if (Status status = file.append(stored); !status) return status;
    } while (!raw.empty());
    return success();
}

Status saveChecked(const FieldData& field, const std::filesystem::path& path)
{
    const OctreeHeader treeHeader = headerOf(field.octree);
    const std::string text = metaText(field);
    std::vector<uint32_t> shares;
    for (const LightGroup& group : field.groups)
        for (const LightPart& part : kLightParts) shares.insert(shares.end(), (group.*part.share).begin(), (group.*part.share).end());
    const uint32_t sectionsHere = field.live.links > 0   ? uint32_t(sectionCount)
                                  : field.groups.empty() ? uint32_t(groupShares)
                                                         : uint32_t(liveTexels);
    const std::span<const std::byte> sections[sectionCount] = {
        std::as_bytes(std::span(text)),
        bytesOf(field.info),
        std::as_bytes(std::span(field.probes)),
        std::as_bytes(std::span(field.distance)),
        std::as_bytes(std::span(field.radiance)),
        std::as_bytes(std::span(field.irradiance)),
        bytesOf(treeHeader),
        std::as_bytes(std::span(field.octree.texels)),
        std::as_bytes(std::span(field.prefiltered)),
        std::as_bytes(std::span(field.patches)),
        std::as_bytes(std::span(field.surfaceLight)),
        std::as_bytes(std::span(field.lamps)),
        std::as_bytes(std::span(field.lampMaps)),
        std::as_bytes(std::span(shares)),
        std::as_bytes(std::span(field.live.texels)),
        std::as_bytes(std::span(field.live.texelLinks)),
        std::as_bytes(std::span(field.live.places)),
        std::as_bytes(std::span(field.live.placeLinks)),
        std::as_bytes(std::span(field.live.tints)),
        std::as_bytes(std::span(field.live.albedo)),
    };
    uint64_t rawBytes[sectionCount] = {}, blockCount = 0;
    for (uint32_t section = 0; section < sectionsHere; ++section)
    {
        rawBytes[section] = sections[section].size();
        blockCount += blocksOf(rawBytes[section], blockBytes(Section(section), sections[section].size(), field.info));
    }
    std::string problem = sizeProblem(field.info, treeHeader, rawBytes);
    if (problem.empty()) problem = contentProblem(field);
    if (problem.empty() && blockCount > kMaxBlocks) problem = fmt::format("it has {} blocks, above {}", blockCount, kMaxBlocks);
    if (!problem.empty()) return Error{ErrorCode::badArgument, fmt::format("The light field cannot be written: {}.", problem)};

    Result<SafeFile> file = SafeFile::create(path);
    if (!file) return file.error();
    // Room for header and table, which are written last: checksums and compressed sizes are not known earlier.
    uint64_t offset = sizeof(Header) + blockCount * sizeof(Block);
    if (Status status = file->append(Bytes(offset)); !status) return status;
    std::vector<Block> blocks;
    for (uint32_t section = 0; section < sectionsHere; ++section)
        if (Status status = appendSection(*file, Section(section), sections[section],
                                          blockBytes(Section(section), sections[section].size(), field.info), offset, blocks);
            !status)
            return status;

    Header header{{}, fileVersionOf(field), uint32_t(blocks.size()), offset + sizeof(Footer), checksum(std::as_bytes(std::span(blocks))),
                  0};
    std::memcpy(header.magic, kMagic, sizeof(kMagic));
    header.headerChecksum = checksum(bytesOf(header).first(offsetof(Header, headerChecksum)));
    Footer footer{header.headerChecksum, {}};
    std::memcpy(footer.end, kEnd, sizeof(kEnd));
    if (Status status = file->append(bytesOf(footer)); !status) return status;
    if (Status status = file->overwrite(sizeof(Header), std::as_bytes(std::span(blocks))); !status) return status;
    if (Status status = file->overwrite(0, bytesOf(header)); !status) return status;
    return file->commit();
}

/// Before version 10 the 8 bits of packGrazing() (shaders/shared/gathered_rays.h) were all a coat's.
void giveGrazingASign(std::span<gpu::LiveTexel> texels)
{
    for (gpu::LiveTexel& texel : texels) texel.normal = (texel.normal & 0xffffffu) | ((texel.normal >> 24) * 127u + 127u) / 255u << 24;
}

/// @param maps  whether distance and radiance are read; else they stay empty, and so do groups' shares of radiance, of what can do without:
/// cube faces whose lights don't move
Result<FieldData> readField(Reader& reader, const Table& table, bool maps)
{
    uint64_t rawBytes[sectionCount] = {};
    for (const Block& block : table.blocks) rawBytes[block.section] += block.rawBytes;
    FieldData field;
    field.fileVersion = table.header.version;
    OctreeHeader treeHeader{};
    std::string text;
    Bytes stored;
    const auto readInto = [&](Section section, std::span<std::byte> raw) -> Status
    {
        if (rawBytes[section] != raw.size())
            return reader.damage(fmt::format("its section '{}' has the wrong size", kSectionNames[section]));
        for (const Block& block : table.blocks)
        {
            if (block.section != section) continue;
            if (Status status = readBlock(reader, block, stored, raw.first(block.rawBytes)); !status) return status;
            raw = raw.subspan(block.rawBytes);
        }
        return success();
    };
    // The two small sections that say how large the others must be come first, so that nothing large is allocated for a lie.
    if (Status status = readInto(info, std::as_writable_bytes(std::span(&field.info, 1))); !status) return status.error();
    if (Status status = readInto(octree, std::as_writable_bytes(std::span(&treeHeader, 1))); !status) return status.error();
    if (const std::string problem = sizeProblem(field.info, treeHeader, rawBytes); !problem.empty()) return reader.damage(problem);
    applyHeader(treeHeader, field.octree);
    text.resize(rawBytes[meta]);
    if (Status status = readInto(meta, std::as_writable_bytes(std::span(text))); !status) return status.error();
    if (!applyMeta(text, field)) return reader.damage("block 'meta' is not the JSON text it should be");
    const bool octahedral = field.info.chart != gpu::kChartCube;
    if (!maps && (octahedral || field.live.links > 0))
        return Error{ErrorCode::badArgument,
                     fmt::format("The maps of light field '{}' can't be read while frames are drawn: {}. Load all of it, or bake it {}.",
                                 reader.name, octahedral ? "they are octahedral" : "its lights may move",
                                 octahedral ? "with cube faces" : "without live links")};
    const uint64_t ofGroup = rawBytes[radiance] + rawBytes[irradiance] + rawBytes[prefiltered] + rawBytes[surface];
    if (rawBytes[groupShares] != field.groups.size() * ofGroup)
        return reader.damage(
            fmt::format("its section '{}' has another size than its {} groups", kSectionNames[groupShares], field.groups.size()));
    std::vector<uint32_t> shares(maps ? rawBytes[groupShares] / sizeof(uint32_t) : 0);
    field.probes.resize(rawBytes[probes] / sizeof(gpu::ProbeHeader));
    if (maps)
    {
        field.distance.resize(rawBytes[distance] / sizeof(uint32_t));
        field.radiance.resize(rawBytes[radiance] / sizeof(uint32_t));
    }
    field.irradiance.resize(rawBytes[irradiance] / sizeof(uint32_t));
    field.octree.texels.resize(rawBytes[octreeTexels] / sizeof(uint16_t));
    field.prefiltered.resize(rawBytes[prefiltered] / sizeof(uint32_t));
    field.patches.resize(rawBytes[patches] / sizeof(uint32_t));
    field.surfaceLight.resize(rawBytes[surface] / sizeof(uint32_t));
    field.lamps.resize(rawBytes[lamps] / sizeof(gpu::Lamp));
    field.lampMaps.resize(rawBytes[lampMaps] / sizeof(uint32_t));
    field.live.texels.resize(rawBytes[liveTexels] / sizeof(gpu::LiveTexel));
    field.live.texelLinks.resize(rawBytes[liveLinks] / sizeof(uint32_t));
    field.live.places.resize(rawBytes[livePlaces] / sizeof(uint32_t));
    field.live.placeLinks.resize(rawBytes[livePlaceLinks] / sizeof(uint32_t));
    field.live.tints.resize(rawBytes[liveTints] / sizeof(vec3));
    field.live.albedo.resize(rawBytes[liveAlbedo] / sizeof(uint32_t));
    const std::pair<Section, std::span<std::byte>> parts[] = {
        {probes, std::as_writable_bytes(std::span(field.probes))},
        {distance, std::as_writable_bytes(std::span(field.distance))},
        {radiance, std::as_writable_bytes(std::span(field.radiance))},
        {irradiance, std::as_writable_bytes(std::span(field.irradiance))},
        {octreeTexels, std::as_writable_bytes(std::span(field.octree.texels))},
        {prefiltered, std::as_writable_bytes(std::span(field.prefiltered))},
        {patches, std::as_writable_bytes(std::span(field.patches))},
        {surface, std::as_writable_bytes(std::span(field.surfaceLight))},
        {lamps, std::as_writable_bytes(std::span(field.lamps))},
        {lampMaps, std::as_writable_bytes(std::span(field.lampMaps))},
        {groupShares, std::as_writable_bytes(std::span(shares))},
        {liveTexels, std::as_writable_bytes(std::span(field.live.texels))},
        {liveLinks, std::as_writable_bytes(std::span(field.live.texelLinks))},
        {livePlaces, std::as_writable_bytes(std::span(field.live.places))},
        {livePlaceLinks, std::as_writable_bytes(std::span(field.live.placeLinks))},
        {liveTints, std::as_writable_bytes(std::span(field.live.tints))},
        {liveAlbedo, std::as_writable_bytes(std::span(field.live.albedo))},
    };
    for (const auto& [section, raw] : parts)
    {
        if (!maps && (section == distance || section == radiance || section == groupShares)) continue;
        if (Status status = readInto(section, raw); !status) return status.error();
    }
    if (table.header.version < kLiveFileVersion) giveGrazingASign(field.live.texels);
    auto word = shares.cbegin();
    uint64_t at = 0; // of a part in its section
    Bytes raw;
    const std::vector<Block> ofShares = blocksOfSection(table, groupShares);
    for (LightGroup& group : field.groups)
        for (const LightPart& part : kLightParts)
        {
            std::vector<uint32_t>& share = group.*part.share;
            const size_t words = (field.*part.words).size();
            if (maps)
            {
                share.assign(word, word + std::ptrdiff_t(words));
                word += std::ptrdiff_t(words);
                continue;
            }
            share.resize(words);
            if (Status status = readRange(reader, ofShares, at, std::as_writable_bytes(std::span(share)), stored, raw); !status)
                return status.error();
            at += part.words == &FieldData::radiance ? rawBytes[radiance] : words * sizeof(uint32_t);
        }
    if (const std::string problem = contentProblem(field); !problem.empty()) return reader.damage(problem);
    return field;
}

Result<FieldData> loadChecked(const std::filesystem::path& path)
{
    Result<Reader> reader = Reader::open(path);
    if (!reader) return reader.error();
    VerifyReport rows;
    Result<Table> table = readTable(*reader, rows);
    if (!table) return table.error();
    return readField(*reader, *table, true);
}

Result<VerifyReport> verifyChecked(const std::filesystem::path& path)
{
    Result<Reader> reader = Reader::open(path);
    if (!reader) return reader.error();
    VerifyReport report;
    Result<Table> table = readTable(*reader, report);
    if (!table)
    {
        if (table.error().code == ErrorCode::fileError) return table.error();
        return report;
    }
    // The footer's row goes to the end again: rows are in the order of the file.
    const BlockReport footer = report.blocks.back();
    report.blocks.pop_back();
    Bytes stored, raw;
    for (const Block& block : table->blocks)
    {
        raw.resize(block.rawBytes);
        const Status status = readBlock(*reader, block, stored, raw);
        if (!status && status.error().code == ErrorCode::fileError) return status.error();
        report.blocks.push_back(
            {blockName(block), block.offset, block.storedBytes, block.rawBytes, status ? "" : "does not match its checksum"});
    }
    report.blocks.push_back(footer);
    // Sound blocks may still hold values that contradict each other, which loading finds.
    if (!report.ok()) return report;
    if (const Result<FieldData> field = loadChecked(path); !field) report.problem = field.error().message;
    return report;
}

/// Allocation is the one thing in here that can throw.
template <class Function> auto guarded(const std::filesystem::path& path, Function&& function) -> decltype(function())
{
    try
    {
        return function();
    }
    catch (const std::bad_alloc&)
    {
        return Error{ErrorCode::outOfMemory,
                     fmt::format("Light field '{}' does not fit into memory; bake fewer probes or a lower resolution.", path.string())};
    }
}

} // namespace

bool VerifyReport::ok() const
{
    return problem.empty() && std::ranges::all_of(blocks, [](const BlockReport& block) { return block.problem.empty(); });
}

Status saveField(const FieldData& field, const std::filesystem::path& file)
{
    return guarded(file, [&] { return saveChecked(field, file); });
}

Result<FieldData> loadField(const std::filesystem::path& file)
{
    return guarded(file, [&] { return loadChecked(file); });
}

uint64_t lightHashOf(const FieldData& field)
{
    uint64_t hash = 0;
    const auto add = [&hash](const auto& items) { hash = XXH3_64bits_withSeed(items.data(), items.size() * sizeof items[0], hash); };
    add(field.probes);
    add(field.irradiance);
    add(field.prefiltered);
    add(field.surfaceLight);
    return hash;
}

struct MapFile::State
{
    Reader reader;
    std::vector<Block> distanceBlocks, radianceBlocks, shareBlocks;
    size_t distanceWords = 0, radianceWords = 0; // of a probe
    uint32_t groups = 0;
    uint64_t groupBytes = 0; // of a group's share of all light, whose radiance comes first
    Bytes stored, raw;

    /// Of one of the sections, from a byte on.
    Status read(std::span<const Block> blocks, uint64_t from, std::span<uint32_t> out)
    {
        return readRange(reader, blocks, from, std::as_writable_bytes(out), stored, raw);
    }
};

MapFile::MapFile(std::unique_ptr<State> made) : owned(std::move(made)) {}
MapFile::MapFile(MapFile&&) noexcept = default;
MapFile& MapFile::operator=(MapFile&&) noexcept = default;
MapFile::~MapFile() = default;

size_t MapFile::distanceWords() const
{
    return owned->distanceWords;
}

size_t MapFile::radianceWords() const
{
    return owned->radianceWords;
}

uint32_t MapFile::groups() const
{
    return owned->groups;
}

Status MapFile::read(uint32_t probe, std::span<uint32_t> distance_, std::span<uint32_t> radiance_)
{
    return guarded(owned->reader.name,
                   [&]() -> Status
                   {
                       if (Status status = owned->read(owned->distanceBlocks, probe * uint64_t(distance_.size_bytes()), distance_); !status)
                           return status;
                       return owned->read(owned->radianceBlocks, probe * uint64_t(radiance_.size_bytes()), radiance_);
                   });
}

Status MapFile::readShares(uint32_t probe, std::span<uint32_t> distance_, std::span<uint32_t> shares)
{
    assert(shares.size() == owned->groups * owned->radianceWords);
    return guarded(owned->reader.name,
                   [&]() -> Status
                   {
                       Status status = owned->read(owned->distanceBlocks, probe * uint64_t(distance_.size_bytes()), distance_);
                       const uint64_t words = owned->radianceWords;
                       for (uint32_t group = 0; status && group < owned->groups; ++group)
                           status = owned->read(owned->shareBlocks, group * owned->groupBytes + probe * words * sizeof(uint32_t),
                                                shares.subspan(group * words, words));
                       return status;
                   });
}

Result<FieldAndMaps> openField(const std::filesystem::path& file)
{
    return guarded(file,
                   [&]() -> Result<FieldAndMaps>
                   {
                       Result<Reader> reader = Reader::open(file);
                       if (!reader) return reader.error();
                       VerifyReport rows;
                       Result<Table> table = readTable(*reader, rows);
                       if (!table) return table.error();
                       Result<FieldData> field = readField(*reader, *table, false);
                       if (!field) return field.error();
                       auto made = std::make_unique<MapFile::State>();
                       made->distanceBlocks = blocksOfSection(*table, distance);
                       made->radianceBlocks = blocksOfSection(*table, radiance);
                       made->shareBlocks = blocksOfSection(*table, groupShares);
                       made->distanceWords = field->info.wordsPerProbe;
                       uint64_t radianceBytes = 0;
                       for (const Block& block : made->radianceBlocks) radianceBytes += block.rawBytes;
                       made->radianceWords = radianceBytes / sizeof(uint32_t) / std::max(field->info.probeCount, 1u);
                       made->groups = uint32_t(field->groups.size());
                       for (const Block& block : made->shareBlocks) made->groupBytes += block.rawBytes;
                       made->groupBytes /= std::max(made->groups, 1u);
                       made->reader = std::move(*reader);
                       return FieldAndMaps{std::move(*field), MapFile(std::move(made))};
                   });
}

Result<VerifyReport> verifyField(const std::filesystem::path& file)
{
    return guarded(file, [&] { return verifyChecked(file); });
}

} // namespace sconce
