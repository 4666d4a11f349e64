#include "bench/race/traced_method.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/device.h"

namespace sconce
{
namespace
{

TEST(Times, AreNearestRanksOfTheRuns)
{
    std::vector<double> runs(20);
    std::iota(runs.begin(), runs.end(), 1.0);
    std::ranges::reverse(runs);
    const Times times = timesOf(runs);
    EXPECT_EQ(times.p5, 1.0);
    EXPECT_EQ(times.median, 10.0);
    EXPECT_EQ(times.p95, 19.0);
    EXPECT_EQ(timesOf({3.0}).median, 3.0);
}

TEST(ShuffledOrder, IsAPermutationThatTheSeedDecides)
{
    std::vector<uint32_t> order = shuffledOrder(1000, 5);
    EXPECT_EQ(order, shuffledOrder(1000, 5));
    EXPECT_NE(order, shuffledOrder(1000, 6));
    std::ranges::sort(order);
    for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(order[i], i);
}

class TracedMethodOf : public testing_support::DeviceTest
{
};

TEST_F(TracedMethodOf, AMisspeltTracerOrMissingFileIsASentence)
{
    const auto complaint = [&](const char* what) { return TracedMethod::create(gpu(), what).error().message; };
    EXPECT_NE(complaint("b1=x.sconce").find("'b1'"), std::string::npos);
    EXPECT_NE(complaint("b0/x=x.sconce").find("'x'"), std::string::npos);
    EXPECT_NE(complaint("b0=nowhere.sconce").find("nowhere.sconce"), std::string::npos);
    EXPECT_NE(complaint("ours/rank:2=x.sconce").find("'rank'"), std::string::npos);
    EXPECT_NE(complaint("ours/ranked:two=x.sconce").find("'ranked:two'"), std::string::npos);
    EXPECT_NE(complaint("ours/ranked:2,opinion:0.5=nowhere.sconce").find("nowhere.sconce"), std::string::npos);
}

} // namespace
} // namespace sconce
