#include "bench/sweep/tune.h"

#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

Json point(const std::string& id, double glossy, double frame, double bytes)
{
    return {{"id", id},
            {"method", "ours"},
            {"settings", settingsJson(PointSettings())},
            {"frame_ms", {{"median", frame}}},
            {"error", {{"glossy", {{"relmse", glossy}}}}},
            {"bytes", {{"total", bytes}}},
            {"wrong", nullptr}};
}

std::vector<Json> points()
{
    std::vector<Json> all = {point("cheap", 0.04, 5, 50), point("middle", 0.02, 10, 100), point("best", 0.01, 20, 200),
                             point("small", 0.03, 15, 20)};
    all.push_back(point("broken", 0.001, 1, 1));
    all.back()["wrong"] = "black.";
    all.push_back(point("theirs", 0.001, 1, 1));
    all.back()["method"] = "b0plus";
    return all;
}

std::string chosen(const TuneGoal& goal)
{
    const auto point = tune(points(), goal);
    return point ? (*point)["id"].get<std::string>() : point.error().message;
}

TEST(Tune, TakesTheMostExactWithinTimeAndMemoryAndTheFastestWithinAnError)
{
    EXPECT_EQ(chosen({.frameMs = 12.0, .error = {}, .bytes = {}}), "middle");
    EXPECT_EQ(chosen({.frameMs = 1000.0, .error = {}, .bytes = {}}), "best");
    EXPECT_EQ(chosen({.frameMs = {}, .error = 0.025, .bytes = {}}), "middle");
    EXPECT_EQ(chosen({.frameMs = {}, .error = {}, .bytes = 60.0}), "small");
    EXPECT_EQ(chosen({.frameMs = 12.0, .error = {}, .bytes = 60.0}), "cheap");
}

TEST(Tune, AGoalThatNothingKeepsToNamesTheNearest)
{
    EXPECT_EQ(chosen({.frameMs = {}, .error = 0.009, .bytes = {}}),
              "No measured settings keep to that; the nearest, best, have frame_ms 20, glossy.relmse 0.01, bytes 200.");
    EXPECT_NE(chosen({}).find("nothing to tune for"), std::string::npos);
    EXPECT_NE(chosen({.frameMs = 10.0, .error = {}, .bytes = {}, .metric = "beauty.flip"}).find("No point of ours has the figures"),
              std::string::npos);
}

TEST(QualityFiles, ComeBackAsTheSettingsTheyWereMadeOf)
{
    const testing_support::TestFolder folder;
    PointSettings settings;
    settings.probes = 17;
    settings.resolution = 256;
    settings.quality.trace.opinion = 0.01f;
    settings.frame.glossyRays = 4;
    settings.frame.effects.denoise = false;
    Json measured = point("ours/x", 0.1, 1, 1);
    measured["settings"] = settingsJson(settings);
    const std::string file = folder / "settings.json";
    testing_support::writeText(file, qualityFile("room", measured).dump());
    const auto again = loadQuality(file);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(settingsJson(*again), settingsJson(settings));
    testing_support::writeText(file, "{}");
    EXPECT_NE(loadQuality(file).error().message.find("holds no settings"), std::string::npos);
    EXPECT_NE(loadQuality("splendid").error().message.find("neither a file nor a level (mobile, draft, low, medium, high, reference)"),
              std::string::npos);
}

TEST(QualityLevels, RiseInWhatTheyTakeAndAreReadByName)
{
    for (size_t i = 1; i < qualityLevels().size(); ++i)
    {
        const QualityLevel &a = qualityLevels()[i - 1], &b = qualityLevels()[i];
        EXPECT_LE(a.memory, b.memory) << b.name;
        EXPECT_LE(a.time, b.time) << b.name;
        EXPECT_GE(a.error, b.error) << b.name;
    }
    const auto high = loadQuality("high");
    ASSERT_TRUE(high.ok());
    EXPECT_EQ(high->resolution, findQualityLevel("high")->resolution);
    EXPECT_EQ(high->probes, 0u);
    EXPECT_EQ(high->frame.raysBelow, findQualityLevel("high")->raysBelow);
    EXPECT_FALSE(loadQuality("reference")->frame.effects.tracedDiffuse) << "surface light is nearer to the truth";
    EXPECT_EQ(findQualityLevel("splendid"), nullptr);
}

std::vector<double> numbersOf(const std::string& list)
{
    std::vector<double> numbers;
    std::istringstream text(list);
    for (std::string one; std::getline(text, one, ',');) numbers.push_back(std::stod(one));
    return numbers;
}

TEST(QualityLevels, CostWhatWasMeasured)
{
    const Json row = Json::parse(testing_support::readText(SCONCE_SOURCES "/bench/results/knobs.json"))["rows"]["level"];
    const auto frame = numbersOf(row["frame_ms"]), megabytes = numbersOf(row["mb"]), flip = numbersOf(row["beauty_flip"]);
    std::istringstream names(row["value"].get<std::string>());
    size_t medium = 0, count = 0;
    for (std::string name; std::getline(names >> std::ws, name, ','); ++count)
    {
        ASSERT_LT(count, qualityLevels().size());
        EXPECT_EQ(name, qualityLevels()[count].name);
        if (name == "medium") medium = count;
    }
    ASSERT_EQ(count, qualityLevels().size());
    for (size_t i = 0; i < count; ++i)
    {
        const QualityLevel& level = qualityLevels()[i];
        EXPECT_NEAR(level.time, frame[i] / frame[medium], 0.02 * level.time) << level.name;
        EXPECT_NEAR(level.memory, megabytes[i] / megabytes[medium], 0.02 * level.memory) << level.name;
        EXPECT_NEAR(level.error, flip[i] / flip[medium], 0.02 * level.error) << level.name;
    }
}

} // namespace
} // namespace sconce
