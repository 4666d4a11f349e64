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

// The grid of the one opponent that needs powers of two is another set than the others' grid of as many.
TEST(ProbeSetName, TellsSetsApart)
{
    EXPECT_EQ(probeSetName(asked("ours", "optimised", 54)), "optimised-54");
    EXPECT_EQ(probeSetName(asked("ours-grid", "grid", 64)), "grid-64");
    EXPECT_EQ(probeSetName(asked("b0plus", "grid", 64)), "grid-64");
    EXPECT_EQ(probeSetName(asked("b0", "grid", 64)), "grid2-64");
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
    EXPECT_EQ(free->name, "grid-27");
    const auto refused = placeFor(scene, asked("ours", "scattered", 4), {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find("'scattered'"), std::string::npos);
}

} // namespace
} // namespace sconce
