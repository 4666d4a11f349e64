#include "placement/coverage.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

CoverageSettings settingsOf(size_t points)
{
    CoverageSettings settings;
    settings.points = points;
    settings.voxels = 200000;
    return settings;
}

TEST(Coverage, OneProbeSeesAllOfAnEmptyRoom)
{
    const auto coverage = measureCoverage(closedRoom({4, 3, 4}), std::vector<vec3>{{2, 1.5f, 2}}, settingsOf(20000));
    ASSERT_TRUE(coverage) << coverage.error().message;
    EXPECT_EQ(coverage->rays, 1.0f);
    EXPECT_EQ(coverage->area, 1.0f);
    EXPECT_TRUE(coverage->unseen.empty());
}

TEST(Coverage, NoProbesSeeNothing)
{
    const auto coverage = measureCoverage(closedRoom({4, 3, 4}), {}, settingsOf(1000));
    ASSERT_TRUE(coverage);
    EXPECT_EQ(coverage->rays, 0.0f);
    EXPECT_EQ(coverage->unseen.size(), coverage->rayPoints);
}

// Truth without Embree, OpenVDB or our samplers: rays and views tested against every triangle in double precision; free points are drawn in
// the room and rejected in the crates, whose places are known.
TEST(Coverage, AgreesWithABruteForceRayCasterInAFurnishedRoom)
{
    const Scene scene = furnishedRoom();
    const std::vector<vec3> probes{{2.2f, 1.9f, 3.2f}, {0.4f, 0.4f, 0.4f}};
    const auto solid = [](glm::dvec3 p)
    {
        const auto in = [&p](glm::dvec3 low, glm::dvec3 high)
        { return glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high)); };
        return in({3.0, 0, 0}, {3.2, 2.4, 3.0}) || in({1.0, 0, 1.0}, {1.8, 0.8, 1.9}) || in({4.5, 0, 1.6}, {4.9, 3.0, 2.1});
    };
    Random random(77, 0);
    const int wanted = 20000;
    int rays = 0, seen = 0;
    while (rays < wanted)
    {
        const glm::dvec3 origin(6.0 * double(random.uniform()), 3.0 * double(random.uniform()), 4.0 * double(random.uniform()));
        const glm::dvec3 direction(random.direction());
        if (solid(origin)) continue;
        double nearest = 1e300;
        glm::dvec3 normal(0.0);
        for (const uvec3& triangle : scene.triangles)
        {
            const glm::dvec3 a(scene.positions[triangle.x]);
            const glm::dvec3 e1 = glm::dvec3(scene.positions[triangle.y]) - a, e2 = glm::dvec3(scene.positions[triangle.z]) - a;
            const glm::dvec3 p = glm::cross(direction, e2), s = origin - a, q = glm::cross(s, e1);
            const double determinant = glm::dot(e1, p);
            if (std::abs(determinant) < 1e-14) continue;
            const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant, t = glm::dot(e2, q) / determinant;
            if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || t >= nearest) continue;
            nearest = t;
            normal = glm::normalize(glm::cross(e1, e2));
        }
        ASSERT_LT(nearest, 1e300);
        if (glm::dot(normal, direction) > 0.0) normal = -normal;
        const glm::dvec3 point = origin + nearest * direction;
        ++rays;
        for (const vec3& probe : probes)
        {
            const glm::dvec3 toProbe = glm::dvec3(probe) - point;
            if (glm::dot(toProbe, normal) <= 0.05 * glm::length(toProbe) || bruteBlocked(scene, point + 1e-6 * normal, glm::dvec3(probe)))
                continue;
            ++seen;
            break;
        }
    }
    const double truth = double(seen) / double(rays);
    const auto coverage = measureCoverage(scene, probes, settingsOf(60000));
    ASSERT_TRUE(coverage) << coverage.error().message;
    ASSERT_GT(truth, 0.3);
    ASSERT_LT(truth, 0.9);
    // Four standard errors of both samples, and the rim of half a cell that the grid leaves out of the free space.
    EXPECT_NEAR(double(coverage->rays), truth, 0.02);
}

// Of two closed rooms, a probe in one sees all of it and nothing of the other.
// side's floor.
TEST(Coverage, ClosedOffRoomIsSeenOnlyByItsOwnProbe)
{
    const Scene scene = dividedRoom();
    CoverageSettings settings = settingsOf(20000);
    settings.inside = {{1, 1, 2}, {5, 1, 2}};
    const auto coverage = measureCoverage(scene, std::vector<vec3>{{2, 1.5f, 2}}, settings);
    ASSERT_TRUE(coverage);
    // Rooms of 80 and 52 square metres (4x3x4 and 2x3x4), both sides of the thin wall counted.
    EXPECT_NEAR(coverage->area, 80.0f / 132.0f, 0.02f);
    // Random rays start in proportion to volume and always hit something.
    EXPECT_NEAR(coverage->rays, 48.0f / 72.0f, 0.02f);
}

TEST(Coverage, NonFiniteProbeIsRefused)
{
    const auto coverage = measureCoverage(closedRoom({4, 3, 4}), std::vector<vec3>{{NAN, 0, 0}}, settingsOf(1000));
    ASSERT_FALSE(coverage);
    EXPECT_EQ(coverage.error().code, ErrorCode::badArgument);
}

} // namespace
} // namespace sconce
