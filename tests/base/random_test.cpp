#include "base/random.h"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(Random, DependsOnItsNamesAlone)
{
    Random a(1, 2, 3), b(1, 2, 3);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(a.bits(), b.bits());
    std::set<uint64_t> first;
    for (uint64_t seed = 0; seed < 10; ++seed)
        for (uint64_t stream = 0; stream < 10; ++stream)
        {
            first.insert(Random(seed, stream).bits());
            for (uint64_t sample = 0; sample < 10; ++sample) first.insert(Random(seed, stream, sample).bits());
        }
    EXPECT_EQ(first.size(), 1100u) << "two streams began alike";
}

/// Chi-square of counts that should be equal, in standard deviations of its distribution (mean k - 1, variance 2 (k - 1)).
double deviations(const std::vector<int>& counts)
{
    double total = 0.0, sum = 0.0;
    for (const int count : counts) total += count;
    const double expected = total / double(counts.size());
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    const double freedom = double(counts.size()) - 1.0;
    return (sum - freedom) / std::sqrt(2.0 * freedom);
}

// Draws of one stream, and first draws of neighbouring streams, samples and seeds: what work that is split over threads uses.
TEST(Random, IsUniformAlongAStreamAndAcrossStreams)
{
    constexpr int kDraws = 100000, kCells = 64;
    std::vector<std::vector<int>> counts(5, std::vector<int>(kCells));
    std::vector<int> pairs(kCells * kCells);
    Random along(7, 0);
    for (int i = 0; i < kDraws; ++i)
    {
        ++counts[0][size_t(along.uniform() * kCells)];
        ++counts[1][size_t(Random(7, uint64_t(i)).uniform() * kCells)];
        ++counts[2][size_t(Random(7, 3, uint64_t(i)).uniform() * kCells)];
        ++counts[3][size_t(Random(uint64_t(i), 3).uniform() * kCells)];
        ++counts[4][size_t(Random(7, uint64_t(i), 5).below(kCells))];
        const glm::vec2 two = Random(7, uint64_t(i), uint64_t(i % 16)).uniform2();
        ++pairs[size_t(two.x * kCells) * kCells + size_t(two.y * kCells)];
    }
    for (const std::vector<int>& c : counts) EXPECT_LT(std::abs(deviations(c)), 4.5);
    EXPECT_LT(std::abs(deviations(pairs)), 4.5);
}

// Over the sphere the mean of each coordinate is 0 and of its square 1/3.
TEST(Random, DirectionsAreUniformOnTheSphere)
{
    constexpr int kDraws = 100000;
    Random random(3, 1);
    glm::dvec3 sum(0.0), squares(0.0);
    for (int i = 0; i < kDraws; ++i)
    {
        const glm::dvec3 d = random.direction();
        ASSERT_NEAR(glm::length(d), 1.0, 1e-6);
        sum += d, squares += d * d;
    }
    const double error = 4.5 / std::sqrt(double(kDraws)); // variances: 1/3 and 4/45
    for (int axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(sum[axis] / kDraws, 0.0, error * std::sqrt(1.0 / 3.0));
        EXPECT_NEAR(squares[axis] / kDraws, 1.0 / 3.0, error * std::sqrt(4.0 / 45.0));
    }
}

} // namespace
} // namespace sconce
