// Work that is cut into submissions, by a clock that the work itself moves on.
#include "runtime/vulkan/paced_work.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/device.h"

namespace sconce
{
namespace
{

double time = 0.0;         // seconds
std::vector<double> looks; // at the clock: before and after each submission
double look()
{
    looks.push_back(time);
    return time;
}

class PacedWorkTest : public testing_support::DeviceTest
{
protected:
    void SetUp() override
    {
        time = 0.0;
        looks.clear();
    }

    /// A pass that takes so long a unit; counts how often each is recorded.
    /// @param once  seconds besides, when it is recorded for the first time
    void add(PacedWork& work, std::string_view name, uint32_t units, double seconds, double once = 0.0)
    {
        counts.emplace_back(units, 0);
        work.add(name, units,
                 [=, this, pass = counts.size() - 1](VkCommandBuffer, uint32_t first, uint32_t count)
                 {
                     order.emplace_back(pass, first);
                     for (uint32_t i = first; i < first + count; ++i) ++counts[pass].at(i);
                     time += seconds * count + (first == 0 ? once : 0.0);
                 });
    }
    void expectAllOnceInOrder() const
    {
        for (const auto& units : counts) EXPECT_TRUE(std::ranges::all_of(units, [](int count) { return count == 1; }));
        EXPECT_TRUE(std::ranges::is_sorted(order));
    }
    static std::vector<double> submissions()
    {
        std::vector<double> took;
        for (size_t i = 0; i < looks.size(); i += 2) took.push_back(looks[i + 1] - looks[i]);
        return took;
    }

    std::vector<std::vector<int>> counts;           // of each pass's units
    std::vector<std::pair<size_t, uint32_t>> order; // pass and first unit, as recorded
};

TEST_F(PacedWorkTest, AllIsRecordedOnceAndInOrder)
{
    PacedWork work(gpu(), 0.2, look);
    for (const uint32_t units : {1u, 2u, 31u, 32u, 33u, 1000u})
        for (const double seconds : {0.0, 1e-6, 1e-3, 0.5}) add(work, "one name for all", units, seconds);
    ASSERT_TRUE(work.run());
    expectAllOnceInOrder();
}

// Units that all take alike: none but the first part of a pass is guessed at, and seven tenths of the limit are aimed at.
TEST_F(PacedWorkTest, NoSubmissionTakesLongerThanTheLimit)
{
    PacedWork work(gpu(), 0.2, look);
    add(work, "slow", 640, 0.005); // 3.2 s
    add(work, "slower", 64, 0.05); // 3.2 s
    ASSERT_TRUE(work.run());
    expectAllOnceInOrder();
    const auto took = submissions();
    EXPECT_LE(*std::ranges::max_element(took), 0.2);
    EXPECT_LE(took.size(), 60u) << "6.4 s by 0.14 s, and the first parts";
    EXPECT_GE(took.size(), 46u);
}

TEST_F(PacedWorkTest, WhatIsShortGoesTogetherOnceItIsKnown)
{
    PacedWork work(gpu(), 0.2, look);
    for (const bool known : {false, true})
    {
        looks.clear();
        add(work, "a", 96, 1e-4);
        add(work, "b", 6, 1e-2);
        add(work, "c", 1, 1e-3);
        ASSERT_TRUE(work.run());
        EXPECT_EQ(looks.size() / 2, known ? 1u : 5u);
    }
    expectAllOnceInOrder();
}

// The first part of a pass may have waited for a compiler: what it took is forgotten by half a time.
TEST_F(PacedWorkTest, AFirstPartThatWaitedForACompilerIsForgotten)
{
    PacedWork work(gpu(), 0.2, look);
    add(work, "compiled", 3200, 1e-4, 1.0);
    ASSERT_TRUE(work.run());
    expectAllOnceInOrder();
    EXPECT_LE(looks.size() / 2, 20u);
    looks.clear();
    add(work, "compiled", 3200, 1e-4);
    ASSERT_TRUE(work.run());
    EXPECT_LE(looks.size() / 2, 4u) << "0.32 s";
}

// A unit that takes more than the limit goes alone, and units that suddenly take ten times as long are found at once.
TEST_F(PacedWorkTest, WhatCannotBeCutGoesAloneAndSlowerUnitsAreFoundAtOnce)
{
    PacedWork work(gpu(), 0.2, look);
    add(work, "whole", 3, 0.5);
    ASSERT_TRUE(work.run());
    EXPECT_EQ(submissions(), (std::vector<double>{0.5, 0.5, 0.5}));
    add(work, "fast", 320, 1e-3);
    ASSERT_TRUE(work.run());
    looks.clear();
    add(work, "fast", 320, 1e-2);
    ASSERT_TRUE(work.run());
    const auto took = submissions();
    EXPECT_GT(took[0], 0.2);
    EXPECT_LE(*std::max_element(took.begin() + 1, took.end()), 0.2);
}

TEST_F(PacedWorkTest, IsCancelledBetweenSubmissions)
{
    PacedWork work(gpu(), 0.2, look);
    add(work, "slow", 100, 0.1);
    std::vector<double> shares;
    const auto goesOn = [&](double done)
    {
        shares.push_back(done);
        return done < 0.5;
    };
    const Status stopped = work.run(goesOn);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
    EXPECT_EQ(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 0.5);
    EXPECT_EQ(std::accumulate(counts[0].begin(), counts[0].end(), 0), 50);
    ASSERT_TRUE(work.run()) << "nothing is left of it";
    EXPECT_EQ(std::accumulate(counts[0].begin(), counts[0].end(), 0), 50);
}

} // namespace
} // namespace sconce
