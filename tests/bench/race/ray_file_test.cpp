#include "bench/race/ray_file.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace sconce
{
namespace
{

RaySet threeRays()
{
    RaySet set;
    set.diagonal = 5.0f;
    for (int i = 0; i < 3; ++i)
    {
        set.origins.emplace_back(i, 0.5f, -1.0f);
        set.directions.emplace_back(0.0f, 0.0f, 1.0f);
        set.normals.emplace_back(0.0f, 1.0f, 0.0f);
        set.truth.push_back({.hit = i != 1, .t = i == 1 ? 0.0f : float(i) + 0.25f});
    }
    set.viewpoints = {0, 4, 4};
    set.startCosine.assign(3, 1.0f);
    set.fartherTruth = set.truth;
    set.fartherTruth[2].t = 2.0f;
    return set;
}

TEST(RayFile, GivesBackRaysAndWhatJudgesThem)
{
    const testing_support::TestFolder folder;
    const RaySet set = threeRays();
    ASSERT_TRUE(saveRays(set, folder / "a.rays").ok());
    EXPECT_EQ(testing_support::readText(folder / "a.rays").size(), 32u + 3 * 48);
    const auto again = loadRays(folder / "a.rays");
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(again->diagonal, set.diagonal);
    EXPECT_EQ(again->origins, set.origins);
    EXPECT_EQ(again->directions, set.directions);
    EXPECT_EQ(again->normals, set.normals);
    EXPECT_EQ(again->viewpoints, set.viewpoints);
    for (size_t i = 0; i < set.size(); ++i)
        for (const TracedRay& traced : {TracedRay{TraceStatus::hit, 0.25f}, {TraceStatus::miss}, {TraceStatus::unknown}})
        {
            EXPECT_EQ(judge(again->truth[i], traced, again->diagonal), judge(set.truth[i], traced, set.diagonal)) << i;
            EXPECT_EQ(again->fartherTruth[i].t, set.fartherTruth[i].t) << i;
        }
}

TEST(RayFile, WhatIsNoRayFileIsASentence)
{
    const testing_support::TestFolder folder;
    const std::string file = folder / "a.rays";
    EXPECT_EQ(loadRays(file).error().code, ErrorCode::fileError);
    ASSERT_TRUE(saveRays(threeRays(), file).ok());
    const std::string whole = testing_support::readText(file);
    const auto complaint = [&](std::string text)
    {
        testing_support::writeText(file, text);
        const auto rays = loadRays(file);
        return rays ? std::string() : rays.error().message;
    };
    for (size_t length = 0; length < whole.size(); ++length) EXPECT_NE(complaint(whole.substr(0, length)), "") << length;
    EXPECT_NE(complaint(whole + "x").find("as long as it says"), std::string::npos);
    std::string other = whole;
    other[4] = 9;
    EXPECT_NE(complaint(other).find("another version"), std::string::npos);
    other = whole;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    other.replace(32 + 40, 4, reinterpret_cast<const char*>(&nan), 4);
    EXPECT_NE(complaint(other).find("not finite"), std::string::npos);
    other = whole;
    other.replace(32 + 44, 4, 4, char(0xff)); // one ray's viewpoint alone is not known
    EXPECT_NE(complaint(other).find("some rays alone"), std::string::npos);
    EXPECT_EQ(complaint(whole), "");
}

} // namespace
} // namespace sconce
