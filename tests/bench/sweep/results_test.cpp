#include "bench/sweep/results.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::readText;
using testing_support::TestFolder;
using testing_support::writeText;

Json point()
{
    return Json::parse(R"({"id": "ours/default", "method": "ours", "knob": "", "value": "", "wrong": null,
        "frame_ms": {"median": 12.5, "p5": 11}, "rays": {"right_1": 0.75, "reads_mean": 31, "unresolved": 0.125},
        "bytes": {"total": 4096}, "probes": 8, "error": {"beauty": {"mse": 0.5, "flip": 0.25}, "glossy": {"relmse": null}}})");
}

Json resultsOf(std::vector<Json> points)
{
    Json results = {{"schema", 2}, {"version", "0.1"}};
    results["scenes"] = Json::array({{{"name", "room, small"}, {"points", Json(points)}}});
    return results;
}

TEST(Results, FiguresAreFoundWhereThePointHasThem)
{
    EXPECT_EQ(figureOf(point(), "frame_ms"), 12.5);
    EXPECT_EQ(figureOf(point(), "wrong_rays"), 0.25); // those that are not right
    EXPECT_EQ(figureOf(point(), "reads"), 31.0);
    EXPECT_EQ(figureOf(point(), "unresolved"), 0.125);
    EXPECT_EQ(figureOf(point(), "bytes"), 4096.0);
    EXPECT_EQ(figureOf(point(), "probes"), 8.0);
    EXPECT_EQ(figureOf(point(), "beauty.mse"), 0.5);
    EXPECT_EQ(figureOf(point(), "beauty.flip"), 0.25);
    for (const char* missing : {"trace_ms", "bake_s", "place_s", "beauty.relmse", "glossy.relmse", "diffuse.mse", "colour", "wrong", "id"})
        EXPECT_FALSE(figureOf(point(), missing).has_value()) << missing;
    for (const char* name : {"frame_ms", "wrong_rays", "bytes", "beauty.mse"}) EXPECT_FALSE(figureOf(Json::object(), name).has_value());
}

/// Cells of a CSV line by RFC 4180.
std::vector<std::string> cellsOf(const std::string& line)
{
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (size_t i = 0; i < line.size(); ++i)
        if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            cells.back() += line[i++];
        else if (line[i] == '"')
            quoted = !quoted;
        else if (line[i] == ',' && !quoted)
            cells.emplace_back();
        else
            cells.back() += line[i];
    return cells;
}

TEST(Results, CsvHasAColumnAFigureAndEmptyCellsWhereNothingWasMeasured)
{
    Json second = point();
    second["id"] = "ours/\"rays\"=4";
    second["wrong"] = "It is black, all of it.";
    std::istringstream csv(resultsCsv(resultsOf({point(), second})));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(csv, line);) rows.push_back(cellsOf(line));
    ASSERT_EQ(rows.size(), 3u);
    const auto cell = [&](size_t row, const std::string& column)
    {
        EXPECT_EQ(rows[row].size(), rows[0].size());
        const auto at = std::ranges::find(rows[0], column);
        EXPECT_NE(at, rows[0].end()) << column;
        return at == rows[0].end() ? "" : rows[row][size_t(at - rows[0].begin())];
    };
    EXPECT_EQ(cell(1, "scene"), "room, small");
    EXPECT_EQ(cell(1, "id"), "ours/default");
    EXPECT_EQ(cell(1, "frame_ms"), "12.5");
    EXPECT_EQ(cell(1, "wrong_rays"), "0.25");
    EXPECT_EQ(cell(1, "trace_ms"), "");
    EXPECT_EQ(cell(1, "glossy.relmse"), "");
    EXPECT_EQ(cell(1, "wrong"), "");
    EXPECT_EQ(cell(2, "id"), "ours/\"rays\"=4");
    EXPECT_EQ(cell(2, "wrong"), "It is black, all of it.");
}

TEST(Results, ComeBackAsTheyWereWritten)
{
    const TestFolder folder;
    Json results = resultsOf({point()});
    ASSERT_TRUE(writeResults(results, folder.path).ok());
    const auto again = readResults(folder / "results.json");
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(*again, results);
    EXPECT_EQ(readText(folder / "results.csv"), resultsCsv(results));
    results["scenes"][0]["name"] = "r\xff\xfem"; // no UTF-8, as a file's name may be
    ASSERT_TRUE(writeResults(results, folder.path).ok());
    EXPECT_TRUE(readResults(folder / "results.json").ok());
    EXPECT_EQ(writeResults(results, folder.path / "none").error().code, ErrorCode::fileError);
}

TEST(Results, WhatIsNoResultsFileIsASentence)
{
    const TestFolder folder;
    EXPECT_EQ(readResults(folder / "none.json").error().code, ErrorCode::fileError);
    for (const char* text :
         {"", "[]", "{", "{\"schema\": 2}", "{\"schema\": 1, \"scenes\": []}", "{\"scenes\": []}", "{\"schema\": 2, \"scenes\": 7}",
          "{\"schema\": 2, \"scenes\": [{\"name\": \"a\", \"points\": [{\"id\": 3}]}]}"})
    {
        writeText(folder / "a.json", text);
        const auto refused = readResults(folder / "a.json");
        ASSERT_FALSE(refused.ok()) << text;
        EXPECT_EQ(refused.error().code, ErrorCode::badInput) << text;
        EXPECT_NE(refused.error().message.find("schema 2"), std::string::npos) << refused.error().message;
    }
    writeText(folder / "a.json", "{\"schema\": \"two\", \"scenes\": []}");
    EXPECT_FALSE(readResults(folder / "a.json").ok());
}

TEST(Results, HeadSaysWhatMadeThem)
{
    const Json head = resultsHead("1.2", "abc", "sconce bench cornell", "no such device");
    EXPECT_EQ(head["version"], "1.2");
    EXPECT_EQ(head["build"], "abc");
    EXPECT_EQ(head["commands"], Json::array({"sconce bench cornell"}));
    EXPECT_EQ(head["device"]["name"], "no such device");
    EXPECT_FALSE(head["device"].contains("driver"));
    EXPECT_GE(head["machine"]["cores"], 1);
    EXPECT_GT(head["machine"]["memory_mb"], 100.0);
    EXPECT_NE(head["machine"]["os"], "");
    EXPECT_EQ(head["started"].get<std::string>().size(), std::string("2020-01-01T00:00:00Z").size());
    EXPECT_EQ(head["scenes"], Json::array());
}

// What the report shows of a kit's run is what it needs, and no more; parts that failed or are none are left out.
TEST(GpuRun, IsWhatTheKitMeasured)
{
    const TestFolder folder;
    const std::string text = R"({"kit": "0.1", "size": "64x32", "frames": 5, "wrong": ["validation"], "parts": {
        "doctor": {"seconds": 1, "clock_mhz": null, "exit": 0, "result": {"devices": [{"name": "card", "driver": "its own 1.2"}]}},
        "validation": {"exit": 1, "result": null, "said": "a word"},
        "race": {"result": [{"tracer": "ours", "coherent_ms": {"median": 2, "mrays_per_s": 500}, "incoherent_ms": {"mrays_per_s": 400}},
                            {"tracer": "halved", "coherent_ms": {"median": 2}, "incoherent_ms": {}}]},
        "race_cold": {"result": [{"tracer": "ours", "coherent_ms": {"mrays_per_s": 300}, "incoherent_ms": {"mrays_per_s": 200}}]},
        "frame_room": {"clock_mhz": [345, 1980, 1980], "result": {"passes_ms": {"G-buffer": 2.5, "glossy trace": 0.5}}},
        "frame_lost": {"result": null}, "glossy_odd": {"result": {"passes_ms": {"glossy trace": "fast"}}}, "bake_room": {"result": {"probes": 3}}}})";
    writeText(folder / "gpu.json", text);
    const auto run = readGpuRun(folder / "gpu.json");
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_EQ(*run, Json::parse(R"({"device": "card", "driver": "its own 1.2", "size": "64x32", "wrong": ["validation"],
        "frames": [{"name": "frame_room", "clock_mhz": [345, 1980, 1980], "passes_ms": {"G-buffer": 2.5, "glossy trace": 0.5}}],
        "rays": [{"tracer": "ours", "cold": false, "in_order": 500, "shuffled": 400}, {"tracer": "ours", "cold": true, "in_order": 300, "shuffled": 200}]})"));
}

TEST(GpuRun, OtherFilesAreRefused)
{
    const TestFolder folder;
    EXPECT_EQ(readGpuRun(folder / "none.json").error().code, ErrorCode::fileError);
    for (const char* text :
         {"", "[]", "{}", R"({"parts": 3})", R"({"parts": {"doctor": 1}})", R"({"parts": {"doctor": {"result": null}}})",
          R"({"parts": {"doctor": {"result": {"devices": []}}}})", R"({"parts": {"doctor": {"result": {"devices": [{"name": 7}]}}}})"})
    {
        writeText(folder / "a.json", text);
        const auto refused = readGpuRun(folder / "a.json");
        ASSERT_FALSE(refused) << text;
        EXPECT_EQ(refused.error().code, ErrorCode::badInput) << text;
    }
    for (const char* part : {"3", "null", "[]", R"({"result": 3})",
                             R"({"result": [3, {"tracer": 1}, {"tracer": "a", "coherent_ms": 1, "incoherent_ms": 2}]})"})
    {
        writeText(folder / "a.json",
                  std::string(R"({"parts": {"doctor": {"result": {"devices": [{"name": "a", "driver": "b"}]}}, "race": )") + part +
                      R"(, "frame_a": )" + part + "}}");
        const auto run = readGpuRun(folder / "a.json");
        ASSERT_TRUE(run) << part;
        EXPECT_TRUE((*run)["frames"].empty() && (*run)["rays"].empty()) << part;
    }
}

} // namespace
} // namespace sconce
