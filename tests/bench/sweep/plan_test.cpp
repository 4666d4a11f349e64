#include "bench/sweep/plan.h"

#include <set>

#include <gtest/gtest.h>

#include "bench/sweep/keys.h"
#include "bench/sweep/probe_sets.h"
#include "bench/sweep/sweep.h"
#include "bench/sweep/tune.h"
#include "scene/builtin_scenes.h"

namespace sconce
{
namespace
{

PlanSettings ofSixteen()
{
    PlanSettings settings;
    settings.probes = 16;
    return settings;
}

TEST(Plan, BeginsWithOursAndHasEveryMethodAndKnobOnce)
{
    const auto plan = planPoints(ofSixteen());
    ASSERT_TRUE(plan.ok()) << plan.error().message;
    EXPECT_EQ(plan->front().id, "ours/default");
    std::set<std::string> ids, methods, knobsOfOurs, settings;
    for (const PlannedPoint& point : *plan)
    {
        EXPECT_TRUE(ids.insert(point.id).second) << point.id;
        const bool fresh = settings.insert(point.settings.method + settingsJson(point.settings).dump()).second;
        EXPECT_TRUE(fresh || point.knob == "level") << point.id; // a level may be what another knob measures
        methods.insert(point.settings.method);
        if (point.settings.method == "ours") knobsOfOurs.insert(point.knob);
    }
    EXPECT_EQ(methods, (std::set<std::string>{"ours", "ours-grid", "b0", "b0plus", "b0plus-octree", "wang", "path tracer"}));
    for (const SweptKnob& knob : sweptKnobs())
        EXPECT_EQ(knobsOfOurs.contains(std::string(knob.name)), std::ranges::find(knob.methods, "ours") != knob.methods.end()) << knob.name;
}

TEST(Plan, AKnobThatIsNotThereIsASentence)
{
    PlanSettings settings = ofSixteen();
    settings.knobs = {"colour"};
    const auto plan = planPoints(settings);
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.error().message.find("no knob 'colour'; there are: probes"), std::string::npos) << plan.error().message;
}

TEST(Settings, OfEveryPlannedPointComeBackFromTheirJson)
{
    const auto plan = planPoints(ofSixteen());
    for (const PlannedPoint& point : *plan)
    {
        const auto again = settingsFrom(point.settings.method, settingsJson(point.settings));
        ASSERT_TRUE(again.ok()) << point.id << ": " << again.error().message;
        EXPECT_EQ(settingsJson(*again), settingsJson(point.settings)) << point.id;
    }
    EXPECT_FALSE(settingsFrom("ours", {{"colour", 1}}).ok());
    EXPECT_FALSE(settingsFrom("ours", {{"rays", "many"}}).ok());
    EXPECT_FALSE(settingsFrom(kPathTracer, {{"ranked", 2}}).ok());
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

TEST(Keys, TellScenesAndSettingsApart)
{
    Scene scene = *makeBuiltinScene("cornell");
    const std::string key = keyOf(scene);
    EXPECT_EQ(key, keyOf(*makeBuiltinScene("cornell")));
    scene.lights.push_back({});
    EXPECT_NE(key, keyOf(scene));
    scene = *makeBuiltinScene("cornell");
    scene.materials.back().roughness += 0.01f;
    EXPECT_NE(key, keyOf(scene));
    scene = *makeBuiltinScene("cornell");
    scene.name = "another name";
    EXPECT_EQ(key, keyOf(scene));
    EXPECT_NE(keyOf(Json{{"rays", 1}}), keyOf(Json{{"rays", 2}}));
}

TEST(PowerOfTwoShape, IsNearestInCountThenInShape)
{
    const auto shape = [](vec3 size, uint32_t count)
    {
        Bounds bounds;
        bounds.add(vec3(0.0f));
        bounds.add(size);
        return powerOfTwoShape(bounds, count);
    };
    EXPECT_EQ(shape({8, 3, 8}, 32), glm::ivec3(4, 2, 4));
    EXPECT_EQ(shape({1, 1, 1}, 8), glm::ivec3(2, 2, 2));
    EXPECT_EQ(shape({8, 1, 1}, 54), glm::ivec3(16, 2, 2)); // 64 is nearer in ratio than 32
    EXPECT_EQ(shape({5, 5, 5}, 1), glm::ivec3(1, 1, 1));
}

// Two groups of which the second ran while the machine was twice as busy: on one scale they agree.
TEST(ScaledPoints, BringGroupsToOneScale)
{
    const auto point = [](double frame, double yardstick) -> Json
    {
        return {{"id", "x"},
                {"frame_ms", {{"median", frame}, {"p5", frame / 2}, {"p95", frame * 2}, {"frames", 20}}},
                {"trace_ms", {{"median", frame / 10}, {"p5", 0.0}, {"p95", 0.0}, {"frames", 20}}},
                {"passes_ms", {{"glossy trace", frame / 10}}},
                {"yardstick_ms", {{"frame_ms", yardstick}, {"trace_ms", yardstick / 10}}}};
    };
    const std::vector<Json> scaled = scaledPoints({point(10, 10), point(40, 20), point(5, 10)});
    EXPECT_DOUBLE_EQ(scaled[0]["frame_ms"]["median"], 10.0);
    EXPECT_DOUBLE_EQ(scaled[1]["frame_ms"]["median"], 20.0);
    EXPECT_DOUBLE_EQ(scaled[1]["frame_ms"]["p95"], 40.0);
    EXPECT_DOUBLE_EQ(scaled[1]["trace_ms"]["median"], 2.0);
    EXPECT_DOUBLE_EQ(scaled[1]["passes_ms"]["glossy trace"], 2.0);
    EXPECT_DOUBLE_EQ(scaled[1]["time_scale"], 0.5);
    EXPECT_FALSE(scaled[1].contains("yardstick_ms"));
}

} // namespace
} // namespace sconce
