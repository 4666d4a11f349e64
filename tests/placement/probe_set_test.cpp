#include "placement/probe_set.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace sconce
{
namespace
{

class ProbeSetFile : public testing::Test
{
protected:
    std::filesystem::path folder = std::filesystem::temp_directory_path() / ("sconce_probe_set_" + std::to_string(getpid()) + "_" +
                                                                             testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::path file = folder / "probes.json";

    void SetUp() override { std::filesystem::create_directories(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }

    Result<ProbeSet> loadText(const std::string& text)
    {
        std::ofstream(file) << text;
        return loadProbes(file);
    }
};

TEST_F(ProbeSetFile, RoundTripKeepsEveryBit)
{
    ProbeSet set;
    set.probes = {{{0.1f, -1e-30f, 3.4e38f}, "skeleton \"ridge\"\n\xc3\xa9"}, {{1.0f / 3.0f, 16777217.0f, -0.0f}, ""}};
    set.grid = ProbeGrid{{2, 1, 1}, {0.1f, 0.2f, 0.3f}, {0.7f, 0.0f, 1e-7f}};
    set.method = "grid";
    set.scene = "a/b.glb";
    set.seed = 0xffffffffffffffffull;
    ASSERT_TRUE(saveProbes(set, file));
    const auto read = loadProbes(file);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->probes.size(), 2u);
    for (size_t i = 0; i < 2; ++i)
    {
        EXPECT_EQ(read->probes[i].position, set.probes[i].position);
        EXPECT_EQ(read->probes[i].why, set.probes[i].why);
    }
    ASSERT_TRUE(read->grid);
    EXPECT_EQ(read->grid->count, set.grid->count);
    EXPECT_EQ(read->grid->origin, set.grid->origin);
    EXPECT_EQ(read->grid->step, set.grid->step);
    EXPECT_EQ(read->method, set.method);
    EXPECT_EQ(read->scene, set.scene);
    EXPECT_EQ(read->seed, set.seed);
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
    EXPECT_EQ(files, 1u) << "a temporary file was left behind";
}

// The form other programs rely on, read by a parser and not by our loader.
TEST_F(ProbeSetFile, WritesTheDocumentedForm)
{
    ProbeSet set;
    set.probes = {{{1.5f, 2.0f, 0.1f}, "here"}};
    ASSERT_TRUE(saveProbes(set, file));
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in);
    EXPECT_EQ(json["probes"][0]["position"], nlohmann::json({1.5, 2.0, 0.1}));
    EXPECT_EQ(json["probes"][0]["why"], "here");
    EXPECT_FALSE(json.contains("grid"));
}

TEST_F(ProbeSetFile, OnlyPositionsAreRequired)
{
    const auto read = loadText(R"({"probes":[{"position":[1,2,3]}], "later":{"key":1}})");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->probes[0].position, glm::vec3(1, 2, 3));
    EXPECT_TRUE(loadText(R"({"probes":[]})"));
}

TEST_F(ProbeSetFile, MalformedFilesGetASentenceThatNamesTheFault)
{
    const std::pair<const char*, const char*> cases[] = {
        {"", "JSON"},
        {"{\"probes\":[", "JSON"},
        {"[]", "\"probes\""},
        {"{}", "\"probes\""},
        {R"({"probes":{}})", "\"probes\""},
        {R"({"probes":[{}]})", "probe 0"},
        {R"({"probes":[{"position":[0,0,0]},{"position":[1,2]}]})", "probe 1"},
        {R"({"probes":[{"position":[1,2,"x"]}]})", "probe 0"},
        {R"({"probes":[{"position":[1,2,1e300]}]})", "probe 0"},
        {R"({"probes":[{"position":[1,2,null]}]})", "probe 0"},
        {R"({"probes":[{"position":[1,2,3],"why":4}]})", "\"why\" of probe 0"},
        {R"({"probes":[7]})", "probe 0"},
        {R"({"probes":[],"method":3})", "\"method\""},
        {R"({"probes":[],"seed":-1})", "\"seed\""},
        {R"({"probes":[],"seed":1.5})", "\"seed\""},
        {R"({"probes":[],"grid":7})", "\"count\""},
        {R"({"probes":[],"grid":{"count":[0,1,1]}})", "\"count\""},
        {R"({"probes":[],"grid":{"count":[1e9,1,1]}})", "\"count\""},
        {R"({"probes":[],"grid":{"count":[65535,65535,65535]}})", "0 probes"},
        {R"({"probes":[{"position":[1,2,3]}],"grid":{"count":[1,1,1],"step":[1,1,1]}})", "\"origin\""},
        {R"({"probes":[{"position":[1,2,3]}],"grid":{"count":[1,1,1],"origin":[0,0,0]}})", "\"step\""},
    };
    for (const auto& [text, fault] : cases)
    {
        const auto read = loadText(text);
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().code, ErrorCode::badInput) << text;
        EXPECT_NE(read.error().message.find(fault), std::string::npos) << text << " -> " << read.error().message;
        EXPECT_NE(read.error().message.find("probes.json"), std::string::npos) << read.error().message;
    }
}

TEST_F(ProbeSetFile, MoreProbesThanIndicesAreRefused)
{
    std::string text = R"({"probes":[)";
    for (int i = 0; i < 65536; ++i) text += i ? R"(,{"position":[0,0,0]})" : R"({"position":[0,0,0]})";
    const auto read = loadText(text + "]}");
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("65536"), std::string::npos) << read.error().message;
}

TEST_F(ProbeSetFile, MissingFileAndFolderAreFileErrors)
{
    const auto read = loadProbes(folder / "none.json");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::fileError);
    const auto saved = saveProbes({}, folder / "none" / "probes.json");
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, ErrorCode::fileError);
}

TEST_F(ProbeSetFile, NonFinitePositionIsNotWritten)
{
    ProbeSet set;
    set.probes = {{{NAN, 0, 0}, ""}};
    const auto saved = saveProbes(set, file);
    ASSERT_FALSE(saved);
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(ProbeSetFile, PinsSayWhatTheyAre)
{
    std::ofstream(file) << R"({"probes":[{"position":[1,2,3],"why":"x"},{"position":[4,5,6],"pin":"add"},
        {"position":[7,8,9],"pin":"forbid","radius":0.5},{"position":[0,0,0],"pin":"keep"}]})";
    const auto pins = loadPins(file);
    ASSERT_TRUE(pins) << pins.error().message;
    ASSERT_EQ(pins->size(), 4u);
    EXPECT_EQ((*pins)[0].kind, Pin::Kind::keep);
    EXPECT_EQ((*pins)[0].position, glm::vec3(1, 2, 3));
    EXPECT_EQ((*pins)[1].kind, Pin::Kind::add);
    EXPECT_EQ((*pins)[2].kind, Pin::Kind::forbid);
    EXPECT_EQ((*pins)[2].radius, 0.5f);
    EXPECT_EQ((*pins)[3].kind, Pin::Kind::keep);
}

TEST_F(ProbeSetFile, BadPinsGetASentence)
{
    const std::pair<const char*, const char*> cases[] = {
        {"{", "JSON"},
        {"[]", "probes"},
        {R"({"probes":[{"position":[1,2]}]})", "position"},
        {R"({"probes":[{"position":[1,2,3],"pin":"stay"}]})", "stay"},
        {R"({"probes":[{"position":[1,2,3],"pin":7}]})", "7"},
        {R"({"probes":[{"position":[1,2,3],"pin":"forbid"}]})", "radius"},
        {R"({"probes":[{"position":[1,2,3],"pin":"forbid","radius":0}]})", "radius"},
        {R"({"probes":[{"position":[1,2,3],"pin":"forbid","radius":"wide"}]})", "radius"},
        {R"({"probes":[{"position":[1,2,3],"pin":"forbid","radius":1e300}]})", "radius"},
        {R"({"probes":[{"position":[1,2,3],"radius":2}]})", "forbid"},
    };
    for (const auto& [text, names] : cases)
    {
        std::ofstream(file) << text;
        const auto pins = loadPins(file);
        ASSERT_FALSE(pins) << text;
        EXPECT_EQ(pins.error().code, ErrorCode::badInput);
        EXPECT_NE(pins.error().message.find(names), std::string::npos) << pins.error().message;
    }
    EXPECT_EQ(loadPins(folder / "none.json").error().code, ErrorCode::fileError);
}

} // namespace
} // namespace sconce
