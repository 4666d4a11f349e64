#include "bench/reference/flip.h"

#include <numeric>

#include <gtest/gtest.h>

#include "base/random.h"
#include "bench/reference/image_io.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSize = 48;

std::vector<float> uniform(vec3 colour)
{
    std::vector<float> image;
    for (uint32_t i = 0; i < kSize * kSize; ++i) image.insert(image.end(), {colour.x, colour.y, colour.z});
    return image;
}

std::vector<float> pattern()
{
    std::vector<float> image;
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize; ++x)
            image.insert(image.end(), {0.2f + 0.01f * float(x), 0.1f + 0.015f * float(y), (x / 8 + y / 8) % 2 ? 0.6f : 0.2f});
    return image;
}

std::vector<float> noisy(std::vector<float> image, float amount)
{
    Random random(3, 1, 4);
    for (float& v : image) v = std::max(0.0f, v + amount * (2.0f * random.uniform() - 1.0f));
    return image;
}

double mean(const std::vector<float>& v)
{
    return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size());
}

double ldr(const std::vector<float>& a, const std::vector<float>& b)
{
    return mean(flipLdr(a, b, kSize, kSize));
}

TEST(Flip, EqualPicturesDifferNowhere)
{
    for (float v : flipLdr(pattern(), pattern(), kSize, kSize)) EXPECT_EQ(v, 0.0f);
    for (float v : flipHdr(pattern(), pattern(), kSize, kSize)) EXPECT_EQ(v, 0.0f);
}

// By hand: no features; HyAB of black and white is 100. Hunt-adjusted green is (87.73, -75.61, 72.98), blue (32.30, 25.57, -34.84), CIELAB
// D65: HyAB 55.43 + 147.9 = 203.3, to the power 0.7 41.29; 100^0.7 = 25.12 lies above the knee at 16.52: 0.95 + 0.05 (25.12 - 16.52)
// / 24.77.
TEST(Flip, BlackAgainstWhiteIsItsClosedForm)
{
    EXPECT_NEAR(ldr(uniform(vec3(0.0f)), uniform(vec3(1.0f))), 0.9674, 5e-4);
}

// The largest colour difference that the metric is scaled to.
TEST(Flip, GreenAgainstBlueIsOne)
{
    EXPECT_NEAR(ldr(uniform({0, 1, 0}), uniform({0, 0, 1})), 1.0, 1e-3);
}

// Greys 0.18 and 0.2 have L* 49.496 and 51.837 (CIE 1976): HyAB 2.341, to the power 0.7 1.8137, times 0.95 / 16.52.
TEST(Flip, SmallGreyStepIsItsClosedForm)
{
    EXPECT_NEAR(ldr(uniform(vec3(0.18f)), uniform(vec3(0.2f))), 1.8137 * 0.95 / 16.516, 1e-3);
}

TEST(Flip, Symmetric)
{
    const auto other = noisy(pattern(), 0.1f);
    EXPECT_NEAR(ldr(pattern(), other), ldr(other, pattern()), 1e-6);
}

TEST(Flip, GrowsWithNoise)
{
    double before = 0.0;
    for (float amount : {0.02f, 0.05f, 0.1f, 0.2f})
    {
        const double now = ldr(noisy(pattern(), amount), pattern());
        EXPECT_GT(now, before) << amount;
        before = now;
    }
}

// Finer than the eye resolves: a checkerboard of single pixels far away looks like its mean.
TEST(Flip, DistanceHidesFineColourDetail)
{
    auto checker = uniform(vec3(0.5f));
    for (uint32_t i = 0; i < kSize * kSize; ++i) checker[3 * i] += (i + i / kSize) % 2 ? 0.1f : -0.1f;
    const auto plain = uniform(vec3(0.5f));
    EXPECT_LT(mean(flipLdr(checker, plain, kSize, kSize, 120.0f)), mean(flipLdr(checker, plain, kSize, kSize, 20.0f)));
}

TEST(HdrFlip, SeesDifferencesThatOneExposureHides)
{
    auto reference = uniform(vec3(0.001f));
    for (size_t i = 0; i < 300; ++i) reference[i] = 50.0f;
    auto test = reference;
    for (size_t i = 3000; i < 6000; ++i) test[i] *= 3.0f; // far below 8-bit black at the highlights' exposure
    const auto low = flipLdr(toneMap(test, 0.02f), toneMap(reference, 0.02f), kSize, kSize);
    EXPECT_LT(mean(low), 0.01);
    EXPECT_GT(mean(flipHdr(test, reference, kSize, kSize)), 0.1);
}

TEST(HdrFlip, BlackReferenceIsFinite)
{
    for (float v : flipHdr(uniform(vec3(0.5f)), uniform(vec3(0.0f)), kSize, kSize)) EXPECT_TRUE(v > 0.0f && v <= 1.0f);
}

} // namespace
} // namespace sconce
