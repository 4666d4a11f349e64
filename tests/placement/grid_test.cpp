#include <gtest/gtest.h>

#include "placement/coverage.h"
#include "placement/grid.h"
#include "placement/place.h"
#include "scene/builtin_scenes.h"

namespace sconce
{
namespace
{

glm::ivec3 gridShape(const Bounds& bounds, uint32_t count)
{
    return gridShapes(bounds, count, 1).front();
}

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

TEST(GridShape, OfPowersOfTwoIsNearestInCountThenInShape)
{
    const auto shape = [](vec3 size, uint32_t count) { return powerOfTwoShapes({vec3(0.0f), size}, count, 1).front(); };
    EXPECT_EQ(shape({8, 3, 8}, 32), glm::ivec3(4, 2, 4));
    EXPECT_EQ(shape({1, 1, 1}, 8), glm::ivec3(2, 2, 2));
    EXPECT_EQ(shape({8, 1, 1}, 54), glm::ivec3(16, 2, 2)); // 64 is nearer in ratio than 32
    EXPECT_EQ(shape({5, 5, 5}, 1), glm::ivec3(1, 1, 1));
}

TEST(GridIn, MarginsAreSharesOfAStep)
{
    const Bounds bounds{{0, 0, 0}, {6, 4, 1}};
    const ProbeGrid onBounds = gridIn(bounds, {4, 3, 1}, 0.0f), quarter = gridIn(bounds, {4, 3, 1}, 0.25f);
    EXPECT_EQ(onBounds.origin, vec3(0, 0, 0.5f));
    EXPECT_EQ(vec2(onBounds.step), vec2(2, 2));
    EXPECT_NEAR(quarter.origin.x, 6.0f / 3.5f * 0.25f, 1e-6f);
    EXPECT_NEAR(quarter.origin.x + 3.0f * quarter.step.x, 6.0f - quarter.origin.x, 1e-5f);
}

/// The hall: no shape and pose that a fitted grid may have sees more than the one that it took, but for the noise of the samples.
TEST(FitGrid, TakesWhatSeesMost)
{
    const Scene scene = *makeBuiltinScene("hall");
    PlaceSettings settings;
    settings.method = PlaceSettings::Method::grid;
    settings.count = 24;
    PlaceReport plain, fitted;
    ASSERT_TRUE(placeProbes(scene, settings, plain));
    settings.fitGrid = true;
    const auto set = placeProbes(scene, settings, fitted);
    ASSERT_TRUE(set) << set.error().message;
    float most = 0.0f;
    for (const glm::ivec3& shape : gridShapes(fitted.reachable, 24, 4))
        for (const float margin : {0.5f, 0.25f, 0.0f})
        {
            const ProbeGrid grid = gridIn(fitted.reachable, shape, margin);
            std::vector<vec3> positions;
            for (int i = 0; i < shape.x * shape.y * shape.z; ++i)
                positions.push_back(grid.origin + grid.step * vec3(i % shape.x, i / shape.x % shape.y, i / shape.x / shape.y));
            const auto coverage = measureCoverage(scene, positions, {});
            ASSERT_TRUE(coverage) << coverage.error().message;
            most = std::max(most, coverage->rays);
        }
    EXPECT_GT(fitted.coverageRays, most - 0.006f); // two standard errors of a choice by 20,000 points
    EXPECT_GT(fitted.coverageRays, plain.coverageRays - 0.006f);
    RecordProperty("plain_fitted_most",
                   std::to_string(plain.coverageRays) + " " + std::to_string(fitted.coverageRays) + " " + std::to_string(most));
}

TEST(GridIn, PointsAreTheCentresOfEqualCells)
{
    const ProbeGrid grid = gridIn({{1, 2, 3}, {5, 4, 9}}, {4, 1, 3});
    EXPECT_EQ(grid.origin, vec3(1.5f, 3, 4));
    EXPECT_EQ(grid.step, vec3(1, 2, 2));
}

} // namespace
} // namespace sconce
