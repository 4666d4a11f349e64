#include "base/progress.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(Progress, ThatNobodyAsksForGoesOn)
{
    EXPECT_TRUE(report({}, "bake", 0.5));
}

TEST(Progress, IsToldStageAndShareAndDecides)
{
    std::vector<std::pair<std::string, double>> told;
    const Progress untilHalf = [&](std::string_view stage, double done)
    {
        told.emplace_back(stage, done);
        return done < 0.5;
    };
    EXPECT_TRUE(report(untilHalf, "place", 0.25));
    EXPECT_FALSE(report(untilHalf, "bake", 0.5));
    EXPECT_EQ(told, (std::vector<std::pair<std::string, double>>{{"place", 0.25}, {"bake", 0.5}}));
}

} // namespace
} // namespace sconce
