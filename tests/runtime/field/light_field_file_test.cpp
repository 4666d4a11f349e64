// The .sconce file: what comes back is what was written, and no damage passes unnoticed.
#include "runtime/field/light_field_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "runtime/field/map_blocks.h"
#include "tests/support/small_field.h"

using namespace sconce;
using testing_support::groupedField;
using testing_support::smallField;
namespace fs = std::filesystem;

namespace
{

class LightFieldFile : public testing::Test
{
protected:
    void SetUp() override
    {
        folder = fs::temp_directory_path() /
                 ("sconce_file_" + std::to_string(getpid()) + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder);
        file = folder / "field.sconce";
    }
    void TearDown() override { fs::remove_all(folder); }

    size_t filesInFolder() const { return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator())); }

    fs::path folder, file;
};

std::string readBytes(const fs::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void writeBytes(const fs::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
}

void expectSame(const FieldData& a, const FieldData& b)
{
    ASSERT_EQ(a.groups.size(), b.groups.size());
    for (size_t i = 0; i < a.groups.size(); ++i)
    {
        EXPECT_EQ(a.groups[i].which.name, b.groups[i].which.name);
        EXPECT_EQ(a.groups[i].which.members, b.groups[i].which.members);
        EXPECT_EQ(a.groups[i].sky, b.groups[i].sky);
        EXPECT_EQ(a.groups[i].lamps, b.groups[i].lamps);
        EXPECT_EQ(a.groups[i].radiance, b.groups[i].radiance);
        EXPECT_EQ(a.groups[i].irradiance, b.groups[i].irradiance);
        EXPECT_EQ(a.groups[i].prefiltered, b.groups[i].prefiltered);
        EXPECT_EQ(a.groups[i].surfaceLight, b.groups[i].surfaceLight);
    }
    EXPECT_EQ(std::memcmp(&a.info, &b.info, sizeof(a.info)), 0);
    ASSERT_EQ(a.probes.size(), b.probes.size());
    EXPECT_TRUE(a.probes.empty() || std::memcmp(a.probes.data(), b.probes.data(), a.probes.size() * sizeof(gpu::ProbeHeader)) == 0);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.radiance, b.radiance);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.prefiltered, b.prefiltered);
    EXPECT_EQ(a.patches, b.patches);
    EXPECT_EQ(a.surfaceLight, b.surfaceLight);
    ASSERT_EQ(a.lamps.size(), b.lamps.size());
    EXPECT_TRUE(a.lamps.empty() || std::memcmp(a.lamps.data(), b.lamps.data(), a.lamps.size() * sizeof(gpu::Lamp)) == 0);
    EXPECT_EQ(a.lampMaps, b.lampMaps);
    EXPECT_EQ(a.octree.texels, b.octree.texels);
    EXPECT_EQ(a.octree.boundsHigh, b.octree.boundsHigh);
    EXPECT_EQ(a.octree.voxel, b.octree.voxel);
    EXPECT_EQ(a.octree.topCells, b.octree.topCells);
    EXPECT_EQ(a.octree.topShift, b.octree.topShift);
    EXPECT_EQ(a.octree.bricks, b.octree.bricks);
    EXPECT_EQ(a.octree.marker, b.octree.marker);
    EXPECT_EQ(a.octree.leaves, b.octree.leaves);
    EXPECT_EQ(a.octree.nodes, b.octree.nodes);
    EXPECT_EQ(a.resolution, b.resolution);
    EXPECT_EQ(a.bounces, b.bounces);
    EXPECT_EQ(a.sceneName, b.sceneName);
    EXPECT_EQ(a.effects, b.effects);
}

} // namespace

// The sums of squares written out by hand.
TEST(FieldData, WordsPerProbeFollowTheLevelsOfTheChain)
{
    EXPECT_EQ(coarsestLevel(256), 6u);
    EXPECT_EQ(coarsestLevel(96), 6u); // 6 cells at level 4, two that reach over the border at level 6
    EXPECT_EQ(coarsestLevel(8), 4u);
    EXPECT_EQ(distanceWordsPerProbe(gpu::kChartCube, 256), 6u * (256 * 256 + 64 * 64 + 16 * 16 + 4 * 4 + (64 * 64 + 16 * 16 + 4 * 4) / 2));
    EXPECT_EQ(distanceWordsPerProbe(gpu::kChartCube, 8), 6u * (64 + 4 + 1 + 3)); // five cells' far bounds take three words
    EXPECT_EQ(distanceWordsPerProbe(gpu::kChartOctahedral, 512), 512u * 512 + 32 * 32);
    EXPECT_EQ(radianceWordsPerProbe(gpu::kChartCube, 16), 6u * 256);
    EXPECT_EQ(radianceWordsPerProbe(gpu::kChartOctahedral, 16), 256u);
}

TEST(FieldData, BytesByPartAddUpToWhatIsStored)
{
    for (const uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        const FieldData field = smallField(chart, 16);
        const FieldBytes bytes = bytesByPart(field);
        EXPECT_EQ(bytes.distance + bytes.normals, field.distance.size() * 4);
        EXPECT_EQ(bytes.normals, chart == gpu::kChartOctahedral ? 3u * 16 * 16 * 2 : 0u);
        EXPECT_EQ(bytes.total(), 4 * (field.distance.size() + field.radiance.size() + field.irradiance.size() + field.prefiltered.size() +
                                      field.patches.size() + field.surfaceLight.size() + field.lampMaps.size()) +
                                     field.lamps.size() * 144 + 16 * 4 + 3 * 48);
    }
}

// Maps of several blocks, and several probes to a block.
TEST_F(LightFieldFile, MapsComeProbeByProbe)
{
    for (const auto& [size, probes] : {std::pair{8u, 3u}, {8u, 900u}, {200u, 5u}})
    {
        const FieldData field = smallField(gpu::kChartCube, size, probes);
        ASSERT_TRUE(saveField(field, file));
        auto opened = openField(file);
        ASSERT_TRUE(opened) << opened.error().message;
        EXPECT_TRUE(opened->field.distance.empty() && opened->field.radiance.empty());
        EXPECT_EQ(opened->field.surfaceLight, field.surfaceLight);
        const size_t words = field.info.wordsPerProbe, colors = radianceWordsPerProbe(field.info.chart, size);
        ASSERT_EQ(opened->maps.distanceWords(), words);
        ASSERT_EQ(opened->maps.radianceWords(), colors);
        for (const uint32_t probe : {0u, probes / 2, probes - 1, 1u})
        {
            std::vector<uint32_t> distance(words), radiance(colors);
            const Status status = opened->maps.read(probe, distance, radiance);
            ASSERT_TRUE(status) << status.error().message;
            EXPECT_TRUE(std::equal(distance.begin(), distance.end(), field.distance.begin() + std::ptrdiff_t(probe * words))) << probe;
            EXPECT_TRUE(std::equal(radiance.begin(), radiance.end(), field.radiance.begin() + std::ptrdiff_t(probe * colors))) << probe;
        }
    }
    FieldData blurred = smallField();
    blurred.radiance.clear();
    ASSERT_TRUE(saveField(blurred, file));
    auto opened = openField(file);
    ASSERT_TRUE(opened);
    EXPECT_EQ(opened->maps.radianceWords(), 0u);
    std::vector<uint32_t> distance(opened->maps.distanceWords());
    EXPECT_TRUE(opened->maps.read(2, distance, {}));
}

TEST_F(LightFieldFile, MapsInBlocksComeBackWholeAndProbeByProbe)
{
    FieldData field = smallField(gpu::kChartCube, 16, 5);
    ASSERT_TRUE(putInBlocks(field));
    EXPECT_EQ(bytesByPart(field).distance, 5u * 6u * 4u * (16 * 8 + 16 + 1 + 9)) << "16 blocks, two levels, 17 far bounds";
    EXPECT_EQ(bytesByPart(field).radiance - bytesByPart(field).prefiltered, 5u * 6u * 16u * 16u);
    ASSERT_TRUE(saveField(field, file));
    const Result<FieldData> back = loadField(file);
    ASSERT_TRUE(back) << back.error().message;
    expectSame(*back, field);
    EXPECT_EQ(back->fileVersion, kBlocksFileVersion);
    auto opened = openField(file);
    ASSERT_TRUE(opened) << opened.error().message;
    std::vector<uint32_t> distance(opened->maps.distanceWords()), radiance(opened->maps.radianceWords());
    ASSERT_EQ(radiance.size() * 5, field.radiance.size());
    ASSERT_TRUE(opened->maps.read(3, distance, radiance));
    EXPECT_TRUE(std::ranges::equal(distance, std::span(field.distance).subspan(3 * distance.size(), distance.size())));
    EXPECT_TRUE(std::ranges::equal(radiance, std::span(field.radiance).subspan(3 * radiance.size(), radiance.size())));
}

// Of a probe's radiance, whichever blocks they lie across; the rest of the shares is there at once.
TEST_F(LightFieldFile, SharesOfLightGroupsAreReadProbeByProbe)
{
    for (const auto& [size, probes] : {std::pair{16u, 120u}, {128u, 5u}}) // many probes a block, and one
    {
        FieldData field = smallField(gpu::kChartCube, size, probes);
        for (uint32_t g = 0; g < 3; ++g)
        {
            LightGroup group{{"group " + std::to_string(g), {"desk"}},
                             vec3(0.1f * float(g)),
                             {vec3(1.5f)},
                             field.radiance,
                             field.irradiance,
                             field.prefiltered,
                             field.surfaceLight};
            for (size_t i = 0; i < group.radiance.size(); ++i) group.radiance[i] = uint32_t(977 * i + g);
            group.irradiance[0] = 40 + g;
            field.groups.push_back(std::move(group));
        }
        ASSERT_TRUE(saveField(field, file));
        expectSame(field, *loadField(file));
        auto opened = openField(file);
        ASSERT_TRUE(opened) << opened.error().message;
        const size_t words = opened->maps.distanceWords(), colors = opened->maps.radianceWords();
        ASSERT_EQ(opened->maps.groups(), 3u);
        ASSERT_EQ(probes * colors, field.radiance.size());
        std::vector<uint32_t> distance(words), shares(3 * colors);
        for (const uint32_t probe : {0u, probes - 1, probes / 2, 1u})
        {
            const Status status = opened->maps.readShares(probe, distance, shares);
            ASSERT_TRUE(status) << status.error().message;
            EXPECT_TRUE(std::ranges::equal(distance, std::span(field.distance).subspan(probe * words, words))) << probe;
            for (size_t g = 0; g < 3; ++g)
                EXPECT_TRUE(std::ranges::equal(std::span(shares).subspan(g * colors, colors),
                                               std::span(field.groups[g].radiance).subspan(probe * colors, colors)))
                    << "probe " << probe << ", group " << g;
        }
        for (size_t g = 0; g < 3; ++g)
        {
            EXPECT_TRUE(opened->field.groups[g].radiance.empty());
            EXPECT_EQ(opened->field.groups[g].irradiance, field.groups[g].irradiance);
            EXPECT_EQ(opened->field.groups[g].prefiltered, field.groups[g].prefiltered);
            EXPECT_EQ(opened->field.groups[g].surfaceLight, field.groups[g].surfaceLight);
        }
    }
}

TEST_F(LightFieldFile, OctahedralMapsDoNotStream)
{
    ASSERT_TRUE(saveField(smallField(gpu::kChartOctahedral), file));
    const auto opened = openField(file);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::badArgument);
    EXPECT_NE(opened.error().message.find("can't be read while frames are drawn"), std::string::npos) << opened.error().message;
}

TEST_F(LightFieldFile, RoundTripGivesBackEveryField)
{
    for (const uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
        for (const uint32_t probes : {1u, 3u, 100u})
        {
            const FieldData field = smallField(chart, 16, probes);
            ASSERT_TRUE(saveField(field, file));
            const Result<FieldData> back = loadField(file);
            ASSERT_TRUE(back) << back.error().message;
            expectSame(field, *back);
            EXPECT_EQ(filesInFolder(), 1u);
        }
}

TEST_F(LightFieldFile, WhyProbesStandWhereTheyDoIsKept)
{
    FieldData field = smallField(gpu::kChartCube, 16, 3);
    ASSERT_TRUE(saveField(field, file));
    EXPECT_TRUE(loadField(file)->why.empty()) << "nobody said";
    field.why = {"by hand", "", "free point, \"covers\" 2 % of the surface first"};
    ASSERT_TRUE(saveField(field, file));
    EXPECT_EQ(loadField(file)->why, field.why);
    field.why.pop_back();
    const Status short_ = saveField(field, file);
    ASSERT_FALSE(short_);
    EXPECT_NE(short_.error().message.find("why 2 probes"), std::string::npos) << short_.error().message;
}

TEST_F(LightFieldFile, WhatNoSurfaceCallsForMayBeLeftOut)
{
    for (const bool radiance : {false, true})
    {
        FieldData field = smallField(gpu::kChartCube, 16);
        (radiance ? field.radiance : field.prefiltered).clear();
        ASSERT_TRUE(saveField(field, file));
        const Result<FieldData> back = loadField(file);
        ASSERT_TRUE(back) << back.error().message;
        expectSame(field, *back);
    }
}

TEST_F(LightFieldFile, RoundTripOfAnEmptyField)
{
    FieldData field = smallField(gpu::kChartCube, 8, 1);
    field.info.probeCount = 0;
    field.probes.clear(), field.distance.clear(), field.radiance.clear(), field.irradiance.clear(), field.prefiltered.clear(),
        field.patches.clear(), field.surfaceLight.clear(), field.lamps.clear(), field.lampMaps.clear(), field.octree.texels.clear();
    field.octree.bricks = {0, 0, 0};
    field.effects.clear();
    ASSERT_TRUE(saveField(field, file));
    const Result<FieldData> back = loadField(file);
    ASSERT_TRUE(back) << back.error().message;
    expectSame(field, *back);
}

// 3 probes of 6 * (512^2 + 128^2 + 32^2 + 8^2) words are 20 MB of noise: more than one block, and none that zstd can shrink.
TEST_F(LightFieldFile, RoundTripOfSectionsInSeveralBlocks)
{
    FieldData field = smallField(gpu::kChartCube, 512, 3);
    std::mt19937 random(3);
    for (uint32_t& word : field.distance) word = uint32_t(random());
    ASSERT_TRUE(saveField(field, file));
    const Result<FieldData> back = loadField(file);
    ASSERT_TRUE(back) << back.error().message;
    expectSame(field, *back);
    const Result<VerifyReport> report = verifyField(file);
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->ok());
    EXPECT_TRUE(std::ranges::any_of(report->blocks, [](const BlockReport& b) { return b.name == "distance 1"; }));
}

TEST_F(LightFieldFile, SameFieldGivesSameBytes)
{
    ASSERT_TRUE(saveField(smallField(), file));
    const std::string first = readBytes(file);
    ASSERT_TRUE(saveField(smallField(), folder / "again.sconce"));
    EXPECT_EQ(first, readBytes(folder / "again.sconce"));
}

TEST_F(LightFieldFile, EveryFlippedByteIsNoticed)
{
    ASSERT_TRUE(saveField(smallField(gpu::kChartCube, 8, 1), file));
    const std::string good = readBytes(file);
    ASSERT_LT(good.size(), 8000u);
    for (size_t at = 0; at < good.size(); ++at)
    {
        std::string bad = good;
        bad[at] = char(bad[at] ^ (1 << (at % 8)));
        writeBytes(file, bad);
        const Result<FieldData> field = loadField(file);
        ASSERT_FALSE(field) << "byte " << at;
        EXPECT_EQ(field.error().code, ErrorCode::badInput);
        EXPECT_NE(field.error().message.find("field.sconce"), std::string::npos) << field.error().message;
        const Result<VerifyReport> report = verifyField(file);
        ASSERT_TRUE(report);
        EXPECT_FALSE(report->ok()) << "byte " << at;
    }
}

TEST_F(LightFieldFile, DamageNamesTheBlock)
{
    ASSERT_TRUE(saveField(smallField(), file));
    const Result<VerifyReport> sound = verifyField(file);
    ASSERT_TRUE(sound && sound->ok());
    const std::string good = readBytes(file);
    for (const BlockReport& block : sound->blocks)
    {
        std::string bad = good;
        bad[block.offset + block.storedBytes / 2] ^= 0x10;
        writeBytes(file, bad);
        const Result<VerifyReport> report = verifyField(file);
        ASSERT_TRUE(report);
        for (const BlockReport& row : report->blocks)
        {
            EXPECT_EQ(row.problem.empty(), row.name != block.name) << row.name;
        }
        const Result<FieldData> field = loadField(file);
        ASSERT_FALSE(field);
        EXPECT_NE(field.error().message.find(block.name), std::string::npos) << block.name << ": " << field.error().message;
    }
}

TEST_F(LightFieldFile, EveryTruncationIsRefusedWithASentence)
{
    ASSERT_TRUE(saveField(smallField(gpu::kChartCube, 8, 1), file));
    const std::string good = readBytes(file);
    for (size_t size = 0; size < good.size(); ++size)
    {
        writeBytes(file, good.substr(0, size));
        const Result<FieldData> field = loadField(file);
        ASSERT_FALSE(field) << size;
        EXPECT_EQ(field.error().message.back(), '.');
    }
    writeBytes(file, good + "x");
    EXPECT_FALSE(loadField(file));
}

TEST_F(LightFieldFile, OtherVersionsAreRefusedByName)
{
    for (const uint32_t version : {kOldestFieldFileVersion - 1, kFieldFileVersion + 1})
    {
        ASSERT_TRUE(saveField(smallField(), file));
        std::string bytes = readBytes(file);
        bytes[8] = char(version); // another writer's header, its own checksum right
        const uint64_t sum = XXH3_64bits(bytes.data(), 32);
        std::memcpy(bytes.data() + 32, &sum, 8);
        writeBytes(file, bytes);
        const Result<FieldData> field = loadField(file);
        ASSERT_FALSE(field);
        EXPECT_NE(field.error().message.find("version " + std::to_string(version)), std::string::npos) << field.error().message;
        EXPECT_NE(field.error().message.find(version > kFieldFileVersion ? "newer" : "again"), std::string::npos);
    }
}

// A file of version 2 is one of today's without prefiltered radiance and patches, but for its header's number.
TEST_F(LightFieldFile, AnOlderFileSaysItsOwnVersion)
{
    FieldData field = smallField();
    field.prefiltered.clear();
    field.patches.clear();
    ASSERT_TRUE(saveField(field, file));
    EXPECT_EQ(loadField(file)->fileVersion, kUngroupedFileVersion);
    std::string bytes = readBytes(file);
    bytes[8] = char(kOldestFieldFileVersion);
    const uint64_t sum = XXH3_64bits(bytes.data(), 32);
    std::memcpy(bytes.data() + 32, &sum, 8);
    std::memcpy(bytes.data() + bytes.size() - 16, &sum, 8); // the footer has it again
    writeBytes(file, bytes);
    const Result<FieldData> older = loadField(file);
    ASSERT_TRUE(older) << older.error().message;
    EXPECT_EQ(older->fileVersion, kOldestFieldFileVersion);
}

TEST_F(LightFieldFile, FieldsThatContradictThemselvesAreNotWritten)
{
    FieldData field = smallField();
    field.radiance.pop_back();
    EXPECT_EQ(saveField(field, file).error().code, ErrorCode::badArgument);
    field = smallField();
    field.octree.texels[4] = 3; // probes 0..2
    EXPECT_NE(saveField(field, file).error().message.find("names a probe"), std::string::npos);
    field = smallField();
    field.octree.texels[0] = 2; // bricks 0..1
    EXPECT_NE(saveField(field, file).error().message.find("outside"), std::string::npos);
    field = smallField();
    field.octree.texels[4 * 2] = 1, field.octree.texels[4 * 2 + 1] = 0, field.octree.texels[4 * 2 + 2] = 0; // brick 1 points to itself
    field.octree.texels[4 * 2 + 3] = 255;
    EXPECT_NE(saveField(field, file).error().message.find("below the finest"), std::string::npos);
    field = smallField();
    field.surfaceLight[7] = gpu::kRefinedWord + 2; // of 0 and 1
    EXPECT_NE(saveField(field, file).error().message.find("texel 7 of its surface light names finer ones"), std::string::npos);
    field = smallField();
    field.info.refinedTexels = 3; // the words of two are there
    EXPECT_NE(saveField(field, file).error().message.find("'surface light' has"), std::string::npos);
    field = smallField();
    field.info.hidden = 3; // voxels, but no slots
    EXPECT_NE(saveField(field, file).error().message.find("no slots"), std::string::npos);
    field = smallField();
    field.lamps[0].size = 72; // its blocks of blocks would not be whole
    EXPECT_NE(saveField(field, file).error().message.find("map of lamp 0 has an impossible size"), std::string::npos);
    field = smallField();
    field.lamps[0].firstWord = 0;
    EXPECT_NE(saveField(field, file).error().message.find("map of lamp 0 is not where it belongs"), std::string::npos);
    field = smallField();
    field.lamps[0].centre.z = std::numeric_limits<float>::infinity();
    EXPECT_NE(saveField(field, file).error().message.find("lamp 0 holds a number"), std::string::npos);
    field = smallField();
    field.lampMaps.pop_back();
    EXPECT_NE(saveField(field, file).error().message.find("maps have another size"), std::string::npos);
    field = smallField();
    field.lamps.resize(gpu::kMostLamps + 1);
    EXPECT_NE(saveField(field, file).error().message.find("5 lamps, above 4"), std::string::npos);
    field = smallField();
    field.info.topShift = 2;
    EXPECT_NE(saveField(field, file).error().message.find("disagrees"), std::string::npos);
    field = smallField();
    field.probes[1].centre.y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(saveField(field, file).error().message.find("probe 1"), std::string::npos);
    EXPECT_EQ(filesInFolder(), 0u);
}

// Numbers that are finite and still make others that are not, and grids that a look-up would leave.
TEST_F(LightFieldFile, PlacesBeyondAnySceneAreRefused)
{
    const auto refusal = [&](const auto& change)
    {
        FieldData field = smallField();
        change(field);
        const Status saved = saveField(field, file);
        return saved ? "" : saved.error().message;
    };
    EXPECT_EQ(refusal([](FieldData& field) { field.probes[2].centre.x = 1e6f; }), "");
    EXPECT_NE(refusal([](FieldData& field) { field.probes[2].centre.x = 1.1e6f; }).find("probe 2"), std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.probes[0].harmonic = 1e38f; }).find("probe 0"), std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.probes[0].influenceHigh.z = std::numeric_limits<float>::quiet_NaN(); }).find("probe 0"),
              std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.info.sceneHigh.y = 1e38f; }).find("bounds"), std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.info.diagonal = -1.0f; }).find("negative"), std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.info.voxel = field.octree.voxel = 1e38f; }).find("voxel"), std::string::npos);
    EXPECT_EQ(refusal([](FieldData& field) { field.info.gridX = 3, field.info.gridY = field.info.gridZ = 1; }), "");
    EXPECT_NE(refusal([](FieldData& field) { field.info.gridX = 2, field.info.gridY = field.info.gridZ = 1; }).find("2x1x1"),
              std::string::npos);
    EXPECT_NE(refusal(
                  [](FieldData& field)
                  {
                      field.info.gridX = field.info.gridY = 1u << 31; // 2^64 times 3 is 0 of 64 bits
                      field.info.gridZ = 4 * 3;
                  })
                  .find("grid of"),
              std::string::npos);
}

// A field without groups has not a byte of them: neither a section nor a line.
TEST_F(LightFieldFile, LightGroupsComeBackAndAreNoPartOfOtherFields)
{
    const FieldData grouped = groupedField();
    ASSERT_TRUE(saveField(grouped, file));
    const Result<FieldData> back = loadField(file);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->fileVersion, kGroupedFileVersion);
    expectSame(grouped, *back);
    const Result<VerifyReport> report = verifyField(file);
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->ok());
    EXPECT_EQ(report->blocks[report->blocks.size() - 2].name, "light groups 0");
    FieldData plain = grouped;
    plain.groups.clear();
    ASSERT_TRUE(saveField(plain, file));
    EXPECT_EQ(readBytes(file).find("groups"), std::string::npos);
    EXPECT_EQ(loadField(file)->fileVersion, kUngroupedFileVersion);
    const Result<VerifyReport> without = verifyField(file);
    for (const BlockReport& block : without->blocks) EXPECT_EQ(block.name.find("groups"), std::string::npos);
}

TEST_F(LightFieldFile, LightGroupsThatAreNotTheFieldsAreNotWritten)
{
    const auto refusal = [&](const auto& change)
    {
        FieldData field = groupedField();
        change(field);
        return saveField(field, file).error().message;
    };
    EXPECT_NE(
        refusal([](FieldData& field) { field.groups.resize(kMostLightGroups + 1, field.groups[0]); }).find("17 light groups, above 16"),
        std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.groups[1].irradiance.pop_back(); }).find("group 'lamps' have another size"),
              std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.groups[1].lamps.clear(); }).find("lamps of light group 'lamps'"), std::string::npos);
    EXPECT_NE(refusal([](FieldData& field) { field.groups[0].sky.y = std::numeric_limits<float>::quiet_NaN(); }).find("group 'sun'"),
              std::string::npos);
    EXPECT_NE(
        refusal([](FieldData& field) { field.groups[0].surfaceLight[5] = gpu::kRefinedWord + 1; }).find("texel 5 of light group 'sun'"),
        std::string::npos);
    EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(LightFieldFile, MissingAndMisusedPathsGiveSentences)
{
    EXPECT_EQ(loadField(folder / "none.sconce").error().code, ErrorCode::fileError);
    EXPECT_EQ(loadField(folder).error().code, ErrorCode::fileError);
    EXPECT_EQ(verifyField(folder / "none.sconce").error().code, ErrorCode::fileError);
    EXPECT_EQ(saveField(smallField(), folder / "no_such_folder" / "a.sconce").error().code, ErrorCode::fileError);
    EXPECT_EQ(saveField(smallField(), folder).error().code, ErrorCode::fileError);
}

// A full disk, as a file size limit: the write fails half-way.
TEST_F(LightFieldFile, FailedWriteLeavesTheOldFileAndNoRubbish)
{
    ASSERT_TRUE(saveField(smallField(), file));
    const std::string old = readBytes(file);
    EXPECT_EXIT(
        {
            signal(SIGXFSZ, SIG_IGN);
            rlimit limit;
            limit.rlim_cur = limit.rlim_max = 4096;
            setrlimit(RLIMIT_FSIZE, &limit);
            FieldData big = smallField(gpu::kChartCube, 64, 3);
            std::mt19937 random(1);
            for (uint32_t& word : big.distance) word = uint32_t(random());
            const Status status = saveField(big, file);
            _exit(!status && status.error().code == ErrorCode::fileError ? 7 : 1);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(readBytes(file), old);
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(LightFieldFile, UnwritableFolderLeavesTheOldFile)
{
    ASSERT_TRUE(saveField(smallField(), file));
    const std::string old = readBytes(file);
    ASSERT_EQ(chmod(folder.c_str(), 0555), 0);
    EXPECT_EXIT(
        {
            if (geteuid() == 0 && seteuid(65534) != 0) _exit(3); // root ignores the mode
            const Status status = saveField(smallField(gpu::kChartCube, 16), file);
            _exit(!status && status.error().code == ErrorCode::fileError ? 7 : 1);
        },
        testing::ExitedWithCode(7), "");
    ASSERT_EQ(chmod(folder.c_str(), 0755), 0);
    EXPECT_EQ(readBytes(file), old);
    EXPECT_EQ(filesInFolder(), 1u);
}
