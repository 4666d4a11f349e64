#include "bench/sweep/plan.h"

#include <set>

#include <gtest/gtest.h>

#include "bench/opponents/irradiance_volume.h"
#include "bench/sweep/sweep.h"
#include "runtime/field/field_data.h"

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
    EXPECT_EQ(methods, (std::set<std::string>{"ours", "ours-grid", "b0", "b0plus", "b0plus-octree", "wang", "ddgi", "ddgi-placed",
                                              "sh-grid", "path tracer", "path tracer filtered"}));
    for (const SweptKnob& knob : sweptKnobs())
        EXPECT_EQ(knobsOfOurs.contains(std::string(knob.name)), std::ranges::find(knob.methods, "ours") != knob.methods.end()) << knob.name;
}

// An octahedral opponent gets the largest maps that take no more bytes than our cube faces.
TEST(Plan, OctahedralMapsTakeAsMuchMemoryAsCubeFaces)
{
    for (const uint32_t resolution : {192u, 256u, 416u, 512u})
    {
        PlanSettings settings = ofSixteen();
        settings.ours.resolution = resolution;
        settings.methods = {"b0plus"};
        settings.methodsOnly = true;
        const auto plan = planPoints(settings);
        ASSERT_TRUE(plan && plan->size() == 1);
        const uint32_t theirs = plan->front().settings.resolution;
        const size_t bytes = bytesPerProbe(gpu::kChartCube, resolution);
        EXPECT_EQ(theirs % 16, 0u);
        EXPECT_LE(bytesPerProbe(gpu::kChartOctahedral, theirs), bytes) << resolution;
        EXPECT_GT(bytesPerProbe(gpu::kChartOctahedral, theirs + 16), bytes) << resolution;
    }
}

// A volume is shown with as many bytes as ours reads diffuse light from, too.
TEST(Plan, VolumesHaveAsManyBytes)
{
    PlanSettings settings = ofSixteen();
    settings.methods = {"ddgi"};
    settings.methodsOnly = true;
    const auto plan = planPoints(settings);
    ASSERT_TRUE(plan);
    size_t larger = 0;
    const double face = settings.ours.resolution / 2;
    for (const PlannedPoint& point : *plan)
    {
        if (point.knob != "probes") continue;
        ++larger;
        const double bytes = 4.0 * volumeWordsPerProbe(Volume::ddgi) * point.settings.probes,
                     ours =
                         16.0 * double(bytesPerProbe(gpu::kChartCube, settings.ours.resolution, 52) -
                                       bytesPerProbe(gpu::kChartCube, settings.ours.resolution, 0) + 2 * gpu::kPatches * sizeof(uint32_t)) +
                         16.0 * 4.0 * 6.0 * face * face;
        EXPECT_NEAR(bytes, ours, 0.01 * ours);
    }
    EXPECT_EQ(larger, 1u);
}

TEST(Plan, AKnobThatIsNotThereIsASentence)
{
    PlanSettings settings = ofSixteen();
    settings.knobs = {"colour"};
    const auto plan = planPoints(settings);
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.error().message.find("no knob 'colour'; there are: probes"), std::string::npos) << plan.error().message;
}

TEST(Plan, OnlyTheMethodsThatAreAskedFor)
{
    PlanSettings settings = ofSixteen();
    settings.methods = {"ddgi", "path tracer"};
    const auto plan = planPoints(settings);
    ASSERT_TRUE(plan.ok());
    std::set<std::string> methods;
    for (const PlannedPoint& point : *plan) methods.insert(point.settings.method);
    EXPECT_EQ(methods, (std::set<std::string>{"ddgi", "path tracer"}));
    settings.methods = {"ours", "theirs"};
    const auto none = planPoints(settings);
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().message.find("no method 'theirs'; there are: ours, ours-grid"), std::string::npos) << none.error().message;
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
