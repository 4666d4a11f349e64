// Words of the distance maps, charts and packed colours, against closed forms.
#include <cmath>
#include <random>

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

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return glm::normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(Chart, FaceCoordinatesInvert)
{
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 p = randomDirection(random);
        for (int face = 0; face < 6; ++face) EXPECT_EQ(Text::faceDirection(face, Text::faceCoordinates(face, p)), p);
        const vec3 on = Text::faceCoordinates(Text::dominantFace(p), p);
        EXPECT_GE(on.z, std::max(std::abs(on.x), std::abs(on.y)));
    }
}

TEST(Chart, OctahedralMapInvertsAlsoOnEdgesAndCorners)
{
    std::mt19937 random(2);
    auto check = [&](vec3 d)
    {
        const vec2 uv = Text::octahedralFromDirection(d);
        EXPECT_GE(uv.x, 0.0f);
        EXPECT_LE(uv.y, 1.0f);
        EXPECT_NEAR(glm::distance(Text::directionFromOctahedral(uv), glm::normalize(d)), 0.0f, 2e-6f) << d.x << " " << d.y << " " << d.z;
    };
    for (int i = 0; i < 10000; ++i) check(randomDirection(random));
    for (float x : {-1.0f, -0.0f, 0.0f, 1.0f})
        for (float y : {-1.0f, 0.0f, 1.0f})
            for (float z : {-1.0f, -0.0f, 0.0f, 1.0f})
                if (x != 0.0f || y != 0.0f || z != 0.0f) check(vec3(x, y, z));
}

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

} // namespace
} // namespace sconce
