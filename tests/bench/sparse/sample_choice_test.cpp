#include "bench/sparse/sample_choice.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

constexpr uint32_t kSide = 64;

TEST(SampleChoice, IsInProportionToPriorityAndOfEachPixelOnce)
{
    std::vector<float> priority(kSide * kSide, 1.0f);
    for (uint32_t i = 0; i < kSide * kSide; ++i)
        if (i % kSide >= kSide / 2) priority[i] = 3.0f;
    const std::vector<uint32_t> chosen = chooseSamples(priority, kSide, 256);
    EXPECT_LE(chosen.size(), 256u);
    EXPECT_GE(chosen.size(), 240u);
    EXPECT_EQ(std::set<uint32_t>(chosen.begin(), chosen.end()).size(), chosen.size());
    const auto right = double(std::ranges::count_if(chosen, [](uint32_t pixel) { return pixel % kSide >= kSide / 2; }));
    EXPECT_NEAR(right / double(chosen.size()), 0.75, 0.04);
}

TEST(SampleChoice, IsSpreadOverThePicture)
{
    const std::vector<float> priority(kSide * kSide, 0.2f);
    std::vector<int> blocks(64, 0); // of 8 x 8 pixels
    for (const uint32_t pixel : chooseSamples(priority, kSide, 256)) ++blocks[pixel / kSide / 8 * 8 + pixel % kSide / 8];
    const auto [least, most] = std::ranges::minmax(blocks);
    EXPECT_GE(least, 2); // 4 in the mean; drawn by chance some would have none
    EXPECT_LE(most, 6);
}

TEST(SampleChoice, NeverTakesWhatIsNotWantedNorMoreThanAll)
{
    std::vector<float> priority(kSide * kSide, 0.0f);
    EXPECT_TRUE(chooseSamples(priority, kSide, 100).empty());
    for (uint32_t i = 0; i < 10; ++i) priority[i * 97] = 1.0f;
    const std::vector<uint32_t> chosen = chooseSamples(priority, kSide, 1000);
    for (const uint32_t pixel : chosen) EXPECT_EQ(priority[pixel], 1.0f);
    EXPECT_GE(chosen.size(), 9u);
}

} // namespace
} // namespace sconce
