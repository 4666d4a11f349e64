// Which points stand on the device together to be timed, where it has room for few.
#include <filesystem>

#include <gtest/gtest.h>

#include "bench/sweep/sweep.h"
#include "scene/builtin_scenes.h"
#include "tests/support/device.h"
#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

using testing_support::TestFolder;
using testing_support::ValidatedDevice;

struct Swept
{
    std::vector<Json> points;
    uint64_t peakBytes = 0; // of device memory
};

/// Points that all share one light field of 33 MiB.
std::vector<PlannedPoint> pointsOfOneField()
{
    PlanSettings plan;
    plan.probes = 16;
    plan.methods = {"ours"};
    plan.knobs = {"ranked", "hand-offs"};
    plan.ours.placement = "grid";
    plan.ours.resolution = 512;
    plan.ours.surfaceTexels = 0;
    plan.ours.bounces = 0;
    auto points = planPoints(plan);
    EXPECT_TRUE(points) << points.error().message;
    return *points;
}

std::unique_ptr<SceneBench> benchOfCornell(ValidatedDevice& device, const TestFolder& folder, const PlannedPoint& first,
                                           const std::string& build)
{
    SceneBench::Desc desc;
    desc.name = "cornell";
    auto scene = makeBuiltinScene("cornell");
    EXPECT_TRUE(scene) << scene.error().message;
    desc.scene = std::move(*scene);
    desc.folder = folder.path;
    desc.build = build;
    desc.settings.width = 32;
    desc.settings.height = 18;
    desc.settings.rays = 500;
    desc.settings.frames = desc.settings.warmUp = 1;
    desc.settings.referencePaths = 4;
    desc.settings.pictures = desc.settings.judgeGrids = false;
    auto bench = SceneBench::create(device.gpu(), "device", std::move(desc), first.settings, {});
    EXPECT_TRUE(bench) << bench.error().message;
    return std::move(*bench);
}

/// The first `count` of these points, measured on a device with so much memory.
/// @param folder  whose field is kept for the next of these
Swept sweepWithin(const TestFolder& folder, uint64_t memoryBudget, size_t count)
{
    std::filesystem::remove_all(folder.path / "cache" / "points"); // so that they are measured anew
    ValidatedDevice device(memoryBudget);
    auto points = pointsOfOneField();
    points.resize(std::min(count, points.size()));
    Swept swept;
    {
        const auto bench = benchOfCornell(device, folder, points.front(), "a build");
        const auto publish = [&](const std::vector<Json>& measured)
        {
            swept.points = measured;
            return success();
        };
        const Status status = sweepScene(*bench, points, publish, [](const std::string&) {}, {});
        EXPECT_TRUE(status) << status.error().message;
    }
    swept.peakBytes = device.gpu().memory().peak();
    return swept;
}

TEST(Sweep, APointThatFindsNoMemoryBesideOthersIsMeasuredInTheNextGroup)
{
    const TestFolder folder;
    sweepWithin(folder, 0, 1); // bakes the field, which takes more than measuring
    const Swept one = sweepWithin(folder, 0, 1);
    ASSERT_TRUE(std::filesystem::exists(folder.path / "cache" / "points"));
    const Swept two = sweepWithin(folder, 0, 2);
    ASSERT_GT(two.peakBytes, one.peakBytes) << "a second point takes nothing more, and nothing is tested";
    const Swept all = sweepWithin(folder, two.peakBytes, 4);
    ASSERT_EQ(all.points.size(), 4u);
    for (const Json& point : all.points)
    {
        EXPECT_TRUE(point["wrong"].is_null()) << point["id"] << ": " << point["wrong"];
        EXPECT_TRUE(point.contains("frame_ms")) << point["id"];
    }
}

TEST(Sweep, WhatAnotherBuildMeasuredIsNotKept)
{
    const TestFolder folder;
    ValidatedDevice device;
    const auto points = pointsOfOneField();
    const auto first = benchOfCornell(device, folder, points.front(), "0123456789abcdef");
    ASSERT_TRUE(first->keep(points.front(), Json{{"measured", true}}));
    ASSERT_TRUE(first->kept(points.front()).has_value());
    EXPECT_FALSE(benchOfCornell(device, folder, points.front(), "0123456789abcde0")->kept(points.front()).has_value());
    EXPECT_TRUE(benchOfCornell(device, folder, points.front(), "0123456789abcdef")->kept(points.front()).has_value());
}

} // namespace
} // namespace sconce
