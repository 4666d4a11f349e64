// Words of the distance maps, against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

TEST(Texel, GradientRoundsToNearestStep)
{
    for (float g = -0.14f; g <= 0.14f; g += 0.001f)
    {
        const float read = Text::unpackGradient(Text::packGradient(g));
        const float step = 2.0f * std::sqrt(std::abs(g) * 0.15f) / 127.0f + 0.15f / (127.0f * 127.0f); // of the squared scale, at g
        EXPECT_NEAR(read, g, step);
    }
    EXPECT_FLOAT_EQ(Text::unpackGradient(Text::packGradient(0.9f)), 0.15f) << "saturates";
    EXPECT_EQ(Text::unpackGradient(Text::packGradient(0.0f)), 0.0f);
}

} // namespace
} // namespace sconce
