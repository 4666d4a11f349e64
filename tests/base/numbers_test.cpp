#include "base/numbers.h"

#include <limits>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(Numbers, AVectorIsFiniteWhenEveryComponentIs)
{
    EXPECT_TRUE(finite(glm::vec3(0.0f, -3e38f, 1e-40f)));
    for (int i = 0; i < 3; ++i)
        for (const float odd :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()})
        {
            glm::vec3 v(1.0f);
            v[i] = odd;
            EXPECT_FALSE(finite(v)) << i << " " << odd;
        }
    EXPECT_FALSE(finite(glm::dvec2(1.0, std::numeric_limits<double>::quiet_NaN())));
}

// The weights of BT.709 are the second row of its matrix to XYZ: they add up to the luminance of white.
TEST(Numbers, LuminanceOfWhiteIsOne)
{
    EXPECT_NEAR(luminance({1.0f, 1.0f, 1.0f}), 1.0f, 1e-6f);
    EXPECT_EQ(luminance({1.0f, 0.0f, 0.0f}), 0.2126f);
    EXPECT_GT(luminance({0.0f, 1.0f, 0.0f}), luminance({1.0f, 0.0f, 1.0f}));
}

// Against bits moved one by one.
TEST(Numbers, MortonCodeInterleavesTheBitsOfTheAxes)
{
    const auto slow = [](const glm::uvec3& cell)
    {
        uint32_t code = 0;
        for (uint32_t bit = 0; bit < 10; ++bit)
            for (uint32_t axis = 0; axis < 3; ++axis) code |= (cell[int(axis)] >> bit & 1u) << (3 * bit + axis);
        return code;
    };
    for (uint32_t i = 0; i < 1024; ++i)
        for (const glm::uvec3& cell :
             {glm::uvec3(i, 0, 0), glm::uvec3(0, i, 0), glm::uvec3(0, 0, i), glm::uvec3(i, 1023 - i, i * 7 % 1024)})
            ASSERT_EQ(mortonCode(cell), slow(cell)) << cell.x << " " << cell.y << " " << cell.z;
    EXPECT_EQ(mortonCode({1023, 1023, 1023}), 0x3fffffffu);
}

} // namespace
} // namespace sconce
