// `sconce bench` as its users meet it, on the smallest scene: what it writes, keeps, and leaves behind when it is interrupted.
#include <chrono>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/run_command.h"

using namespace sconce::testing_support;
using nlohmann::json;

namespace
{

std::vector<std::string> benchInto(const std::string& folder, const std::string& frames = "2")
{
    return {"bench", "cornell", "-o",  folder,     "--methods-only", "--probes", "2", "--resolution", "64", "--size",
            "32x18", "--rays",  "500", "--frames", frames,           "--spp",    "4", "--bounces",    "0"};
}

json resultsIn(const std::string& folder)
{
    return json::parse(readText(folder + "/results.json"), nullptr, false);
}

/// Every number finite, every share in [0,1].
void expectSound(const json& point)
{
    for (const char* share : {"right_1", "right_02", "false", "leak", "unresolved"})
        if (point.contains("rays"))
        {
            EXPECT_GE(point["rays"][share], 0.0) << point["id"];
            EXPECT_LE(point["rays"][share], 1.0) << point["id"];
        }
    for (const char* part : {"beauty", "diffuse", "glossy"})
        for (const char* metric : {"mse", "relmse", "flip"}) EXPECT_GE(point["error"][part][metric], 0.0) << point["id"];
    EXPECT_GT(point["frame_ms"]["median"], 0.0) << point["id"];
    EXPECT_LE(point["frame_ms"]["p5"], point["frame_ms"]["p95"]) << point["id"];
}

} // namespace

TEST(BenchCommand, MeasuresEveryMethodOnceAndKeepsIt)
{
    const TestFolder folder;
    const std::string out = folder / "bench";
    const CommandResult first = sconceCommand(benchInto(out), 120.0);
    ASSERT_EQ(first.exit, 0) << first.err;
    const json results = resultsIn(out);
    ASSERT_FALSE(results.is_discarded());
    EXPECT_EQ(results["schema"], 2);
    const json& scene = results["scenes"][0];
    EXPECT_EQ(scene["name"], "cornell");
    std::vector<std::string> methods;
    for (const json& point : scene["points"])
    {
        if (point["knob"] == "default") methods.push_back(point["method"]);
        ASSERT_TRUE(point["wrong"].is_null() || point.contains("error")) << point["wrong"];
        expectSound(point);
        if (point["method"] == "path tracer")
            EXPECT_FALSE(point.contains("rays"));
        else
            for (const auto& [name, file] : point["images"].items())
                EXPECT_EQ(readText(out + "/" + file.get<std::string>()).substr(0, 4), "SCNI") << name;
    }
    EXPECT_EQ(methods, (std::vector<std::string>{"ours", "ours-grid", "b0", "b0plus", "b0plus-octree", "wang", "path tracer"}));
    EXPECT_FALSE(scene["analysis"]["fronts"]["glossy.relmse|frame_ms"].empty());
    EXPECT_FALSE(scene["analysis"]["equal"].empty());
    EXPECT_EQ(readText(out + "/images/cornell.reference.beauty.half").size(), 16u + 32 * 18 * 3 * 2);
    const std::string csv = readText(out + "/results.csv");
    EXPECT_EQ(size_t(std::count(csv.begin(), csv.end(), '\n')), 1 + scene["points"].size());

    // A second run measures nothing and says the same.
    const CommandResult second = sconceCommand(benchInto(out), 60.0);
    ASSERT_EQ(second.exit, 0) << second.err;
    EXPECT_EQ(resultsIn(out)["scenes"], results["scenes"]);
    EXPECT_EQ(second.err.find("ours/default"), std::string::npos) << second.err;

    // Exact figures are the same in another folder; a point whose record is damaged is measured again.
    for (const auto& file : std::filesystem::directory_iterator(out + "/cache/points")) writeText(file.path(), "{");
    ASSERT_EQ(sconceCommand(benchInto(out), 120.0).exit, 0);
    const json again = resultsIn(out);
    for (size_t i = 0; i < scene["points"].size(); ++i)
        for (const char* exact : {"rays", "error", "bytes", "probe_set"})
            EXPECT_EQ(again["scenes"][0]["points"][i].value(exact, json()), scene["points"][i].value(exact, json()))
                << scene["points"][i]["id"];
}

TEST(BenchCommand, AnInterruptKeepsWhatWasMeasured)
{
    const TestFolder folder;
    const std::string out = folder / "bench";
    const CommandResult stopped = sconceCommand(benchInto(out, "1000"), 120.0, 15.0);
    EXPECT_EQ(stopped.exit, 130) << stopped.err;
    const json partial = resultsIn(out);
    ASSERT_FALSE(partial.is_discarded());
    for (const auto& file : std::filesystem::recursive_directory_iterator(out))
        EXPECT_EQ(file.path().string().find(".tmp"), std::string::npos) << file.path();
    for (const json& point : partial["scenes"][0]["points"]) EXPECT_TRUE(point.contains("error")) << point["id"];
}

TEST(BenchCommand, WhatIsWrongIsASentence)
{
    const TestFolder folder;
    const CommandResult knob = sconceCommand({"bench", "cornell", "-o", folder / "x", "--knobs", "colour"});
    EXPECT_EQ(knob.exit, 2);
    EXPECT_NE(knob.err.find("no knob 'colour'"), std::string::npos) << knob.err;
    const CommandResult scene = sconceCommand({"bench", "nowhere", "-o", folder / "x"});
    EXPECT_EQ(scene.exit, 3);
    writeText(folder / "file", "not a folder");
    const CommandResult place = sconceCommand({"bench", "cornell", "-o", (folder / "file") + "/sub"});
    EXPECT_EQ(place.exit, 5) << place.err;
}
