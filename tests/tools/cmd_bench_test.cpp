// `sconce bench` as its users meet it, on the smallest scene: what it writes, keeps, and leaves behind when it is interrupted.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_command.h"

using namespace sconce::testing_support;
using nlohmann::json;

namespace
{

std::vector<std::string> benchInto(const std::string& folder, const std::string& frames = "2")
{
    return {"bench",          "cornell", "-o",     folder, "--methods-only", "--quick-grids", "--probes", "2", "--resolution", "64",
            "--size",         "32x18",   "--rays", "500",  "--frames",       frames,          "--spp",    "4", "--bounces",    "0",
            "--surface-rays", "16"};
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
    const bool reflects = point["method"] != "ddgi" && point["method"] != "ddgi-placed" && point["method"] != "sh-grid";
    EXPECT_EQ(point["error"].contains("glossy"), reflects) << point["id"];
    for (const char* part : {"beauty", "diffuse", "glossy"})
        for (const char* metric : {"mse", "relmse", "flip"})
            if (reflects || std::string(part) != "glossy")
            {
                EXPECT_GE(point["error"][part][metric], 0.0) << point["id"];
            }
    EXPECT_GT(point["frame_ms"]["median"], 0.0) << point["id"];
    EXPECT_LE(point["frame_ms"]["p5"], point["frame_ms"]["p95"]) << point["id"];
}

} // namespace

TEST(BenchCommand, MeasuresEveryMethodOnceAndKeepsIt)
{
    const TestFolder folder;
    const std::string out = folder / "bench";
    const CommandResult first = sconceCommand(benchInto(out));
    ASSERT_EQ(first.exit, 0) << first.err;
    const json results = resultsIn(out);
    ASSERT_FALSE(results.is_discarded());
    EXPECT_EQ(results["schema"], 2);
    std::string typed = "sconce";
    for (const std::string& argument : benchInto(out)) typed += " " + argument;
    EXPECT_EQ(results["commands"][0], typed) << "whole, so that it can be run again";
    const json& scene = results["scenes"][0];
    EXPECT_EQ(scene["name"], "cornell");
    std::vector<std::string> methods;
    for (const json& point : scene["points"])
    {
        if (point["knob"] == "default") methods.push_back(point["method"]);
        ASSERT_TRUE(point["wrong"].is_null() || point.contains("error")) << point["wrong"];
        expectSound(point);
        EXPECT_EQ(point.contains("images"), point["knob"] == "default" && point["method"] != "path tracer") << point["id"];
        if (point["method"] == "path tracer" || point["method"] == "path tracer filtered")
        {
            EXPECT_FALSE(point.contains("rays"));
        }
        if (!point.contains("images")) continue;
        for (const auto& [name, file] : point["images"].items())
            EXPECT_EQ(readText(out + "/" + file.get<std::string>()).substr(0, 4), "SCNI") << name;
    }
    EXPECT_EQ(methods, (std::vector<std::string>{"ours", "ours-grid", "b0", "b0plus", "b0plus-octree", "wang", "ddgi", "ddgi-placed",
                                                 "sh-grid", "path tracer", "path tracer filtered"}));
    EXPECT_FALSE(scene["analysis"]["fronts"]["glossy.relmse|frame_ms"].empty());
    EXPECT_FALSE(scene["analysis"]["equal"].empty());
    EXPECT_EQ(readText(out + "/images/cornell.reference.beauty.half").size(), 16u + 32 * 18 * 3 * 2);
    const std::string csv = readText(out + "/results.csv");
    EXPECT_EQ(size_t(std::count(csv.begin(), csv.end(), '\n')), 1 + scene["points"].size());

    // A second run measures nothing and says the same.
    const CommandResult second = sconceCommand(benchInto(out));
    ASSERT_EQ(second.exit, 0) << second.err;
    EXPECT_EQ(resultsIn(out)["scenes"], results["scenes"]);
    EXPECT_EQ(second.err.find("ours/default"), std::string::npos) << second.err;

    // A point whose record is damaged is measured again, and its exact figures are the same.
    size_t damaged = 0;
    for (const auto& file : std::filesystem::directory_iterator(out + "/cache/points"))
        if (readText(file.path()).find("\"ours/default\"") != std::string::npos)
        {
            writeText(file.path(), "{");
            ++damaged;
        }
    ASSERT_EQ(damaged, 1u);
    const CommandResult third = sconceCommand(benchInto(out));
    ASSERT_EQ(third.exit, 0) << third.err;
    EXPECT_NE(third.err.find("ours/default: rays right"), std::string::npos) << third.err;
    const json again = resultsIn(out);
    for (const char* exact : {"rays", "error", "bytes", "probe_set"})
        EXPECT_EQ(again["scenes"][0]["points"][0][exact], scene["points"][0][exact]) << exact;
}

TEST(BenchCommand, AnInterruptKeepsWhatWasMeasured)
{
    const TestFolder folder;
    const std::string out = folder / "bench";
    const CommandResult stopped = sconceCommand(benchInto(out, "1000"), {.interruptWhen = "ours/default: rays right"});
    EXPECT_EQ(stopped.exit, 130) << stopped.err;
    const json partial = resultsIn(out);
    ASSERT_FALSE(partial.is_discarded());
    EXPECT_FALSE(partial["scenes"][0]["points"].empty());
    for (const auto& file : std::filesystem::recursive_directory_iterator(out))
        EXPECT_EQ(file.path().string().find(".tmp"), std::string::npos) << file.path();
    for (const json& point : partial["scenes"][0]["points"]) EXPECT_TRUE(point.contains("error")) << point["id"];
}

// A baseline that was better than what is measured now fails, and the sentence names the figure.
TEST(BenchCommand, AWorsenedFigureFailsTheCheckAndIsNamed)
{
    const TestFolder folder;
    const std::string file = folder / "baseline.json";
    ASSERT_EQ(
        sconceCommand({"bench",          "cornell", "--baseline", file, "--probes",    "2",  "--resolution", "64", "--size",  "32x18",
                       "--rays",         "500",     "--frames",   "1",  "--spp",       "4",  "--bounces",    "0",  "--knobs", "ranked",
                       "--surface-rays", "16",      "--seed",     "7",  "--roughness", "0.4"})
            .exit,
        0);
    json guard = json::parse(readText(file));
    ASSERT_EQ(guard["scenes"][0]["points"].size(), 5u); // ours, its three others of the knob, and B0+
    EXPECT_EQ(guard["scenes"][0]["options"]["seed"], 7);
    EXPECT_FLOAT_EQ(guard["scenes"][0]["options"]["roughness"].get<float>(), 0.4f);
    json& reads = guard["scenes"][0]["points"][0]["reads"];
    const double measured = reads;
    reads = 0.5 * measured;
    writeText(file, guard.dump());
    const CommandResult worse = sconceCommand({"bench", "--check", file, "--json"});
    EXPECT_EQ(worse.exit, 1);
    EXPECT_EQ(json::parse(worse.out)["points"][0]["reads"].get<double>(), measured) << "of the same rays, by the guard's own seed";
    EXPECT_NE(worse.err.find("cornell, ours/default: reads is "), std::string::npos) << worse.err;
    EXPECT_EQ(worse.err.find("wrong_rays is"), std::string::npos) << worse.err;
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

TEST(QualityOption, SetsWhatTheCommandLineDoesNotSay)
{
    const TestFolder folder;
    const std::string probes = folder / "p.json", field = folder / "f.sconce";
    ASSERT_EQ(sconceCommand({"place", "cornell", "-o", probes, "--count", "1"}).exit, 0);
    const CommandResult bake =
        sconceCommand({"bake", "cornell", "--probes", probes, "-o", field, "--quality", "draft", "--bounces", "0", "--json"});
    ASSERT_EQ(bake.exit, 0) << bake.err;
    const json baked = json::parse(bake.out);
    EXPECT_EQ(baked["resolution"], 128); // the level's
    EXPECT_EQ(baked["bounces"], 0);      // the line's
    const auto drawn = [&](std::vector<std::string> options)
    {
        options.insert(options.begin(), {"render", "cornell", "--field", field, "--size", "32x18", "-o", folder / "x.exr", "--json"});
        const CommandResult render = sconceCommand(options);
        EXPECT_EQ(render.exit, 0) << render.err;
        return json::parse(render.out);
    };
    EXPECT_EQ(drawn({})["samples"], 1);
    EXPECT_EQ(drawn({"--quality", "high"})["samples"], 2);
    EXPECT_EQ(drawn({"--quality", "high", "--samples", "1"})["samples"], 1);

    const json tuned = {{"trace every", 8}, {"rays below", 0.9}, {"temporal", "on"}, {"traced diffuse", "on"}, {"denoise", "off"}};
    writeText(folder / "tuned.json", json{{"quality", 1}, {"settings", tuned}}.dump());
    const json all = drawn({"--quality", folder / "tuned.json"});
    EXPECT_EQ(all["trace_every"], 8);
    EXPECT_FLOAT_EQ(all["rays_below"], 0.9f);
    EXPECT_EQ(all["diffuse"], "traced");
    EXPECT_EQ(all["temporal"], true);
    EXPECT_EQ(all["effects"]["denoise"], false);
    EXPECT_EQ(drawn({"--quality", folder / "tuned.json", "--trace-every", "2"})["trace_every"], 2);
    EXPECT_EQ(sconceCommand({"place", "cornell", "-o", probes, "--quality", "splendid"}).exit, 2);
}

// A quality that bakes no surface light is drawn without it, by the same file.
TEST(QualityOption, AFieldWithoutSurfaceLightIsDrawnByItsOwnFile)
{
    const TestFolder folder;
    const std::string quality = folder / "bare.json", field = folder / "f.sconce";
    writeText(folder / "p.json", R"({"probes": [{"position": [0, 1, 0]}]})");
    writeText(quality, json{{"quality", 1}, {"settings", {{"surface texels", 0}, {"resolution", 128}}}}.dump());
    const CommandResult bake =
        sconceCommand({"bake", "cornell", "--probes", folder / "p.json", "-o", field, "--quality", quality, "--bounces", "0", "-q"});
    ASSERT_EQ(bake.exit, 0) << bake.err;
    for (const std::string& by : {quality, std::string("draft")})
    {
        const CommandResult render =
            sconceCommand({"render", "cornell", "--field", field, "--size", "32x18", "-o", folder / "x.exr", "--quality", by, "--json"});
        ASSERT_EQ(render.exit, 0) << render.err;
        EXPECT_EQ(json::parse(render.out)["diffuse"], "irradiance");
    }
}

/// All that `tune` may pick of ours, in each command that it is for.
TEST(QualityOption, SetsPlacementAndBakeAsTheirOptionsDo)
{
    const TestFolder folder;
    const auto quality = [&](const std::string& name, const json& settings)
    {
        writeText(folder / name, json{{"quality", 1}, {"settings", settings}}.dump());
        return folder / name;
    };
    const auto done = [&](std::vector<std::string> arguments, const std::string& output)
    {
        arguments.insert(arguments.end(), {"-q", "-o", folder / output});
        const CommandResult result = sconceCommand(arguments);
        EXPECT_EQ(result.exit, 0) << result.err;
        return readText(folder / output);
    };
    const std::string balls = quality("balls.json", {{"placement", "balls"}, {"probes", 2}});
    EXPECT_EQ(json::parse(done({"place", "cornell", "--quality", balls}, "p.json"))["method"], "balls");
    EXPECT_EQ(json::parse(done({"place", "cornell", "--quality", balls, "--method", "sdf"}, "q.json"))["method"], "sdf");

    const std::string coarse = quality("coarse.json", {{"octree voxels", 32}});
    const std::vector<std::string> bake{"bake", "cornell",      "--probes", folder / "p.json", "--bounces",
                                        "0",    "--resolution", "64",       "--quality"};
    const auto baked = [&](std::vector<std::string> more, const std::string& output)
    {
        std::vector<std::string> all = bake;
        all.insert(all.end(), more.begin(), more.end());
        return done(all, output);
    };
    const std::vector<std::pair<json, std::vector<std::string>>> cases{
        {{{"surface texels", 26}}, {"--surface-texels", "26"}},
        {{{"surface rays", 16}, {"surface refined", 0.0}}, {"--surface-rays", "16", "--surface-refined", "0"}},
        {{{"compact", "on"}}, {"--compact"}},
        {{{"field gather", "on"}, {"surface rays", 4}}, {"--gather", "field", "--surface-rays", "4"}}};
    const std::string usual = baked({coarse}, "usual.sconce");
    // What blocks can't hold is asked for by the line.
    const std::string blocks = quality("blocks.json", {{"compact", "on"}, {"octree voxels", 32}, {"surface rays", 4}});
    EXPECT_FALSE(baked({blocks, "--group", "emitters"}, "groups.sconce").empty());
    EXPECT_FALSE(baked({blocks, "--chart", "octahedral"}, "octahedral.sconce").empty());
    for (auto [settings, options] : cases)
    {
        settings["octree voxels"] = 32;
        options.insert(options.begin(), coarse);
        const std::string by = baked({quality("by.json", settings)}, "by.sconce");
        EXPECT_TRUE(by == baked(options, "by.sconce")) << settings;
        EXPECT_FALSE(by == usual) << settings;
    }
    const auto drawn = [&](const std::string& option, const std::string& value) {
        return done({"render", "cornell", "--field", folder / "usual.sconce", "--size", "32x18", option, value}, "x.exr");
    };
    EXPECT_TRUE(drawn("--quality", quality("one.json", {{"surface probes", 1}})) == drawn("--surface-probes", "1"));
}
