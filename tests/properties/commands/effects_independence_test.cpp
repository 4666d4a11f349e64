// Field and picture don't depend on the device's subgroup size nor on the number of threads, the driver's or ours.
#include <sched.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/properties/hard_cases/hard_case.h"
#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

using namespace testing_support;

/// For as long as it lives: variables of the software device, and our own threads on one core.
class Surroundings
{
public:
    Surroundings(const char* vectorBits, const char* driverThreads, bool oneCore)
    {
        setenv("LP_NATIVE_VECTOR_WIDTH", vectorBits, 1);
        setenv("LP_NUM_THREADS", driverThreads, 1);
        sched_getaffinity(0, sizeof(before), &before);
        if (!oneCore) return;
        cpu_set_t one;
        CPU_ZERO(&one);
        int cpu = 0;
        while (!CPU_ISSET(cpu, &before)) ++cpu;
        CPU_SET(cpu, &one);
        sched_setaffinity(0, sizeof(one), &one);
    }
    ~Surroundings()
    {
        unsetenv("LP_NATIVE_VECTOR_WIDTH");
        unsetenv("LP_NUM_THREADS");
        sched_setaffinity(0, sizeof(before), &before);
    }

private:
    cpu_set_t before;
};

struct Made
{
    int subgroup = 0;
    std::string field, picture; // bytes of the files
};

Made make(const TestFolder& folder)
{
    Made made;
    const auto devices = nlohmann::json::parse(sconceCommand({"doctor", "--json"}).out);
    made.subgroup = devices.at("devices").at(0).at("subgroup_size").get<int>();
    const CommandResult bake = sconceCommand({"bake", "cornell-glossy", "--probes", folder / "probes.json", "-o", folder / "f.sconce",
                                              "--resolution", "64", "--bounces", "1", "-q"});
    EXPECT_EQ(bake.exit, 0) << bake.err;
    const CommandResult render = sconceCommand({"render", "cornell-glossy", "--field", folder / "f.sconce", "--size", "64x36", "--temporal",
                                                "--frames", "3", "-o", folder / "p.exr", "-q"});
    EXPECT_EQ(render.exit, 0) << render.err;
    made.field = readText(folder / "f.sconce");
    made.picture = readText(folder / "p.exr");
    return made;
}

TEST(Independence, FieldAndPictureAreTheSameForAnySubgroupSizeAndNumberOfThreads)
{
    const TestFolder folder;
    writeText(folder / "probes.json", R"({"probes":[{"position":[0,1.5,0.5],"why":"a"},{"position":[-0.8,0.5,0.6],"why":"b"},
        {"position":[0.8,0.5,-0.4],"why":"c"},{"position":[-0.75,1,-0.8],"why":"d"}]})");
    const struct
    {
        const char *bits, *threads;
        bool oneCore;
        int lanes;
    } cases[] = {{"256", "3", false, 8}, {"128", "1", true, 4}, {"512", "0", false, 16}};
    std::optional<Made> first;
    double otherField = 0.0, otherPicture = 0.0;
    for (const auto& one : cases)
    {
        const Surroundings set(one.bits, one.threads, one.oneCore);
        const Made made = make(folder);
        EXPECT_GT(made.picture.size(), 1000u);
        if (made.subgroup != one.lanes) GTEST_SKIP() << "not a software device that takes its vector width from the environment";
        if (!first) first = made;
        otherField += made.field != first->field;
        otherPicture += made.picture != first->picture;
    }
    expectAtMost("subgroups of 4, 8, 16; 0, 1, 3 driver threads; 1 and all cores: fields of other bytes", std::size(cases), otherField,
                 0.0);
    expectAtMost("subgroups of 4, 8, 16; 0, 1, 3 driver threads; 1 and all cores: pictures of other bytes", std::size(cases), otherPicture,
                 0.0);
}

// Opcodes and capabilities: SPIR-V specification 1.6; SPV_EXT_shader_atomic_float_add.
TEST(Independence, NoShaderAsksForSubgroupsOrAddsFloatsAtomically)
{
    constexpr uint32_t kCapability = 17, kFirstGroupNonUniform = 61, kLastGroupNonUniform = 68, kOpFirst = 333, kOpLast = 366,
                       kAtomicFloatAdd = 6035, kMagic = 0x07230203;
    // Lanes that wait are counted, to say when rays are taken: GpuTrace.RefilledLanesAnswerTheSameToTheBit says that no answer follows from
    // it.
    constexpr std::string_view kCounts = "trace_rays_refilled_comp";
    constexpr uint32_t kGroupNonUniform = 61, kBallot = 64, kOpBallot = 339, kOpBallotBitCount = 342;
    size_t shaders = 0, bad = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SCONCE_SPIRV_FOLDER))
    {
        if (entry.path().extension() != ".spv") continue;
        const std::string bytes = readText(entry.path());
        std::vector<uint32_t> words(bytes.size() / 4);
        std::memcpy(words.data(), bytes.data(), 4 * words.size());
        ASSERT_GT(words.size(), 5u);
        ASSERT_EQ(words[0], kMagic) << entry.path();
        ++shaders;
        for (size_t at = 5; at < words.size(); at += words[at] >> 16)
        {
            const uint32_t op = words[at] & 0xffffu;
            const bool counts =
                entry.path().stem() == kCounts && (op == kOpBallot || op == kOpBallotBitCount ||
                                                   (op == kCapability && (words[at + 1] == kGroupNonUniform || words[at + 1] == kBallot)));
            const bool subgroup =
                !counts && ((op == kCapability && words[at + 1] >= kFirstGroupNonUniform && words[at + 1] <= kLastGroupNonUniform) ||
                            (op >= kOpFirst && op <= kOpLast));
            bad += subgroup || op == kAtomicFloatAdd;
            EXPECT_FALSE(subgroup || op == kAtomicFloatAdd) << entry.path() << ", opcode " << op;
            ASSERT_GT(words[at] >> 16, 0u);
        }
    }
    EXPECT_GT(shaders, 20u);
    expectAtMost("shaders: instructions on subgroups, or that add floats atomically", shaders, double(bad), 0.0);
}

} // namespace
} // namespace sconce
