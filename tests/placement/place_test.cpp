#include "placement/place.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"
#include "tests/placement/box_scenes.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using namespace test;

PlaceSettings quick(uint32_t count)
{
    PlaceSettings settings;
    settings.count = count;
    settings.voxels = 100000;
    settings.candidates = 800;
    settings.surfels = 10000;
    return settings;
}

ProbeSet placed(const Scene& scene, const PlaceSettings& settings, PlaceReport& report)
{
    auto set = placeProbes(scene, settings, report);
    EXPECT_TRUE(set) << (set ? "" : set.error().message);
    return set ? std::move(*set) : ProbeSet{};
}

TEST(PlaceProbes, EveryProbeKeepsItsClearanceFromEveryTriangle)
{
    const Scene scene = furnishedRoom();
    for (const float clearance : {0.0f, 0.35f})
    {
        PlaceSettings settings = quick(24);
        settings.clearance = clearance;
        PlaceReport report;
        const ProbeSet set = placed(scene, settings, report);
        ASSERT_EQ(set.probes.size(), 24u);
        EXPECT_EQ(report.clearance, clearance > 0.0f ? clearance : report.voxel);
        for (const PlacedProbe& probe : set.probes)
        {
            EXPECT_GE(bruteDistance(scene, probe.position), report.clearance - 1e-5f) << probe.why;
            EXPECT_FALSE(probe.why.empty());
        }
        EXPECT_GT(report.coverageRays, 0.999f);
    }
}

TEST(PlaceProbes, StayOnTheReachableSideOfAThinWall)
{
    PlaceSettings settings = quick(12);
    settings.inside = {{5, 1, 2}};
    PlaceReport report;
    for (const PlacedProbe& probe : placed(dividedRoom(), settings, report).probes)
    {
        EXPECT_GT(probe.position.x, 4.0f);
        EXPECT_LT(probe.position.x, 6.0f);
    }
}

TEST(PlaceProbes, SameBytesOnOneAndTwoThreadsAndOtherSeedsDiffer)
{
    const Scene scene = furnishedRoom();
    const auto run = [&scene](size_t threads, uint64_t seed)
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        PlaceSettings settings = quick(10);
        settings.seed = seed;
        PlaceReport report;
        return placed(scene, settings, report);
    };
    const auto same = [](const ProbeSet& a, const ProbeSet& b)
    {
        return std::equal(a.probes.begin(), a.probes.end(), b.probes.begin(), b.probes.end(),
                          [](const PlacedProbe& x, const PlacedProbe& y) { return x.position == y.position && x.why == y.why; });
    };
    const ProbeSet one = run(1, 1);
    EXPECT_TRUE(same(one, run(2, 1)));
    EXPECT_TRUE(same(one, run(2, 1)));
    EXPECT_FALSE(same(one, run(2, 2)));
}

TEST(PlaceProbes, EmptyRoomNeedsOneProbe)
{
    PlaceSettings settings = quick(0);
    settings.coverage = 0.99f;
    PlaceReport report;
    EXPECT_EQ(placed(closedRoom({4, 3, 4}), settings, report).probes.size(), 1u);
    EXPECT_GT(report.coverageRays, 0.99f);
    EXPECT_NEAR(report.newlyCovered.at(0), 1.0f, 1e-3f);
}

TEST(PlaceProbes, BallShrinkingServesAsWellAsTheDistanceField)
{
    PlaceSettings settings = quick(8);
    settings.method = PlaceSettings::Method::balls;
    PlaceReport report;
    const ProbeSet set = placed(furnishedRoom(), settings, report);
    EXPECT_EQ(set.method, "balls");
    EXPECT_GT(report.coverageRays, 0.999f);
    for (const PlacedProbe& probe : set.probes) EXPECT_GE(bruteDistance(furnishedRoom(), probe.position), report.clearance - 1e-5f);
}

TEST(PlaceProbes, CountFollowsFromTheCoverageAskedFor)
{
    PlaceSettings settings = quick(0);
    size_t last = 0;
    for (const float coverage : {0.7f, 0.95f, 0.998f})
    {
        settings.coverage = coverage;
        PlaceReport report;
        const ProbeSet set = placed(furnishedRoom(), settings, report);
        EXPECT_GE(report.coverageRays, coverage - 0.002f);
        EXPECT_GT(set.probes.size(), last);
        EXPECT_LT(set.probes.size(), 16u);
        last = set.probes.size();
    }
}

TEST(PlaceProbes, GridFillsTheBoundsOfTheReachableSpace)
{
    PlaceSettings settings = quick(0);
    settings.method = PlaceSettings::Method::grid;
    settings.grid = {2, 3, 4};
    settings.inside = {{5, 1, 2}};
    PlaceReport report;
    const ProbeSet set = placed(dividedRoom(), settings, report);
    ASSERT_TRUE(set.grid);
    ASSERT_EQ(set.probes.size(), 24u);
    // The reachable room is [4,6] x [0,3] x [0,4]: cells of 1 m each way, within the field's resolution.
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 2; ++x)
            {
                const vec3 p = set.probes[size_t(x + 2 * (y + 3 * z))].position;
                EXPECT_LT(glm::length(p - (vec3(4.5f, 0.5f, 0.5f) + vec3(x, y, z))), 2.0f * report.voxel);
                EXPECT_EQ(p, set.grid->origin + set.grid->step * vec3(x, y, z));
            }
    EXPECT_EQ(report.gridOutside, 0u);
}

TEST(PlaceProbes, GridKeepsItsPointsInSolids)
{
    PlaceSettings settings = quick(0);
    settings.method = PlaceSettings::Method::grid;
    settings.grid = {20, 10, 13};
    PlaceReport report;
    const ProbeSet set = placed(furnishedRoom(), settings, report);
    EXPECT_EQ(set.probes.size(), 2600u);
    EXPECT_GT(report.gridOutside, 20u);
}

TEST(PlaceProbes, KeptProbesStayAndCount)
{
    const Scene scene = furnishedRoom();
    PlaceSettings settings = quick(6);
    const std::vector<vec3> kept{{0.5f, 2.5f, 0.5f}, {0.8f, 0.4f, 3.5f}};
    for (const vec3& position : kept) settings.pins.push_back({Pin::Kind::keep, position, 0.0f});
    PlaceReport report;
    const ProbeSet set = placed(scene, settings, report);
    ASSERT_EQ(set.probes.size(), 6u);
    for (const vec3& position : kept)
    {
        const auto found = std::find_if(set.probes.begin(), set.probes.end(), [&](const PlacedProbe& p) { return p.position == position; });
        ASSERT_NE(found, set.probes.end());
        EXPECT_NE(found->why.find("kept"), std::string::npos) << found->why;
    }
    EXPECT_GT(report.coverageRays, 0.999f);
}

TEST(PlaceProbes, AddedProbesComeOnTop)
{
    PlaceSettings settings = quick(3);
    settings.pins = {{Pin::Kind::add, {0.5f, 2.5f, 0.5f}, 0.0f}, {Pin::Kind::keep, {5.5f, 2.5f, 3.5f}, 0.0f}};
    PlaceReport report;
    const ProbeSet set = placed(furnishedRoom(), settings, report);
    ASSERT_EQ(set.probes.size(), 4u);
    EXPECT_EQ(report.alone.size(), 4u);
    EXPECT_EQ(std::count_if(set.probes.begin(), set.probes.end(), [](const PlacedProbe& p) { return p.why.starts_with("added"); }), 1);
    settings.count = 0; // the fewest that see enough, and the pinned
    settings.coverage = 0.6f;
    EXPECT_GE(placed(furnishedRoom(), settings, report).probes.size(), 2u);
}

TEST(PlaceProbes, ForbiddenPlacesStayEmpty)
{
    PlaceSettings settings = quick(12);
    const Pin forbidden{Pin::Kind::forbid, {1.5f, 1.5f, 2.0f}, 1.4f};
    PlaceReport report;
    const auto within = [&](const ProbeSet& set)
    {
        return std::count_if(set.probes.begin(), set.probes.end(),
                             [&](const PlacedProbe& p) { return glm::distance(p.position, forbidden.position) <= forbidden.radius; });
    };
    EXPECT_GT(within(placed(furnishedRoom(), settings, report)), 0);
    settings.pins = {forbidden};
    EXPECT_EQ(within(placed(furnishedRoom(), settings, report)), 0);
}

TEST(PlaceProbes, ARunWithItsOwnProbesPinnedGivesThemBack)
{
    PlaceSettings settings = quick(5);
    PlaceReport report;
    const ProbeSet set = placed(furnishedRoom(), settings, report);
    for (const PlacedProbe& probe : set.probes) settings.pins.push_back({Pin::Kind::keep, probe.position, 0.0f});
    const ProbeSet again = placed(furnishedRoom(), settings, report);
    ASSERT_EQ(again.probes.size(), 5u);
    for (const PlacedProbe& probe : set.probes)
        EXPECT_TRUE(
            std::any_of(again.probes.begin(), again.probes.end(), [&](const PlacedProbe& p) { return p.position == probe.position; }));
}

TEST(PlaceProbes, PinsThatCannotBeAreNamed)
{
    const auto messageOf = [](std::vector<Pin> pins, uint32_t count = 2, ErrorCode code = ErrorCode::badArgument)
    {
        PlaceSettings settings = quick(count);
        settings.inside = {{5, 1, 2}};
        settings.clearance = 0.3f;
        settings.pins = std::move(pins);
        PlaceReport report;
        const auto set = placeProbes(dividedRoom(), settings, report);
        EXPECT_FALSE(set);
        if (!set)
        {
            EXPECT_EQ(set.error().code, code);
        }
        return set ? std::string() : set.error().message;
    };
    const vec3 good(5, 1, 2);
    EXPECT_NE(messageOf({{Pin::Kind::keep, {1, 1, 2}, 0}}).find("(1, 1, 2) lies in solid or outside"), std::string::npos);
    EXPECT_NE(messageOf({{Pin::Kind::keep, {5, 1, 0.2f}, 0}}).find("clearance of 0.3 m"), std::string::npos);
    EXPECT_NE(messageOf({{Pin::Kind::add, good, 0}, {Pin::Kind::forbid, good, 1}}).find("forbidden"), std::string::npos);
    EXPECT_NE(messageOf({{Pin::Kind::keep, good, 0}, {Pin::Kind::keep, {5, 2, 2}, 0}}, 1).find("2 probes are kept"), std::string::npos);
    EXPECT_NE(messageOf({{Pin::Kind::forbid, good, 100}}, 2, ErrorCode::badInput).find("forbidden"), std::string::npos);
    EXPECT_NE(messageOf({{Pin::Kind::keep, {NAN, 1, 2}, 0}}).find("nan"), std::string::npos);
}

TEST(PlaceProbes, BadSettingsAreNamed)
{
    const Scene scene = closedRoom({4, 3, 4});
    const auto messageOf = [&scene](auto change)
    {
        PlaceSettings settings = quick(4);
        change(settings);
        PlaceReport report;
        const auto set = placeProbes(scene, settings, report);
        EXPECT_FALSE(set);
        if (set) return std::string();
        EXPECT_EQ(set.error().code, ErrorCode::badArgument);
        return set.error().message;
    };
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.count = 65536; }).find("65536"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.coverage = 0; }).find("coverage"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.coverage = NAN; }).find("coverage"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.clearance = -1; }).find("clearance"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.voxels = 1; }).find("voxels"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.inside = {{INFINITY, 0, 0}}; }).find("inside"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.grid = {2, 2, 2}; }).find("grid"), std::string::npos);
    EXPECT_NE(messageOf([](PlaceSettings& s) { s.method = PlaceSettings::Method::grid, s.pins = {{}}; }).find("pins"), std::string::npos);
    const auto grid = [](PlaceSettings& s, glm::ivec3 shape) { s.method = PlaceSettings::Method::grid, s.count = 0, s.grid = shape; };
    EXPECT_NE(messageOf([&](PlaceSettings& s) { grid(s, {2, 0, 2}); }).find("2x0x2"), std::string::npos);
    EXPECT_NE(messageOf([&](PlaceSettings& s) { grid(s, {60000, 60000, 60000}); }).find("60000"), std::string::npos);
}

TEST(PlaceProbes, ClearanceThatNoPositionKeepsIsNamed)
{
    PlaceSettings settings = quick(4);
    settings.clearance = 1.6f; // the room is 3 m high
    PlaceReport report;
    const auto set = placeProbes(closedRoom({4, 3, 4}), settings, report);
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::badInput);
    EXPECT_NE(set.error().message.find("1.6 m"), std::string::npos) << set.error().message;
}

TEST(PlaceProbes, SceneWithoutTrianglesGetsASentence)
{
    PlaceReport report;
    const auto set = placeProbes(emptyScene(), quick(4), report);
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::badInput);
    EXPECT_FALSE(set.error().message.empty());
}

TEST(PlaceProbes, CancellingEndsTheWork)
{
    PlaceReport report;
    int calls = 0;
    const auto set = placeProbes(furnishedRoom(), quick(4), report, [&calls](std::string_view, double) { return ++calls < 4; });
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().code, ErrorCode::cancelled);
    EXPECT_EQ(calls, 4);
}

// The yardstick: plain greedy cover over 1,500 random free points sees 99.64 % with 54 probes (measured apart from this project).
TEST(PlaceProbes, SponzaIsSeenBy54Probes)
{
    const std::filesystem::path file = testing_support::scenesFolder() / "sponza" / "Sponza.gltf";
    if (!std::filesystem::exists(file.parent_path())) GTEST_SKIP() << "the scene sponza is not in " << file.parent_path();
    const auto scene = loadGltf(file);
    ASSERT_TRUE(scene) << scene.error().message;
    PlaceSettings settings;
    settings.count = 54;
    settings.voxels = 4u << 20;
    settings.candidates = 2000;
    settings.surfels = 20000;
    PlaceReport report;
    const ProbeSet set = placed(*scene, settings, report);
    ASSERT_EQ(set.probes.size(), 54u);
    EXPECT_GE(report.coverageRays, 0.9976f); // found: 0.99815, three standard errors above
    // The atrium and its arcades, not the roof and the outside: the scene's box is 51 x 21 x 31 m.
    EXPECT_LT(report.reachable.size().x, 40.0f);
    EXPECT_LT(report.reachable.size().z, 20.0f);
}

// The same count in the same bounds.
TEST(PlaceProbes, TempleIsSeenBetterThanByAGrid)
{
    const auto scene = makeBuiltinScene("temple");
    ASSERT_TRUE(scene) << scene.error().message;
    PlaceSettings settings = quick(16);
    PlaceReport ours, grid;
    placed(*scene, settings, ours);
    settings.method = PlaceSettings::Method::grid;
    const ProbeSet uniform = placed(*scene, settings, grid);
    EXPECT_LE(uniform.probes.size(), 18u);
    EXPECT_GT(ours.coverageRays, 0.98f);
    EXPECT_GT(ours.coverageRays, grid.coverageRays);
}

} // namespace
} // namespace sconce
