#include "bench/sweep/probe_sets.h"

#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"

namespace sconce
{
namespace
{

PointSettings asked(const char* method, const char* placement, uint32_t probes)
{
    PointSettings settings;
    settings.method = method;
    settings.placement = placement;
    settings.probes = probes;
    return settings;
}

// A grid is a method's own, chosen by what that method answers on it; lists of the octree's probes are shared.
TEST(ProbeSetName, TellsSetsApart)
{
    EXPECT_EQ(probeSetName(asked("ours", "optimised", 54)), "optimised-54");
    EXPECT_EQ(probeSetName(asked("b0plus-octree", "optimised", 54)), "optimised-54");
    EXPECT_EQ(probeSetName(asked("ours-grid", "grid", 64)), "grid-ours-grid-64");
    EXPECT_EQ(probeSetName(asked("b0plus", "grid", 64)), "grid-b0plus-64");
    EXPECT_EQ(probeSetName(asked("b0", "grid", 64)), "grid-b0-64");
    EXPECT_EQ(probeSetName(asked("ddgi-placed", "optimised", 64)), "optimised-64");
}

// Of all shapes and poses the one that is judged best, whatever the judge likes; its errors are passed on.
TEST(PlaceFor, TakesTheGridThatItsJudgeFindsBest)
{
    const Scene scene = *makeBuiltinScene("cornell");
    const PointSettings settings = asked("ours-grid", "grid", 27);
    std::vector<ProbeGrid> seen;
    const auto taken = [&](const auto& wrongOf)
    {
        seen.clear();
        auto made = placeFor(scene, settings, {},
                             [&](const ProbeGrid& grid) -> Result<double>
                             {
                                 seen.push_back(grid);
                                 return wrongOf(grid);
                             });
        EXPECT_TRUE(made.ok());
        return *made->set.grid;
    };
    const ProbeGrid widest = taken([](const ProbeGrid& grid) { return -double(grid.step.x * float(grid.count.x - 1)); });
    ASSERT_GT(seen.size(), 3u);
    for (const ProbeGrid& grid : seen) EXPECT_LE(grid.step.x * float(grid.count.x - 1), widest.step.x * float(widest.count.x - 1) + 1e-5f);
    const ProbeGrid narrowest = taken([](const ProbeGrid& grid) { return double(grid.step.x * float(grid.count.x - 1)); });
    EXPECT_LT(narrowest.step.x * float(narrowest.count.x - 1), 0.9f * widest.step.x * float(widest.count.x - 1));
    const auto failed = placeFor(scene, settings, {},
                                 [](const ProbeGrid&) -> Result<double> {
                                     return Error{ErrorCode::outOfMemory, "no room"};
                                 });
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().message, "no room");
}

TEST(PlaceFor, MakesTheGridThatTheMethodNeedsAndNamesWhatItDoesNotKnow)
{
    const Scene scene = *makeBuiltinScene("cornell");
    const auto powers = placeFor(scene, asked("b0", "grid", 27), {}), free = placeFor(scene, asked("ours-grid", "grid", 27), {});
    ASSERT_TRUE(powers.ok()) << powers.error().message;
    ASSERT_TRUE(free.ok()) << free.error().message;
    const auto product = [](glm::ivec3 count) { return count.x * count.y * count.z; };
    const glm::ivec3 shape = powers->set.grid->count;
    EXPECT_EQ(product(shape), 32); // of the powers of two the nearest to 27
    EXPECT_NEAR(product(free->set.grid->count), 27, 4) << free->report.dump();
    EXPECT_EQ(powers->report["grid"], Json::array({shape.x, shape.y, shape.z}));
    EXPECT_EQ(free->name, "grid-ours-grid-27");
    const auto refused = placeFor(scene, asked("ours", "scattered", 4), {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find("'scattered'"), std::string::npos);
}

} // namespace
} // namespace sconce
