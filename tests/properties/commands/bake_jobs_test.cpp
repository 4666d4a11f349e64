// Bakes that are stopped, damaged, doubled or shared out, from the command line.
#include <algorithm>
#include <filesystem>

#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "runtime/bake/bake_journal.h"
#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using Arguments = std::vector<std::string>;

/// A small bake, and the bytes of its file where nothing disturbs it.
class BakeJobs : public testing::Test
{
protected:
    BakeJobs()
    {
        writeText(folder / "p.json", R"({"scene": "cornell", "method": "sdf", "probes": [
            {"position": [0, 1, 0]}, {"position": [0.5, 1.5, 0.3]}, {"position": [-0.5, 0.4, 0.6]},
            {"position": [0.6, 0.5, -0.2]}, {"position": [-0.6, 1.6, -0.5]}]})");
        writeText(folder / "coarse.json", R"({"quality": 1, "settings": {"octree voxels": 32}})");
    }
    Arguments bake(const std::string& output, const Arguments& more = {}) const
    {
        Arguments all{"bake", "cornell",        "--probes", folder / "p.json", "--quality", folder / "coarse.json", "--resolution",
                      "64",   "--surface-rays", "4",        "--bounces",       "1",         "--surface-refined",    "0",
                      "-o",   folder / output};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Of a file that a command that must succeed writes.
    std::string bytesBy(const Arguments& arguments, const std::string& output, const std::string& noted = {}) const
    {
        const CommandResult result = sconceCommand(arguments);
        EXPECT_EQ(result.exit, 0) << result.err;
        EXPECT_NE(result.err.find(noted), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(journalOf(output))) << "all that it has is in the output";
        return result.exit == 0 ? readText(folder / output) : "";
    }
    std::string journalOf(const std::string& output) const { return folder / fmt::format(".{}.journal", output); }
    std::string whole() const { return bytesBy(bake("whole", {"--no-journal"}), "whole"); }
    /// Refused with a sentence that has these words.
    static void expectRefused(const Arguments& arguments, int exit, const std::string& words)
    {
        const CommandResult result = sconceCommand(arguments);
        EXPECT_EQ(result.exit, exit) << result.err;
        EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    }
    std::string shard(uint32_t index, uint32_t count, const std::string& output, const Arguments& more = {}) const
    {
        Arguments all = bake(output, {"--shard", fmt::format("{}/{}", index, count)});
        all.insert(all.end(), more.begin(), more.end());
        bytesBy(all, output);
        return folder / output;
    }
    Arguments merge(const Arguments& parts, const std::string& output) const
    {
        Arguments all{"merge", "-o", folder / output};
        all.insert(all.end(), parts.begin(), parts.end());
        return all;
    }
    const TestFolder folder;
};

TEST_F(BakeJobs, AnInterruptedBakeGoesOnToTheSameBytes)
{
    const std::string undisturbed = whole();
    const CommandResult stopped = sconceCommand(bake("f"), {.interruptWhen = "surface light: "});
    EXPECT_EQ(stopped.exit, 130) << stopped.err;
    EXPECT_NE(stopped.err.find("the same command goes on from there"), std::string::npos) << stopped.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "f"));
    const std::string journal = readText(journalOf("f"));

    // Of other settings it isn't used, and of --resume not even overwritten.
    expectRefused(bake("f", {"--converged", "0.5", "--resume"}), 3, "is of another scene, other probes or settings");
    EXPECT_EQ(readText(journalOf("f")), journal);
    bytesBy(bake("f", {"--converged", "0.5"}), "f", "begins anew");

    // Nor is what is damaged: what stands before it is.
    for (const size_t cut : {journal.size() - 1, journal.size() / 2, size_t(1)})
    {
        writeText(journalOf("f"), journal.substr(0, cut));
        EXPECT_EQ(bytesBy(bake("f"), "f", cut == 1 ? "begins anew" : "is cut off or damaged after its record"), undisturbed) << cut;
    }
    std::string flipped = journal;
    flipped[journal.size() / 3] = char(flipped[journal.size() / 3] ^ 16);
    writeText(journalOf("f"), flipped);
    EXPECT_EQ(bytesBy(bake("f", {"--resume"}), "f", "is cut off or damaged after its record"), undisturbed);

    writeText(journalOf("f"), journal);
    EXPECT_EQ(bytesBy(bake("f", {"--resume"}), "f", "goes on from the journal"), undisturbed);
    expectRefused(bake("f", {"--resume"}), 3, "There is no journal");
    expectRefused(bake("f", {"--resume", "--no-journal"}), 2, "--no-journal");
}

TEST_F(BakeJobs, TheSecondBakerOfAnOutputIsRefused)
{
    const auto first = JournalFile::open(journalOf("f"), {.build = 1});
    ASSERT_TRUE(first) << first.error().message;
    expectRefused(bake("f"), 5, "process " + std::to_string(getpid()));
    EXPECT_FALSE(std::filesystem::exists(folder / "f"));
    expectRefused(bake("none/f"), 5, "none/.f.journal");
}

TEST_F(BakeJobs, ACaptureIsKeptToo)
{
    const Arguments capture{"capture",
                            "cornell",
                            "--probes",
                            folder / "p.json",
                            "--quality",
                            folder / "coarse.json",
                            "--resolution",
                            "64",
                            "--surface-rays",
                            "8",
                            "--live-links",
                            "8",
                            "-o",
                            folder / "f"};
    const std::string undisturbed = bytesBy(capture, "f");
    std::filesystem::remove(folder / "f");
    const CommandResult stopped = sconceCommand(capture, {.interruptWhen = "light group 'rest': surface light"});
    EXPECT_EQ(stopped.exit, 130) << stopped.err;
    EXPECT_EQ(bytesBy(capture, "f", "goes on from the journal"), undisturbed);
}

TEST_F(BakeJobs, ShardsInAnyOrderMergeToTheWhole)
{
    const std::string undisturbed = whole();
    for (const uint32_t count : {1u, 2u, 3u, 7u})
    {
        Arguments parts;
        for (uint32_t i = 0; i < count; ++i) parts.push_back(shard(i, count, fmt::format("part{}", i)));
        std::ranges::rotate(parts, parts.begin() + count / 2);
        EXPECT_EQ(bytesBy(merge(parts, "merged"), "merged"), undisturbed) << count;
    }
}

TEST_F(BakeJobs, WhatIsGatheredIsSharedOutAfterTheMaps)
{
    const std::string undisturbed = whole();
    const Arguments maps{shard(1, 2, "m1"), shard(0, 2, "m0")};
    Arguments parts = maps;
    for (uint32_t i = 0; i < 3; ++i) parts.push_back(shard(i, 3, fmt::format("g{}", i), {"--after", maps[0], maps[1]}));
    expectRefused(merge({maps[0], maps[1], parts[2], parts[4]}, "f"), 3, "what is gathered 1 of 3 shards is missing: 1/3");
    std::ranges::reverse(parts);
    EXPECT_EQ(bytesBy(merge(parts, "f"), "f"), undisturbed);
    expectRefused(bake("f", {"--shard", "0/2", "--after", maps[0]}), 3, "Of the maps 1 of 2 shards is missing: 0/2");
    expectRefused(bake("f", {"--after", maps[0]}), 2, "--shard");
}

TEST_F(BakeJobs, PartsThatAreNotOfOneBakeAreRefused)
{
    const std::string zero = shard(0, 2, "p0"), one = shard(1, 2, "p1"), third = shard(2, 3, "third"),
                      other = shard(1, 2, "other", {"--converged", "0.5"});
    expectRefused(merge({one}, "f"), 3, "1 of 2 shards is missing: 0/2");
    expectRefused(merge({one, zero, one}, "f"), 3, "are both shard 1/2");
    expectRefused(merge({zero, third}, "f"), 3, "one division");
    expectRefused(merge({zero, other}, "f"), 3, "other'");
    expectRefused(merge({zero, folder / "none"}, "f"), 5, "none'");
    expectRefused(merge({zero, folder / "p.json"}, "f"), 3, "is no part of a bake");
    const std::string bytes = readText(one);
    writeText(folder / "cut", bytes.substr(0, bytes.size() - 40)); // between two records
    expectRefused(merge({zero, folder / "cut"}, "f"), 3, "is cut off");
    {
        auto made = JournalFile::open(folder / "j", {.build = 1, .content = 2, .probes = 5, .shard = 0, .shards = 1});
        ASSERT_TRUE(made && made->commitAs(folder / "strange"));
    }
    expectRefused(merge({folder / "strange"}, "f"), 3, "another build of this program");
    // The scene's light, or the probes, have changed since.
    writeText(folder / "p.json", R"({"scene": "cornell", "method": "sdf", "probes": [{"position": [0, 1, 0]}]})");
    expectRefused(merge({zero, one}, "f"), 3, "than this bake");
    EXPECT_FALSE(std::filesystem::exists(folder / "f"));
}

TEST_F(BakeJobs, ShardsThatCannotBeAreRefused)
{
    for (const char* text : {"0/0", "0/4097", "2/2", "5/2", "-1/2", "1", "x/2", "1/2/3", "/", "1/"})
        expectRefused(bake("f", {"--shard", text}), 2, "--shard: ");
    expectRefused(bake("f", {"--shard", "0/2", "--no-journal"}), 2, "--no-journal");
    expectRefused(bake("f", {"--shard", "0/2", "--chart", "octahedral"}), 2, "octahedral");
    EXPECT_FALSE(std::filesystem::exists(folder / "f"));
}

} // namespace
} // namespace sconce
