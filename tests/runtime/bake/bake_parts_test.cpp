// Bakes that go on with what an earlier one kept, or several did, give the bytes of one that wasn't disturbed.
#include "runtime/bake/bake_parts.h"

#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field_file.h"
#include "scene/builtin_scenes.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::readText;
using testing_support::TestFolder;

/// In memory; refuses to keep more than so many parts, as a full disk does.
class Memory : public BakeJournal
{
public:
    std::optional<std::vector<std::byte>> find(const BakePart& part) const override
    {
        const auto found = parts.find(part);
        if (found == parts.end()) return std::nullopt;
        ++reads;
        return found->second;
    }
    Status keep(const BakePart& part, Pieces pieces) override
    {
        if (room == 0) return Error{ErrorCode::fileError, "full"};
        --room;
        std::vector<std::byte>& all = parts[part];
        all.clear();
        for (const auto piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
        return success();
    }
    size_t count(BakeStage stage) const
    {
        size_t found = 0;
        for (const auto& [part, bytes] : parts) found += part.stage == stage;
        return found;
    }
    std::map<BakePart, std::vector<std::byte>> parts;
    size_t room = 1000000;
    mutable size_t reads = 0;
};

class PartBake : public testing::Test
{
protected:
    PartBake()
    {
        settings.resolution = 64;
        settings.bounces = 1;
        settings.surfaceRefined = 0.0f;
        settings.surfaceTexels = 26;
        settings.surfaceRays = 4;
        settings.octree.voxels = 16;
        settings.rays = &rays;
    }
    std::string bytesOfField(const Result<FieldData>& field)
    {
        if (!field) throw std::runtime_error(field.error().message);
        const Status saved = saveField(*field, folder / "f");
        if (!saved) throw std::runtime_error(saved.error().message);
        return readText(folder / "f");
    }
    Result<FieldData> bake(BakeJournal* journal)
    {
        settings.journal = journal;
        return bakeLightField(device.gpu(), scene, probes, settings, {}, report);
    }
    Result<FieldData> bakeGroups(BakeJournal* journal)
    {
        settings.journal = journal;
        settings.liveLinks = 8;
        settings.surfaceRays = 8;
        return bakeLightGroups(device.gpu(), scene, probes, settings, {}, {}, report);
    }
    const TestFolder folder;
    testing_support::SharedDevice device;
    const Scene scene = *makeBuiltinScene("cornell");
    const TriangleRays rays = std::move(*TriangleRays::build(scene));
    const std::vector<vec3> probes{vec3(0.0f, 1.0f, 0.0f), vec3(0.5f, 1.5f, 0.3f), vec3(-0.5f, 0.4f, 0.6f)};
    BakeSettings settings;
    BakeReport report;
};

TEST_F(PartBake, GoesOnFromAnyPointToTheSameBytes)
{
    const std::string whole = bytesOfField(bake(nullptr));
    Memory all;
    EXPECT_EQ(bytesOfField(bake(&all)), whole) << "keeping changes nothing";
    EXPECT_EQ(all.count(BakeStage::maps), 3u);
    EXPECT_EQ(all.count(BakeStage::octree), 1u);
    EXPECT_EQ(all.count(BakeStage::cells), 1u);
    EXPECT_EQ(all.count(BakeStage::gather), 3u);
    for (size_t room = 0; room < all.parts.size(); room += 2) // within each stage, and between two
    {
        Memory full;
        full.room = room;
        const auto stopped = bake(&full);
        ASSERT_FALSE(stopped) << room;
        EXPECT_EQ(stopped.error().code, ErrorCode::fileError);
        EXPECT_EQ(full.parts.size(), room) << "nothing is kept twice";
        full.room = 1000000;
        EXPECT_EQ(bytesOfField(bake(&full)), whole) << room;
        EXPECT_EQ(full.reads, room) << "all that was kept is used";
        EXPECT_EQ(full.parts, all.parts);
    }
}

TEST_F(PartBake, OctahedralMapsAndRaysThroughTheFieldAreKeptAlike)
{
    settings.rays = nullptr;
    for (const uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        settings.chart = chart;
        const std::string whole = bytesOfField(bake(nullptr));
        Memory all;
        EXPECT_EQ(bytesOfField(bake(&all)), whole);
        EXPECT_EQ(all.count(BakeStage::gather), chart == gpu::kChartCube ? 3u : 0u);
        all.reads = 0;
        EXPECT_EQ(bytesOfField(bake(&all)), whole);
        EXPECT_EQ(all.reads, all.parts.size());
    }
}

TEST_F(PartBake, GroupsAndLinksAreKeptApart)
{
    const std::string whole = bytesOfField(bakeGroups(nullptr));
    Memory all;
    EXPECT_EQ(bytesOfField(bakeGroups(&all)), whole);
    EXPECT_EQ(all.count(BakeStage::maps), 6u) << "of all light, and of the group";
    all.reads = 0;
    EXPECT_EQ(bytesOfField(bakeGroups(&all)), whole);
    EXPECT_EQ(all.reads, all.parts.size());
}

TEST_F(PartBake, APartOfAnotherLengthIsBakedAnew)
{
    const std::string whole = bytesOfField(bake(nullptr));
    Memory all;
    bytesOfField(bake(&all));
    Memory cut = all;
    for (auto& [part, bytes] : cut.parts) bytes.pop_back();
    EXPECT_EQ(bytesOfField(bake(&cut)), whole);
    EXPECT_EQ(cut.parts, all.parts);
}

TEST_F(PartBake, ShardsInAnyOrderAreTheWhole)
{
    const std::string whole = bytesOfField(bake(nullptr));
    for (const uint32_t count : {2u, 7u}) // the command's test has all of 1, 2, 3, 7
    {
        Memory merged;
        for (const BakeStage stage : {BakeStage::maps, BakeStage::gather})
            for (uint32_t i = count; i-- > 0;)
            {
                settings.journal = &merged;
                const size_t before = merged.count(stage);
                const BakeShard shard{i, count, stage};
                const Status done = bakeShard(device.gpu(), scene, probes, settings, shard, {}, report);
                ASSERT_TRUE(done) << done.error().message;
                size_t own = 0;
                for (size_t probe = 0; probe < probes.size(); ++probe) own += shard.has(probe);
                EXPECT_EQ(merged.count(stage), before + own) << i << " of " << count;
            }
        const size_t parts = merged.parts.size();
        EXPECT_EQ(bytesOfField(bake(&merged)), whole) << count;
        EXPECT_EQ(merged.parts.size(), parts) << "nothing was left to do";
    }
}

TEST_F(PartBake, ShardsOfGroupsAreTheWhole)
{
    const std::string whole = bytesOfField(bakeGroups(nullptr));
    Memory merged;
    settings.journal = &merged;
    for (const BakeStage stage : {BakeStage::maps, BakeStage::gather})
        for (uint32_t i = 0; i < 2; ++i)
        {
            const Status done = bakeGroupShard(device.gpu(), scene, probes, settings, {}, {i, 2, stage}, {}, report);
            ASSERT_TRUE(done) << done.error().message;
        }
    const size_t parts = merged.parts.size();
    EXPECT_EQ(bytesOfField(bakeGroups(&merged)), whole);
    EXPECT_EQ(merged.parts.size(), parts) << "nothing was left to do";
}

TEST_F(PartBake, ShardsThatCannotBeAreRefused)
{
    Memory journal;
    const auto code = [&](const BakeShard& shard)
    {
        const Status done = bakeShard(device.gpu(), scene, probes, settings, shard, {}, report);
        return done ? std::nullopt : std::optional(done.error().code);
    };
    EXPECT_EQ(code({0, 1, BakeStage::maps}), ErrorCode::badArgument) << "no journal";
    settings.journal = &journal;
    EXPECT_EQ(code({0, 0, BakeStage::maps}), ErrorCode::badArgument);
    EXPECT_EQ(code({2, 2, BakeStage::maps}), ErrorCode::badArgument);
    EXPECT_EQ(code({0, kMostShards + 1, BakeStage::maps}), ErrorCode::badArgument);
    EXPECT_EQ(code({0, 1, BakeStage::octree}), ErrorCode::badArgument);
    EXPECT_EQ(code({0, 2, BakeStage::gather}), ErrorCode::badInput) << "no maps";
    EXPECT_EQ(code({0, 2, BakeStage::maps}), std::nullopt);
    EXPECT_EQ(code({0, 2, BakeStage::gather}), ErrorCode::badInput) << "half of the maps";
}

} // namespace
} // namespace sconce
