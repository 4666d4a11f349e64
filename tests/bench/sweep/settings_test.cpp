#include "bench/sweep/settings.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "bench/sweep/plan.h"
#include "bench/sweep/tune.h"

namespace sconce
{
namespace
{

TEST(Settings, OfEveryPlannedPointComeBackFromTheirJson)
{
    PlanSettings ofSixteen;
    ofSixteen.probes = 16;
    const auto plan = planPoints(ofSixteen);
    ASSERT_TRUE(plan.ok()) << plan.error().message;
    for (const PlannedPoint& point : *plan)
    {
        const auto again = settingsFrom(point.settings.method, settingsJson(point.settings));
        ASSERT_TRUE(again.ok()) << point.id << ": " << again.error().message;
        EXPECT_EQ(settingsJson(*again), settingsJson(point.settings)) << point.id;
    }
}

TEST(Settings, WhatAMethodDoesNotHaveIsASentence)
{
    const auto fault = [](const char* method, const Json& json)
    {
        const auto made = settingsFrom(method, json);
        return made.ok() ? "" : made.error().message;
    };
    EXPECT_EQ(fault("ours", {{"colour", 1}}), "Method 'ours' has no knob 'colour'.");
    EXPECT_EQ(fault("ours", {{"low factor", 8}}), "Method 'ours' has no knob 'low factor'.");
    EXPECT_EQ(fault(kPathTracer, {{"ranked", 2}}), "Method 'path tracer' has no knob 'ranked'.");
    const std::string range = "; give 1 to 64 rays a pixel.";
    EXPECT_EQ(fault("ours", {{"rays", "many"}}), "Knob 'rays' can't be \"many\"" + range);
    for (const Json& wrong : {Json(1.5), Json(-1), Json(""), Json("2 "), Json("+2"), Json(nullptr), Json(4294967296ull)})
        EXPECT_EQ(fault("ours", {{"rays", wrong}}), "Knob 'rays' can't be " + wrong.dump() + range);
    for (const Json& wrong : {Json("yes"), Json(true), Json(1), Json("")})
        EXPECT_EQ(fault("ours", {{"denoise", wrong}}), "Knob 'denoise' can't be " + wrong.dump() + "; give on, off.");
    EXPECT_NE(fault("ours", Json::array()), "");
}

TEST(Settings, NumbersAreReadHoweverTheyAreWritten)
{
    const auto text = settingsFrom("ours", {{"rays", "4"}, {"opinion", "0.002"}}),
               number = settingsFrom("ours", {{"rays", 4}, {"opinion", 2e-3}});
    ASSERT_TRUE(text.ok() && number.ok());
    EXPECT_EQ(text->frame.glossyRays, 4u);
    EXPECT_EQ(text->quality.trace.opinion, 0.002f);
    EXPECT_EQ(settingsJson(*text), settingsJson(*number));
    EXPECT_EQ(settingsJson(*text)["opinion"].dump(), "0.002") << "as it is spelled, not as the float's double";
}

TEST(Settings, AStageLeavesOutWhatIsDecidedLater)
{
    PointSettings settings;
    EXPECT_EQ(settingsJson(settings, Stage::place).size(), 2u); // probes, placement
    std::set<std::string> before;
    for (const Stage stage : {Stage::place, Stage::bake, Stage::trace, Stage::frame})
    {
        std::set<std::string> now;
        const Json json = settingsJson(settings, stage); // must outlive its items
        for (const auto& [name, value] : json.items())
        {
            now.insert(name);
            EXPECT_LE(findKnob(name)->stage, stage) << name;
        }
        EXPECT_TRUE(std::ranges::includes(now, before));
        EXPECT_GT(now.size(), before.size());
        before = now;
    }
}

TEST(Settings, ChartIsTheOneThatTheMethodReads)
{
    const auto chart = [](const char* method)
    {
        PointSettings settings;
        settings.method = method;
        return settings.chart();
    };
    for (const char* method : {"ours", "ours-grid", "wang"}) EXPECT_EQ(chart(method), gpu::kChartCube) << method;
    for (const char* method : {"b0", "b0plus", "b0plus-octree"}) EXPECT_EQ(chart(method), gpu::kChartOctahedral) << method;
}

// "field" for a knob that is on or off was left out of the sweep without a word.
TEST(Settings, EveryValueOfASweepIsOneOfItsKnob)
{
    for (const SweptKnob& knob : sweptKnobs())
        for (const std::string_view value : knob.sweep)
        {
            PointSettings settings;
            EXPECT_TRUE(knob.set(settings, value)) << knob.name << " " << value;
        }
    for (const QualityLevel& level : qualityLevels()) // by the values' texts, as files of settings have them
    {
        PointSettings settings;
        applyLevel(settings, level);
        EXPECT_TRUE(settingsFrom("ours", settingsJson(settings)).ok()) << level.name;
    }
}

// `set` holds to the table: nothing beyond a knob's range can be swept or come from a file.
TEST(Settings, AValueBeyondTheRangeOfItsKnobIsRefused)
{
    PointSettings settings;
    for (const auto& [name, value] : {std::pair{"rays", "65"}, std::pair{"rays", "0"}, std::pair{"trace every", "3"},
                                      std::pair{"opinion", "nan"}, std::pair{"placement", "anywhere"}, std::pair{"hand-offs", "65"}})
        EXPECT_FALSE(findKnob(name)->set(settings, value)) << name << " " << value;
    EXPECT_EQ(settingsJson(settings), settingsJson(PointSettings()));
    EXPECT_NE(settingsFrom("ours", {{"rays", 65}}).error().message.find("give 1 to 64 rays a pixel"), std::string::npos);
}

} // namespace
} // namespace sconce
