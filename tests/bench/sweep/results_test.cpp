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

} // namespace
} // namespace sconce
