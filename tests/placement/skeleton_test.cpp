#include "placement/skeleton.h"

#include <gtest/gtest.h>

#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

// The medial axis of a box is where its two nearest walls are equally far.
TEST(SkeletonCandidates, LieOnTheMedialAxisOfARoom)
{
    const vec3 size(6, 3, 4);
    const Scene scene = closedRoom(size);
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const auto space = findFreeSpace(scene, *visibility, {}, 200000);
    ASSERT_TRUE(space);
    const std::vector<Candidate> candidates = skeletonCandidates({*visibility, *space}, 300, 0.1f);
    ASSERT_GT(candidates.size(), 50u);
    ASSERT_LE(candidates.size(), 300u);
    for (const Candidate& candidate : candidates)
    {
        const vec3 p = candidate.position;
        float walls[6] = {p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z};
        std::sort(walls, walls + 6);
        EXPECT_LE(walls[1] - walls[0], 4.0f * space->field.voxel) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(SpreadCandidates, KeepTheClearance)
{
    const Scene scene = furnishedRoom();
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const auto space = findFreeSpace(scene, *visibility, {}, 100000);
    ASSERT_TRUE(space);
    const std::vector<Candidate> candidates = spreadCandidates({*visibility, *space}, 500, 0.3f, 1);
    EXPECT_EQ(candidates.size(), 500u);
    for (const Candidate& candidate : candidates) EXPECT_GE(bruteDistance(scene, candidate.position), 0.3f - 1e-5f);
}

} // namespace
} // namespace sconce
