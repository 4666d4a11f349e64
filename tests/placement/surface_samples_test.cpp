#include "placement/surface_samples.h"

#include <gtest/gtest.h>

#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

TEST(AreaSurfels, LieOnReachableSidesInProportionToArea)
{
    const Scene scene = dividedRoom();
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const auto space = findFreeSpace(scene, *visibility, std::vector<vec3>{{5, 1, 2}}, 200000);
    ASSERT_TRUE(space);
    const std::vector<Surfel> surfels = areaSurfels(scene, *visibility, *space, 20000, 1);
    ASSERT_EQ(surfels.size(), 20000u);
    size_t onWall = 0;
    for (const Surfel& surfel : surfels)
    {
        ASSERT_GE(surfel.position.x, 3.9999f);
        ASSERT_GT(glm::dot(surfel.normal, vec3(5, 1.5f, 2) - surfel.position), 0.0f) << "must face the room";
        onWall += std::abs(surfel.position.x - 4.0f) < 1e-4f;
    }
    // The room of 2 x 3 x 4 m has 52 square metres, the thin wall 12 of them; the rim nearer than a cell is left out.
    EXPECT_NEAR(double(onWall) / 20000.0, 12.0 / 52.0, 0.015);
}

TEST(RaySurfels, FaceTheSpaceTheRaysCameFrom)
{
    const Scene scene = dividedRoom();
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const auto space = findFreeSpace(scene, *visibility, std::vector<vec3>{{5, 1, 2}}, 200000);
    ASSERT_TRUE(space);
    for (const Surfel& surfel : raySurfels(*visibility, *space, 5000, 1))
    {
        ASSERT_GE(surfel.position.x, 3.9999f);
        ASSERT_GT(glm::dot(surfel.normal, vec3(5, 1.5f, 2) - surfel.position), 0.0f);
    }
}

TEST(ViewQuality, FallsWithCosineAndDistanceAndEndsAtTheLeastCosine)
{
    const Surfel surfel{{0, 0, 0}, {0, 1, 0}, 0};
    EXPECT_FLOAT_EQ(viewQuality(surfel, {0, 2, 0}, 2.0f), 0.5f);
    EXPECT_FLOAT_EQ(viewQuality(surfel, {0, 6, 0}, 2.0f), 0.25f);
    EXPECT_NEAR(viewQuality(surfel, {2 * 0.8f, 2 * 0.6f, 0}, 2.0f), 0.3f, 1e-6f);
    EXPECT_EQ(viewQuality(surfel, {1.0f, 0.049f, 0}, 2.0f), 0.0f);
    EXPECT_GT(viewQuality(surfel, {1.0f, 0.051f, 0}, 2.0f), 0.0f);
    EXPECT_EQ(viewQuality(surfel, {0, -1, 0}, 2.0f), 0.0f);
    EXPECT_EQ(viewQuality(surfel, {0, 0, 0}, 2.0f), 0.0f);
}

} // namespace
} // namespace sconce
