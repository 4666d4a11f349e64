// Every call of a command for its files fails, one at a time: it says so and ends with the exit code of files, what stood there before is
// whole, and nothing is left beside it. The same where its device is lost, or has no memory left.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/environment.h"
#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using Arguments = std::vector<std::string>;

/// A kind of call, as tests/support/failing_files.cpp names it, and the errno that it fails with.
struct FileFault
{
    const char* kind;
    int error;
    bool goesOn = false; // all is done that was asked for
};

/// A closed corridor as glTF: a scene of few cells.
void writeCorridor(const std::filesystem::path& folder)
{
    std::string bytes;
    const auto add = [&](const auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (int corner = 0; corner < 8; ++corner)
        add(corner & 1 ? 2.0f : -2.0f), add(corner & 2 ? 0.4f : 0.0f), add(corner & 4 ? 0.2f : -0.2f);
    for (const int corner : {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 4, 2, 6, 1, 5, 3, 5, 7, 3, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6})
        add(uint16_t(corner)); // seen from within
    writeText(folder / "corridor.bin", bytes);
    writeText(folder / "corridor.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "buffers": [{"uri": "corridor.bin", "byteLength": 168}],
        "bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-2, 0, -0.2], "max": [2, 0.4, 0.2]},
                      {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}]})");
}

class CommandFaults : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        inputs = new TestFolder;
        writeText(*inputs / "p.json", R"({"scene": "cornell", "method": "sdf", "probes": [{"position": [0, 1, 0]}]})");
        writeText(*inputs / "coarse.json", R"({"quality": 1, "settings": {"octree voxels": 16}})");
        writeText(*inputs / "rays.csv", "ox,oy,oz,dx,dy,dz\n0,1,0,1,0,0\n0,1,0,0,0.6,0.8\n");
        writeCorridor(inputs->path);
        const CommandResult baked = sconceCommand(bake(*inputs, {"--live-links", "8"}));
        ASSERT_EQ(baked.exit, 0) << baked.err;
    }
    static void TearDownTestSuite() { delete std::exchange(inputs, nullptr); }

    static Arguments bake(const TestFolder& in, const Arguments& more = {})
    {
        Arguments all{"bake",         "cornell", "--probes",          in / "p.json", "--quality",        in / "coarse.json",
                      "--resolution", "64",      "--surface-rays",    "8",           "--surface-texels", "26",
                      "--bounces",    "1",       "--surface-refined", "0",
                      "--submission", // in which all fits: which call is the n-th must not hang on how fast the machine is
                      "60000",        "-o",      in / "f.sconce"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    using Command = std::function<Arguments(const TestFolder&)>;

    /// What loads before a command, and what it is told.
    struct Fault
    {
        const char *library, *variable;
        std::string told;
    };
    static Fault ofFiles(const FileFault& fault, int n, const TestFolder& folder)
    {
        return {SCONCE_FAILING_FILES, "SCONCE_FILE_FAULT", fmt::format("{}:{}:{}:{}", fault.kind, n, fault.error, folder.path.string())};
    }
    static Fault ofVulkan(const char* told) { return {SCONCE_FAILING_VULKAN, "SCONCE_VULKAN_FAULT", told}; }

    static CommandResult run(const Arguments& arguments, const Fault& fault)
    {
        const char* options = std::getenv("ASAN_OPTIONS");
        // A sanitizer would be loaded first; that it isn't does no harm here.
        const Variable asan("ASAN_OPTIONS", fmt::format("{}:verify_asan_link_order=0", options ? options : "")),
            loaded("LD_PRELOAD", fault.library), told(fault.variable, fault.told);
        return sconceCommand(arguments);
    }

    /// A folder for a command, with copies of all inputs, and something that stands where it writes.
    struct Place
    {
        TestFolder folder;
        std::string output;

        explicit Place(const char* outputName) : output(folder / outputName)
        {
            std::filesystem::copy(inputs->path, folder.path);
            writeText(output, kBefore);
        }
        std::string written() const { return readText(output); }
        std::filesystem::path journal() const
        {
            return folder / fmt::format(".{}.journal", std::filesystem::path(output).filename().string());
        }
        /// Names of files beside the inputs, the output and its journal.
        std::string rubbish() const
        {
            std::string names;
            for (const auto& entry : std::filesystem::directory_iterator(folder.path))
                if (const auto& path = entry.path();
                    !std::filesystem::exists(inputs->path / path.filename()) && path != output && path != journal())
                    names += path.filename().string() + " ";
            return names;
        }
    };

    /// @param result  of a command one of whose files failed
    static void expectRefused(const CommandResult& result, const Place& place, const FileFault& fault)
    {
        const bool read = std::string_view(fault.kind) == "read" || std::string_view(fault.kind) == "open";
        EXPECT_TRUE(result.exit == 5 || (read && result.exit == 3)) << result.exit;
        EXPECT_NE(result.err.find("sconce: "), std::string::npos) << "a sentence";
        EXPECT_NE(result.err.find(place.folder.path.string()), std::string::npos) << "that names the file";
        EXPECT_TRUE(read || result.err.find(std::strerror(fault.error)) != std::string::npos) << "and the reason";
        EXPECT_TRUE(place.written() == kBefore);
        EXPECT_EQ(place.rubbish(), "");
    }
    static void expectDone(const CommandResult& result, const Place& place, const std::string& whole)
    {
        EXPECT_EQ(result.exit, 0);
        EXPECT_TRUE(place.written() == whole) << "another file";
        EXPECT_EQ(place.rubbish(), "");
        EXPECT_FALSE(std::filesystem::exists(place.journal()));
    }
    /// Calls of a kind that a command made.
    static int callsIn(const CommandResult& result, const char* kind)
    {
        const std::string told = fmt::format("calls: {} ", kind);
        const size_t at = result.err.find(told);
        EXPECT_NE(at, std::string::npos) << result.err;
        return at == std::string::npos ? 0 : std::atoi(result.err.c_str() + at + told.size());
    }

    /// The n-th call of each kind fails, for every n.
    /// @param again  run the same command after every so many of them, where it finds more than what stood there before; 0: never
    static void failEach(const Command& command, const char* output, std::span<const FileFault> faults, int again = 0)
    {
        const Place undisturbed(output);
        const CommandResult counted = run(command(undisturbed.folder), ofFiles({"none", 0}, 0, undisturbed.folder));
        ASSERT_EQ(counted.exit, 0) << counted.err;
        const std::string right = undisturbed.written();
        ASSERT_NE(right, kBefore);
        for (const FileFault& fault : faults)
        {
            const int count = callsIn(counted, fault.kind);
            EXPECT_GT(count, 0) << "there is no call of the kind " << fault.kind;
            for (int n = 1; n <= count && !HasFailure(); ++n)
            {
                const Place place(output);
                const CommandResult result = run(command(place.folder), ofFiles(fault, n, place.folder));
                SCOPED_TRACE(fmt::format("{} {}: {}\n{}", fault.kind, n, std::strerror(fault.error), result.err));
                if (fault.goesOn)
                    expectDone(result, place, right);
                else
                    expectRefused(result, place, fault);
                if (again > 0 && n % again == 0) expectDone(sconceCommand(command(place.folder)), place, right);
            }
            fmt::print("{} {}: {}\n", count, fault.kind, std::strerror(fault.error));
        }
    }

    static constexpr const char* kBefore = "what stood here before";
    static TestFolder* inputs;
};
TestFolder* CommandFaults::inputs = nullptr;

// What can't be done for the folder of a file that is whole is let go.
constexpr FileFault kOpen{"open", EMFILE}, kRead{"read", EIO}, kWrite{"write", ENOSPC}, kSync{"sync", EIO}, kClose{"close", EIO},
    kRename{"rename", EACCES}, kFolder{"folder", EIO, true}, kInterrupted{"write", EINTR, true}, kResize{"resize", EIO};

Arguments place(const TestFolder& folder)
{
    return {"place", folder / "corridor.gltf", "--grid", "1x1x1", "-o", folder / "placed.json"};
}
Arguments trace(const TestFolder& folder)
{
    return {"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "--cpu", "-o", folder / "hits.csv"};
}
Arguments relight(const TestFolder& folder)
{
    return {"relight", folder / "f.sconce", "--dim", "rest=2", "-o", folder / "other.sconce"};
}
Arguments render(const TestFolder& folder)
{
    return {"render", "cornell", "--field", folder / "f.sconce", "--size", "16x16", "-o", folder / "f.exr"};
}

TEST_F(CommandFaults, OfPlace)
{
    const FileFault faults[] = {kOpen, kRead, kWrite, kSync, kRename};
    failEach(place, "placed.json", faults);
}

TEST_F(CommandFaults, OfTrace)
{
    const FileFault faults[] = {kOpen, kRead, kWrite, kInterrupted, kSync, kClose, kRename, kFolder};
    failEach(trace, "hits.csv", faults);
}

TEST_F(CommandFaults, OfRelight)
{
    const FileFault faults[] = {kOpen, kWrite, kSync, kRename};
    failEach(relight, "other.sconce", faults);
}

TEST_F(CommandFaults, OfRender)
{
    const FileFault faults[] = {kOpen, kWrite, kSync, kRename};
    failEach(render, "f.exr", faults);
}

// What a bake had finished is in its journal: the same command goes on from there.
TEST_F(CommandFaults, OfBake)
{
    const FileFault faults[] = {kOpen, kRead, kResize, kWrite, kSync, kRename};
    failEach([](const TestFolder& folder) { return bake(folder); }, "f.sconce", faults, 4);
}

TEST_F(CommandFaults, HalfOfAWriteIsGoneOnWith)
{
    const Place undisturbed("f.sconce"), place("f.sconce");
    ASSERT_EQ(sconceCommand(bake(undisturbed.folder)).exit, 0);
    expectDone(run(bake(place.folder), ofFiles({"short", 0}, 0, place.folder)), place, undisturbed.written());
}

// A journal that can't be read now may be read later: it stays.
TEST_F(CommandFaults, ABakeKeepsAJournalThatItCannotRead)
{
    const Place place("f.sconce");
    const FileFault full{"write", ENOSPC};
    const CommandResult stopped = run(bake(place.folder), ofFiles(full, 30, place.folder));
    ASSERT_EQ(stopped.exit, 5) << stopped.err;
    const std::string journal = readText(place.journal());
    ASSERT_GT(journal.size(), 100000u) << "something is finished";
    int n = 1;
    CommandResult result;
    for (; n < 100; ++n)
    {
        result = run(bake(place.folder),
                     {SCONCE_FAILING_FILES, "SCONCE_FILE_FAULT", fmt::format("read:{}:{}:{}", n, EIO, place.journal().string())});
        if (result.exit == 0) break; // it was there by then: a part that can't be read when it is asked for is baked again
        EXPECT_EQ(result.exit, 5) << n << ": " << result.err;
        EXPECT_NE(result.err.find(std::strerror(EIO)), std::string::npos) << result.err;
        EXPECT_TRUE(readText(place.journal()) == journal) << n;
    }
    EXPECT_GT(n, 3) << "the head and a record";
    const Place undisturbed("f.sconce");
    ASSERT_EQ(sconceCommand(bake(undisturbed.folder)).exit, 0);
    expectDone(result, place, undisturbed.written());
}

// A path of which only the first lines could be read would be another path.
TEST_F(CommandFaults, HalfASunPathIsRefused)
{
    const Place place("f.exr");
    const std::string path = place.folder / "sun.csv";
    std::string text = "time,x,y,z\n";
    for (int hour = 0; hour < 1000; ++hour) text += fmt::format("{},0.5,-0.8,{}\n", hour, 0.001 * hour);
    writeText(path, text);
    Arguments day = render(place.folder);
    day.insert(day.end(), {"--sun-path", path, "--frames", "2"});
    const CommandResult result = run(day, {SCONCE_FAILING_FILES, "SCONCE_FILE_FAULT", fmt::format("read:2:{}:{}", EIO, path)});
    EXPECT_EQ(result.exit, 5) << result.err;
    EXPECT_NE(result.err.find("sun.csv"), std::string::npos) << result.err;
}

// What a bake has finished when its device is lost, or has no memory left, is kept.
TEST_F(CommandFaults, ABakeGoesOnAfterALostDevice)
{
    const Place undisturbed("f.sconce");
    const CommandResult whole = sconceCommand(bake(undisturbed.folder));
    ASSERT_EQ(whole.exit, 0) << whole.err;
    for (const char* told : {"vkQueueSubmit:40:0:lost", "vkWaitForFences:35:0:lost", "vkQueueSubmit:55:1"})
    {
        const Place place("f.sconce");
        const CommandResult stopped = run(bake(place.folder), ofVulkan(told));
        EXPECT_EQ(stopped.exit, 4) << told << ": " << stopped.err;
        EXPECT_NE(stopped.err.find("sconce: "), std::string::npos) << stopped.err;
        EXPECT_NE(stopped.err.find("the same command goes on from there"), std::string::npos) << stopped.err;
        EXPECT_TRUE(place.written() == kBefore);
        const CommandResult again = sconceCommand(bake(place.folder));
        EXPECT_NE(again.err.find("goes on from the journal"), std::string::npos) << again.err;
        expectDone(again, place, undisturbed.written());
    }
}

TEST_F(CommandFaults, ALostDeviceIsSaid)
{
    const Command commands[] = {
        [](const TestFolder& folder)
        { return Arguments{"trace", folder / "f.sconce", "--rays", folder / "rays.csv", "-o", folder / "out"}; },
        [](const TestFolder& folder) { return Arguments{"relight", folder / "f.sconce", "--dim", "rest=2", "-o", folder / "out"}; },
        [](const TestFolder& folder)
        { return Arguments{"render", "cornell", "--field", folder / "f.sconce", "--size", "16x16", "-o", folder / "out"}; }};
    for (const Command& command : commands)
    {
        const Place place("out");
        const CommandResult result = run(command(place.folder), ofVulkan("vkQueueSubmit:2:0:lost"));
        EXPECT_EQ(result.exit, 4) << result.err;
        EXPECT_NE(result.err.find("vkQueueSubmit failed"), std::string::npos) << result.err;
        EXPECT_TRUE(place.written() == kBefore);
        EXPECT_EQ(place.rubbish(), "");
    }
}

TEST_F(CommandFaults, WhatAFullDiskTakesOfStdoutIsSaid)
{
    const std::string line = fmt::format("'{}' scenes > /dev/full 2> '{}'", SCONCE_COMMAND, *inputs / "err");
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 5);
    EXPECT_NE(readText(*inputs / "err").find("sconce: "), std::string::npos);
}

} // namespace
} // namespace sconce
