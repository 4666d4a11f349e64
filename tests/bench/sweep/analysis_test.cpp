// What the analysis says of made-up points whose answers are known.
#include "bench/sweep/analysis.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

struct Figures
{
    double glossy, frame, wrong, bytes, probes;
};

Json point(const std::string& method, const std::string& knob, const std::string& value, const Figures& f)
{
    return {
        {"id", method + (knob == "default" ? "/default" : "/" + knob + "=" + value)},
        {"method", method},
        {"knob", knob},
        {"value", value},
        {"frame_ms", {{"median", f.frame}}},
        {"trace_ms", {{"median", f.frame / 2}}},
        {"rays",
         {{"right_1", 1.0 - f.wrong}, {"unresolved", f.wrong / 2}, {"false", f.wrong / 4}, {"leak", f.wrong / 4}, {"reads_mean", f.frame}}},
        {"error", {{"glossy", {{"relmse", f.glossy}}}, {"beauty", {{"relmse", f.glossy}}}}},
        {"bytes", {{"total", f.bytes}}},
        {"probes", f.probes},
        {"wrong", nullptr}};
}

std::vector<Json> scene()
{
    return {point("ours", "default", "", {.glossy = 0.02, .frame = 10, .wrong = 0.01, .bytes = 100, .probes = 8}),
            point("ours", "probes", "4", {.glossy = 0.04, .frame = 5, .wrong = 0.05, .bytes = 50, .probes = 4}),
            point("ours", "probes", "16", {.glossy = 0.01, .frame = 20, .wrong = 0.005, .bytes = 200, .probes = 16}),
            point("b0plus", "default", "", {.glossy = 0.04, .frame = 20, .wrong = 0.04, .bytes = 200, .probes = 8}),
            point("b0plus", "probes", "16", {.glossy = 0.005, .frame = 40, .wrong = 0.02, .bytes = 400, .probes = 16}),
            point("b0", "default", "", {.glossy = 0.2, .frame = 30, .wrong = 0.4, .bytes = 200, .probes = 8})};
}

const Json& rowOf(const Json& analysis, const std::string& what, const std::string& key, const std::string& theirs, const char* cost)
{
    static const Json none;
    for (const Json& row : analysis["equal"])
        if (row["what"] == what && row["error_key"] == key && row["theirs"] == theirs &&
            (cost ? row["cost_key"] == cost : row["cost_key"].is_null()))
            return row;
    ADD_FAILURE() << "no row " << what << " " << key << " " << theirs;
    return none;
}

TEST(Analysis, TheFrontIsWhatNoOtherPointBeatsInBoth)
{
    const Json analysis = analyseScene(scene());
    EXPECT_EQ(analysis["fronts"]["glossy.relmse|frame_ms"],
              (Json{"ours/probes=4", "ours/default", "ours/probes=16", "b0plus/probes=16"})); // b0plus and b0 cost more and are worse
    EXPECT_EQ(analysis["fronts"]["wrong_rays|bytes"], (Json{"ours/probes=4", "ours/default", "ours/probes=16"}));
}

TEST(Analysis, OfEqualPointsTheFrontHasTheFirst)
{
    const Json a = point("ours", "default", "", {1, 1, 0, 1, 1}), b = point("b0", "default", "", {1, 1, 0, 1, 1});
    const Json* points[] = {&a, &b};
    EXPECT_EQ(paretoFront(points, "glossy.relmse", "frame_ms"), std::vector<std::string>{"ours/default"});
}

TEST(Analysis, AWrongPictureIsOnNoFrontAndInNoTable)
{
    std::vector<Json> points = scene();
    points[1]["wrong"] = "black"; // the cheapest of all
    const Json analysis = analyseScene(points);
    EXPECT_EQ(analysis["fronts"]["glossy.relmse|frame_ms"], (Json{"ours/default", "ours/probes=16", "b0plus/probes=16"}));
    for (const Json& row : analysis["equal"]) EXPECT_NE(row["ours"], "ours/probes=4");
    const auto told = [](const Json& each) { return each["sentence"] == "Sconce with probes 4: black"; };
    EXPECT_TRUE(std::ranges::any_of(analysis["breaks"], told)) << analysis["breaks"].dump(1);
}

TEST(Analysis, AFigureThatWasNotMeasuredTakesPartInNothing)
{
    std::vector<Json> points = scene();
    points[0].erase("frame_ms");
    const Json analysis = analyseScene(points);
    EXPECT_EQ(analysis["fronts"]["glossy.relmse|frame_ms"], (Json{"ours/probes=4", "ours/probes=16", "b0plus/probes=16"}));
    EXPECT_TRUE(rowOf(analysis, "probes", "glossy.relmse", "b0plus/default", nullptr)["ratio"]["time"].is_null());
}

TEST(Analysis, EqualErrorTakesTheCheapestThatIsAsGood)
{
    const Json analysis = analyseScene(scene());
    const Json& row = rowOf(analysis, "error", "glossy.relmse", "b0plus/default", "frame_ms");
    EXPECT_EQ(row["ours"], "ours/probes=4");
    EXPECT_DOUBLE_EQ(row["ratio"]["time"], 0.25);
    EXPECT_DOUBLE_EQ(row["ratio"]["error"], 1.0);
    EXPECT_DOUBLE_EQ(row["ratio"]["memory"], 0.25);
    EXPECT_DOUBLE_EQ(row["ratio"]["probes"], 0.5);
}

TEST(Analysis, AnOpponentThatIsBetterThanAnySettingIsALossAndSaysSo)
{
    const Json analysis = analyseScene(scene());
    const Json& row = rowOf(analysis, "error", "glossy.relmse", "b0plus/probes=16", "frame_ms");
    EXPECT_TRUE(row["ours"].is_null());
    EXPECT_DOUBLE_EQ(row["ratio"]["error"], 2.0);
    EXPECT_NE(row["sentence"].get<std::string>().find("no setting of Sconce is good enough"), std::string::npos) << row["sentence"];
}

TEST(Analysis, EqualProbesTimeAndMemory)
{
    const Json analysis = analyseScene(scene());
    const Json& probes = rowOf(analysis, "probes", "glossy.relmse", "b0plus/default", nullptr);
    EXPECT_EQ(probes["ours"], "ours/default");
    EXPECT_DOUBLE_EQ(probes["ratio"]["error"], 0.5);
    EXPECT_NEAR(probes["ratio"]["wrong_rays"].get<double>(), 0.25, 1e-12);
    const Json& time = rowOf(analysis, "time", "glossy.relmse", "b0plus/default", "frame_ms");
    EXPECT_EQ(time["ours"], "ours/probes=16");
    EXPECT_DOUBLE_EQ(time["ratio"]["error"], 0.25);
    const Json& memory = rowOf(analysis, "memory", "wrong_rays", "b0plus/default", "bytes");
    EXPECT_EQ(memory["ours"], "ours/probes=16");
    EXPECT_NEAR(memory["ratio"]["wrong_rays"].get<double>(), 0.125, 1e-12);
}

// Fewer rays or no filter make any tracer's frame cheaper: they decide no table between tracers.
TEST(Analysis, KnobsOfTheFrameAloneDecideNoTableAgainstTracers)
{
    std::vector<Json> points = scene();
    points.push_back(point("ours", "denoise", "off", {.glossy = 0.001, .frame = 1, .wrong = 0.01, .bytes = 1, .probes = 1}));
    points.push_back(point("path tracer", "default", "", {.glossy = 0.5, .frame = 3, .wrong = 0, .bytes = 0, .probes = 0}));
    points.back().erase("rays");
    points.back().erase("bytes");
    points.back().erase("probes");
    const Json analysis = analyseScene(points);
    EXPECT_EQ(rowOf(analysis, "error", "glossy.relmse", "b0plus/default", "frame_ms")["ours"], "ours/probes=4");
    EXPECT_EQ(rowOf(analysis, "error", "glossy.relmse", "path tracer/default", "frame_ms")["ours"], "ours/denoise=off");
}

TEST(Analysis, HalvingTheErrorCostsWhatTheStepSays)
{
    EXPECT_DOUBLE_EQ(*halvingCost(0.5, 3.0), 3.0);
    EXPECT_DOUBLE_EQ(*halvingCost(0.25, 4.0), 2.0); // a quarter for four times: a half for twice
    EXPECT_DOUBLE_EQ(*halvingCost(2.0, 0.5), 2.0);  // the same step, seen from the better end
    EXPECT_DOUBLE_EQ(*halvingCost(0.5, 0.5), 0.5);  // better and faster
    EXPECT_FALSE(halvingCost(1.03, 0.54));          // a price of 2.5e7 times the memory, once
    EXPECT_FALSE(halvingCost(0.85, 1.2));
    EXPECT_TRUE(halvingCost(0.8, 1.2));
    EXPECT_FALSE(halvingCost(0.0, 2.0));
    EXPECT_FALSE(halvingCost(0.5, 0.0));
    const Json analysis = analyseScene(scene());
    for (const Json& price : analysis["prices"])
        if (price["to"] == "ours/probes=16" && price["error_key"] == "glossy.relmse")
        {
            EXPECT_DOUBLE_EQ(price["error_ratio"], 0.5);
            EXPECT_DOUBLE_EQ(price["halving_costs_time"], 2.0);
            EXPECT_DOUBLE_EQ(price["halving_costs_memory"], 2.0);
            return;
        }
    FAIL() << "no price of 16 probes";
}

TEST(Analysis, SaysWhereAMethodBreaks)
{
    const Json analysis = analyseScene(scene());
    std::vector<std::string> sentences;
    for (const Json& each : analysis["breaks"]) sentences.push_back(each["sentence"]);
    EXPECT_EQ(std::ranges::count(sentences,
                                 "Sconce with probes 4 answers 5.00 % of the rays wrongly instead of 1.00 %, most of them (2.50 % "
                                 "of all) because no probe that is asked sees their way."),
              1)
        << analysis["breaks"].dump(1);
    EXPECT_TRUE(
        std::ranges::any_of(sentences, [](const std::string& s) { return s.starts_with("B0 answers 40.00 % of the rays wrongly"); }));
}

TEST(Analysis, AnswersNameTheHardestOpponentOfEachScene)
{
    Json results = {{"scenes", {{{"name", "room"}, {"points", scene()}, {"analysis", analyseScene(scene())}}}}};
    const std::vector<std::string> answers = answersOf(results);
    EXPECT_EQ(std::ranges::count(answers, "With as many probes, Sconce answers wrongly 0.25 times as much in room (against B0+)."), 1);
    EXPECT_EQ(
        std::ranges::count(answers, "For the glossy error of the opponent, Sconce's frame takes 0.25 times as much in room (against B0+)."),
        1);
}

// "Sconce's frame takes out of reach in town" was a sentence of the report.
TEST(Analysis, AnswersSayWhatNoSettingReaches)
{
    const Json reached = {{"what", "error"},        {"error_key", "glossy.relmse"}, {"cost_key", "frame_ms"},  {"method", "b0"},
                          {"theirs", "b0/default"}, {"ours", "ours/default"},       {"ratio", {{"time", 0.5}}}};
    Json missed = reached;
    missed["ours"] = nullptr;
    const auto scene = [](const char* name, const Json& row) {
        return Json{{"name", name}, {"analysis", {{"equal", Json::array({row})}}}};
    };
    EXPECT_EQ(answersOf({{"scenes", {scene("room", reached), scene("town", missed)}}}).front(),
              "For the glossy error of the opponent, Sconce's frame takes 0.5 times as much in room (against B0); no setting of ours does "
              "it in town (against B0).");
    EXPECT_EQ(answersOf({{"scenes", {scene("town", missed), scene("hall", missed)}}}).front(),
              "For the glossy error of the opponent: no setting of ours does it in town (against B0), in hall (against B0).");
}

} // namespace
} // namespace sconce
