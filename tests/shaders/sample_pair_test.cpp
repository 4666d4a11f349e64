#include "shaders/shared/sample_pair.h"

#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "base/knobs.h"
#include "shaders/shared/frame.h"

namespace sconce
{
namespace
{

std::pair<float, float> pairOf(uint32_t x, uint32_t y, uint32_t sample)
{
    const glm::vec2 pair = gpu::randomPair({x, y}, sample, 0, 1);
    return {pair.x, pair.y};
}

// As many rays as may be asked for are that many different ones, and none of them is a neighbour's.
TEST(SamplePair, EverySampleOfEveryNeighbourIsAnother)
{
    ASSERT_EQ(knobs::glossyRays.most, 64u);
    std::set<std::pair<float, float>> all;
    for (uint32_t y = 16; y < 24; ++y)
        for (uint32_t x = 40; x < 48; ++x)
            for (uint32_t sample = 0; sample < knobs::glossyRays.most; ++sample)
            {
                const auto pair = pairOf(x, y, sample);
                EXPECT_TRUE(all.insert(pair).second) << x << "," << y << ", sample " << sample;
                EXPECT_TRUE(pair.first >= 0.0f && pair.first < 1.0f && pair.second >= 0.0f && pair.second < 1.0f);
            }
    EXPECT_EQ(all.size(), 64u * knobs::glossyRays.most);
}

// Why there are no more: the next index is a sample that the pixel, or the one beside it, has already.
TEST(SamplePair, ASampleBeyondTheMostIsOneThatIsThereAlready)
{
    EXPECT_EQ(pairOf(41, 16, 64), pairOf(41, 16, 0));
    EXPECT_EQ(pairOf(40, 16, 64), pairOf(41, 16, 0));
}

// A shader can't read the table: what it has for itself must be the same.
TEST(SharedKnobs, AreThoseOfTheTable)
{
    EXPECT_EQ(gpu::kRaysBelow, knobs::raysBelow.value);
}

} // namespace
} // namespace sconce
