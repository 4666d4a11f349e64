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

} // namespace
} // namespace sconce
