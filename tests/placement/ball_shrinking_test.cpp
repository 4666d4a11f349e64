#include "placement/ball_shrinking.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

struct Place
{
    explicit Place(Scene made) : scene(std::move(made)) {}
    Scene scene;
    Result<Visibility> visibility = Visibility::build(scene);
    Result<FreeSpace> space = findFreeSpace(scene, *visibility, {}, 100000);
    std::vector<Candidate> candidates(size_t count, float clearance, std::span<const Pin> pins = {}) const
    {
        return ballCandidates(scene, {*visibility, *space, pins}, count, clearance, 3);
    }
};

// The medial axis of a box is where its two nearest walls are equally far. Centroids of groups that span a branching may leave it.
TEST(BallCandidates, LieOnTheMedialAxisOfARoom)
{
    const vec3 size(6, 3, 4);
    const Place place(closedRoom(size));
    const std::vector<Candidate> candidates = place.candidates(2000, 0.1f);
    ASSERT_GT(candidates.size(), 1000u);
    ASSERT_LE(candidates.size(), 2000u);
    size_t near = 0;
    for (const Candidate& candidate : candidates)
    {
        const vec3 p = candidate.position;
        float walls[6] = {p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z};
        std::sort(walls, walls + 6);
        near += walls[1] - walls[0] < 0.3f;
        EXPECT_EQ(candidate.origin, Candidate::Origin::ball);
    }
    EXPECT_GT(double(near), 0.9 * double(candidates.size()));
}

// Between two walls far wider than apart every largest ball is as wide as half the gap.
TEST(BallCandidates, AreHalfWayBetweenParallelWalls)
{
    const Place place(closedRoom({12, 1, 12}));
    size_t inner = 0;
    for (const Candidate& candidate : place.candidates(1000, 0.05f))
    {
        const vec3 p = candidate.position;
        if (std::min({p.x, p.z, 12 - p.x, 12 - p.z}) < 1.5f) continue;
        EXPECT_NEAR(p.y, 0.5f, 0.02f);
        ++inner;
    }
    EXPECT_GT(inner, 50u);
}

TEST(BallCandidates, AreLegalWhereCentroidsAreNot)
{
    const Place place(furnishedRoom());
    const Pin forbidden{Pin::Kind::forbid, {1.5f, 1.5f, 2.0f}, 1.0f};
    for (const size_t count : {6u, 40u, 600u}) // few and wide groups have centroids anywhere
    {
        const std::vector<Candidate> candidates = place.candidates(count, 0.25f, {&forbidden, 1});
        EXPECT_GT(candidates.size(), 0u);
        EXPECT_LE(candidates.size(), count);
        for (const Candidate& candidate : candidates)
        {
            EXPECT_GE(bruteDistance(place.scene, candidate.position), 0.25 - 1e-5);
            EXPECT_GT(glm::distance(candidate.position, forbidden.position), forbidden.radius);
        }
    }
}

TEST(BallCandidates, SameForAnyNumberOfThreads)
{
    const Place place(furnishedRoom());
    std::vector<std::vector<Candidate>> runs;
    for (const size_t threads : {1u, 2u})
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        runs.push_back(place.candidates(100, 0.1f));
    }
    EXPECT_TRUE(std::equal(runs[0].begin(), runs[0].end(), runs[1].begin(), runs[1].end(),
                           [](const Candidate& a, const Candidate& b) { return a.position == b.position; }));
}

} // namespace
} // namespace sconce
