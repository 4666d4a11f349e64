// Packed colours, against closed forms of their formats (Vulkan specification, B10G11R11_UFLOAT_PACK32, E5B9G9R9_UFLOAT_PACK32).
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using glm::vec3;

using Text = Pure<float>;

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

/// Value of an unsigned float of 5 exponent bits, bias 15, by the format's own words: denormals below 2^-14.
double valueOf(uint32_t bits, int mantissaBits)
{
    const int exponent = int(bits >> mantissaBits);
    const double mantissa = double(bits & ((1u << mantissaBits) - 1u)) / double(1u << mantissaBits);
    return exponent == 0 ? std::ldexp(mantissa, -14) : std::ldexp(1.0 + mantissa, exponent - 15);
}

TEST(Colour, EveryWordUpTo64000HasItsValueAndComesBack)
{
    for (uint32_t bits = 0; valueOf(bits, 6) <= 64000.0; ++bits) // it saturates there
    {
        const vec3 c = Text::unpackRadiance(bits | bits << 11 | (bits >> 1) << 22);
        EXPECT_EQ(c.x, float(valueOf(bits, 6))) << bits;
        EXPECT_EQ(c.y, c.x) << bits;
        EXPECT_EQ(c.z, float(valueOf(bits >> 1, 5))) << bits;
        EXPECT_EQ(Text::packRadiance(c), bits | bits << 11 | (bits >> 1) << 22) << bits;
    }
}

TEST(Colour, RoundsToTheNearestWord)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> exponent(-13.0f, 15.5f);
    for (int i = 0; i < 10000; ++i)
    {
        const float value = std::exp2(exponent(random));
        const uint32_t bits = Text::packRadiance(vec3(value)) & 0x7ffu;
        const double error = std::abs(valueOf(bits, 6) - double(value));
        // The half float that it goes through is rounded first: a tie may go the other way by its step, 1/16 of one of these.
        const double step = std::ldexp(1.0, std::ilogb(value) - 10);
        EXPECT_LE(error, std::abs(valueOf(bits + 1, 6) - double(value)) + step) << value;
        EXPECT_LE(error, std::abs(valueOf(bits - 1, 6) - double(value)) + step) << value;
    }
}

// A constant colour between two words, dithered over many texels, keeps its mean; rounded to nearest it would be off by up to 0.8 %.
TEST(Colour, DitherKeepsTheMean)
{
    constexpr uint32_t kTexels = 4096;
    for (const float value : {0.011f, 0.1f, 1.004f, 1.0117f, 3.3f, 700.0f})
    {
        glm::dvec3 sum(0.0);
        for (uint32_t texel = 0; texel < kTexels; ++texel)
            sum += glm::dvec3(Text::unpackRadiance(Text::packRadianceDithered(vec3(value), Text::ditherOf(texel))));
        for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(sum[channel] / kTexels / value, 1.0, 1e-3) << value << ' ' << channel;
    }
}

/// Value of an RGB9E5 channel by the format's own words: mantissa x 2^(exponent - 15 - 9).
double sharedValueOf(uint32_t word, int channel)
{
    return std::ldexp(double((word >> (9 * channel)) & 511u), int(word >> 27) - 24);
}

TEST(Colour, SharedExponentsComeBackWithinHalfAStepOfTheLargestChannel)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<float> exponent(-20.0f, 15.9f);
    for (int i = 0; i < 20000; ++i)
    {
        const vec3 c(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
        const uint32_t word = Text::packSharedExponent(c);
        const vec3 back = Text::unpackSharedExponent(word);
        // The largest channel has a mantissa of 256 to 511, or the least exponent.
        const double largest = std::max({c.x, c.y, c.z}),
                     half = 0.5 * std::max(std::exp2(std::floor(std::log2(largest)) - 8.0), std::exp2(-24.0));
        for (int channel = 0; channel < 3; ++channel)
        {
            EXPECT_EQ(back[channel], float(sharedValueOf(word, channel)));
            EXPECT_NEAR(back[channel], c[channel], 2.001 * half)
                << "where the largest rounds up to the next exponent, steps are twice as wide";
        }
    }
}

TEST(Colour, SharedExponentsSaturateAndTurnWhatIsNoneIntoBlack)
{
    EXPECT_EQ(Text::packSharedExponent(vec3(0.0f)), 0u);
    EXPECT_EQ(Text::unpackSharedExponent(Text::packSharedExponent(vec3(65408.0f, 1e30f, INFINITY))), vec3(65408.0f));
    EXPECT_EQ(Text::unpackSharedExponent(Text::packSharedExponent(vec3(-1.0f, NAN, 1.0f))), vec3(0.0f, 0.0f, 1.0f));
    for (const float exact : {1.0f, 0.5f, 255.5f, 511.0f, 1024.0f, 3.0f / 65536.0f})
        EXPECT_EQ(Text::unpackSharedExponent(Text::packSharedExponent(vec3(exact))), vec3(exact)) << exact;
}

} // namespace
} // namespace sconce
