#include "placement/select.h"

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

ViewTable tableOf(std::vector<std::vector<uint8_t>> rows)
{
    ViewTable table;
    table.surfels = rows.front().size();
    for (const auto& row : rows) table.values.insert(table.values.end(), row.begin(), row.end());
    return table;
}

// The textbook trap: greedy takes the set of four first and then needs both others; the best pair is rows 1 and 2.
const std::vector<std::vector<uint8_t>> kTrap = {
    {0, 130, 130, 130, 130, 0},
    {130, 130, 130, 0, 0, 0},
    {0, 0, 0, 130, 130, 130},
};

TEST(ChooseGreedily, TakesTheLargestGainFirst)
{
    EXPECT_EQ(chooseGreedily(tableOf(kTrap), 2, 1.0f), (std::vector<uint32_t>{0, 1}));
}

TEST(ChooseGreedily, StopsAtTheCoverageAskedFor)
{
    EXPECT_EQ(chooseGreedily(tableOf(kTrap), 0, 0.6f).size(), 1u);
    EXPECT_EQ(chooseGreedily(tableOf(kTrap), 0, 0.8f).size(), 2u);
    EXPECT_EQ(chooseGreedily(tableOf(kTrap), 0, 1.0f).size(), 3u);
}

TEST(ChooseGreedily, OutOfReachCoverageEndsWhenNothingNewIsSeen)
{
    EXPECT_EQ(chooseGreedily(tableOf({{130, 0, 0}, {0, 130, 0}, {140, 140, 0}, {150, 0, 0}}), 0, 1.0f), (std::vector<uint32_t>{2}));
}

TEST(ChooseGreedily, BeyondFullCoverageGainsQuality)
{
    EXPECT_EQ(chooseGreedily(tableOf({{250, 250, 130, 130}, {128, 128, 135, 131}, {0, 0, 240, 240}}), 2, 1.0f),
              (std::vector<uint32_t>{0, 2}));
}

TEST(ImproveByExchange, LeavesTheGreedyTrap)
{
    const ViewTable table = tableOf(kTrap);
    std::vector<uint32_t> chosen = chooseGreedily(table, 2, 1.0f);
    improveByExchange(table, chosen, 2);
    std::sort(chosen.begin(), chosen.end());
    EXPECT_EQ(chosen, (std::vector<uint32_t>{1, 2}));
}

TEST(PruneNeedless, DropsWhatTheOthersSeeAnyway)
{
    std::vector<uint32_t> chosen{0, 1, 2};
    pruneNeedless(tableOf(kTrap), chosen);
    EXPECT_EQ(chosen.size(), 2u); // 1 and 2 see all, 0 is the widest but needless only when the smaller ones stay
    std::vector<uint32_t> needed{1, 2};
    pruneNeedless(tableOf(kTrap), needed);
    EXPECT_EQ(needed, (std::vector<uint32_t>{1, 2}));
}

TEST(SharesAlone, CountsOnlyWhatNoOtherSees)
{
    const std::vector<uint32_t> chosen{0, 1};
    const std::vector<float> alone = sharesAlone(tableOf(kTrap), chosen);
    EXPECT_FLOAT_EQ(alone[0], 2.0f / 6.0f);
    EXPECT_FLOAT_EQ(alone[1], 1.0f / 6.0f);
}

TEST(OrderByGain, SharesAddUpToTheCoverage)
{
    std::vector<uint32_t> chosen{1, 2, 0};
    const std::vector<float> shares = orderByGain(tableOf(kTrap), chosen);
    EXPECT_EQ(chosen, (std::vector<uint32_t>{0, 1, 2}));
    ASSERT_EQ(shares.size(), 3u);
    EXPECT_FLOAT_EQ(shares[0], 4.0f / 6.0f);
    EXPECT_FLOAT_EQ(shares[0] + shares[1] + shares[2], 1.0f);
}

} // namespace
} // namespace sconce
