#include <gtest/gtest.h>

#include "placement/grid.h"
#include "placement/place.h"

namespace sconce
{
namespace
{

TEST(GridShape, FindsTheCubicCellsWhenTheyExist)
{
    EXPECT_EQ(gridShape({vec3(0), {3, 1, 2}}, 6), glm::ivec3(3, 1, 2));
    EXPECT_EQ(gridShape({vec3(0), {6, 3, 3}}, 54), glm::ivec3(6, 3, 3));
    EXPECT_EQ(gridShape({vec3(0), vec3(1)}, 1), glm::ivec3(1));
}

TEST(GridShape, StaysWithin15PercentOfTheCount)
{
    for (uint32_t count = 1; count < 300; count += 7)
    {
        const glm::ivec3 shape = gridShape({vec3(0), {7, 2.3f, 4.1f}}, count);
        const double product = double(shape.x) * shape.y * shape.z;
        EXPECT_LE(std::abs(product - count), 0.15 * count) << count;
    }
    const glm::ivec3 most = gridShape({vec3(0), {7, 2.3f, 4.1f}}, 65535);
    EXPECT_LE(most.x * most.y * most.z, 65535);
}

TEST(GridIn, PointsAreTheCentresOfEqualCells)
{
    const ProbeGrid grid = gridIn({{1, 2, 3}, {5, 4, 9}}, {4, 1, 3});
    EXPECT_EQ(grid.origin, vec3(1.5f, 3, 4));
    EXPECT_EQ(grid.step, vec3(1, 2, 2));
}

} // namespace
} // namespace sconce
