// Words of the distance maps, against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using glm::vec2;
using glm::vec3;

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

<<<<<<< HEAD
TEST(Colour, RadianceRoundTripsWithinItsMantissa)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<float> exponent(-10.0f, 15.0f);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 c(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
        const vec3 r = Text::unpackRadiance(Text::packRadiance(c));
        EXPECT_NEAR(r.x, c.x, c.x / 120.0f);
        EXPECT_NEAR(r.y, c.y, c.y / 120.0f);
        EXPECT_NEAR(r.z, c.z, c.z / 60.0f);
    }
    EXPECT_EQ(Text::unpackRadiance(Text::packRadiance(vec3(0.0f))), vec3(0.0f));
    const vec3 extreme = Text::unpackRadiance(Text::packRadiance(vec3(1e9f, std::nanf(""), -3.0f)));
    EXPECT_GT(extreme.x, 60000.0f);
    EXPECT_TRUE(std::isfinite(extreme.x));
    EXPECT_EQ(extreme.y, 0.0f);
    EXPECT_EQ(extreme.z, 0.0f);
}

=======
>>>>>>> tests
} // namespace
} // namespace sconce
