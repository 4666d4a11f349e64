#include "bench/reference/metrics.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "base/random.h"

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

ImageSet imageSet(std::vector<float> rgb)
{
    ImageSet set;
    set.width = set.height = kSize;
    set.layers.push_back({"beauty", 3, std::move(rgb)});
    return set;
}

TEST(Mse, HandComputed)
{
    const float a[2] = {1.0f, 2.0f}, b[2] = {1.5f, 0.0f};
    EXPECT_DOUBLE_EQ(meanSquaredError(a, b), (0.25 + 4.0) / 2.0);
    EXPECT_NEAR(relativeMeanSquaredError(a, b), (0.25 / 2.26 + 4.0 / 0.01) / 2.0, 1e-9);
}

TEST(MeanOverMean, IsTheRatioOfAllLight)
{
    const std::vector<float> dark = {1, 2, 3}, light = {2, 4, 2}, black = {0, 0, 0};
    EXPECT_DOUBLE_EQ(meanOverMean(light, dark), 8.0 / 6.0);
    EXPECT_TRUE(std::isnan(meanOverMean(light, black)));
}

TEST(Psnr, InfiniteForEqualAndKnownForBlackAgainstWhite)
{
    EXPECT_EQ(peakSignalToNoise(pattern(), pattern(), 1.0f), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(peakSignalToNoise(uniform(vec3(0.0f)), uniform(vec3(1e8f)), 1.0f), 0.0, 1e-6); // error is the peak
}

TEST(CompareImages, GivesWhatWasAskedFor)
{
    CompareSettings settings;
    settings.psnr = false;
    settings.exposure = 1.0f;
    const auto result = compareImages(imageSet(noisy(pattern(), 0.05f)), imageSet(pattern()), settings);
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_NEAR(*result->mse, 0.05 * 0.05 / 3.0, 2e-4); // variance of uniform noise
    EXPECT_FALSE(result->psnr.has_value());
    EXPECT_GT(*result->flip, 0.0);
    EXPECT_EQ(result->errorMap.size(), size_t(kSize) * kSize);
}

TEST(CompareImages, RefusesOtherSizesLayersAndBrokenReferences)
{
    ImageSet small = imageSet(pattern());
    small.width = kSize / 2;
    small.height = kSize * 2;
    EXPECT_FALSE(compareImages(small, imageSet(pattern())).ok());
    CompareSettings other;
    other.layer = "direct";
    const auto missing = compareImages(imageSet(pattern()), imageSet(pattern()), other);
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("beauty"), std::string::npos); // says what there is
    ImageSet broken = imageSet(pattern());
    broken.layers[0].pixels[7] = std::nanf("");
    EXPECT_FALSE(compareImages(imageSet(pattern()), broken).ok());
    const auto counted = compareImages(broken, imageSet(pattern()));
    ASSERT_TRUE(counted.ok());
    EXPECT_EQ(counted->nonFinitePixels, 1u);
    EXPECT_TRUE(std::isnan(*counted->mse)); // so that no threshold passes
}

// Four pixels: alike, off by 0.5, seeing another surface, and both seeing the sky.
TEST(CompareImages, PixelsThatSeeAnotherSurfaceAreLeftOut)
{
    constexpr float kSky = std::numeric_limits<float>::infinity();
    ImageSet picture, reference;
    for (ImageSet* images : {&picture, &reference})
    {
        images->width = images->height = 2;
        images->add("beauty", 3);
        std::ranges::fill(images->layers[0].pixels, 1.0f);
    }
    for (size_t i = 3; i < 9; ++i) picture.layers[0].pixels[i] = i < 6 ? 1.5f : 100.0f;
    CompareSettings settings;
    settings.sameSurface = true;
    const auto blind = compareImages(picture, reference, settings);
    ASSERT_FALSE(blind);
    EXPECT_NE(blind.error().message.find("no layer 'depth'"), std::string::npos) << blind.error().message;
    for (ImageSet* images : {&picture, &reference}) images->add("depth", 1);
    picture.layers[1].pixels = {2.0f, 2.01f, 2.0f, kSky};
    reference.layers[1].pixels = {2.0f, 2.0f, 3.0f, kSky};
    const auto all = compareImages(picture, reference), same = compareImages(picture, reference, settings);
    ASSERT_TRUE(all && same);
    EXPECT_EQ(all->otherSurfacePixels, 0u);
    EXPECT_GT(*all->mse, 1000.0);
    EXPECT_EQ(same->otherSurfacePixels, 1u);
    EXPECT_NEAR(*same->mse, 0.25 / 3.0, 1e-7);
    EXPECT_NEAR(*same->mean, 3.5 / 3.0, 1e-6);
    EXPECT_LT(same->errorMap[2], 0.1f) << "of its neighbours alone";
    picture.layers[1].pixels = {9.0f, 9.0f, 9.0f, 9.0f};
    EXPECT_FALSE(compareImages(picture, reference, settings)) << "none is left";
}

// Four pixels: the light of one has changed, of one barely, one shows what has come, one is as it was.
TEST(CompareImages, OnlyWhatHasChangedCounts)
{
    ImageSet picture, reference, before;
    for (ImageSet* images : {&picture, &reference, &before})
    {
        images->width = images->height = 2;
        images->add("beauty", 3);
        std::ranges::fill(images->layers[0].pixels, 1.0f);
        images->add("depth", 1);
        std::ranges::fill(images->layers[1].pixels, 2.0f);
    }
    const auto set = [](ImageSet& images, size_t pixel, float value)
    { std::fill_n(images.layers[0].pixels.begin() + ptrdiff_t(3 * pixel), 3, value); };
    set(reference, 0, 0.5f);
    set(reference, 1, 0.95f);
    set(reference, 2, 0.2f);
    reference.layers[1].pixels[2] = 1.0f;
    set(picture, 3, 7.0f); // wrong, and none of either
    CompareSettings settings;
    settings.before = &before;
    const auto light = compareImages(picture, reference, settings);
    ASSERT_TRUE(light) << light.error().message;
    EXPECT_EQ(light->otherSurfacePixels, 3u);
    EXPECT_NEAR(*light->mean, 2.0, 1e-6);
    settings.newSurface = true;
    const auto surface = compareImages(picture, reference, settings);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_NEAR(*surface->mean, 5.0, 1e-5);
    settings.before = &reference;
    const auto nothing = compareImages(picture, reference, settings);
    ASSERT_FALSE(nothing);
    EXPECT_EQ(nothing.error().message, "nothing has changed between the two references; compare all pixels");
    before.layers.pop_back();
    settings.before = &before;
    EXPECT_NE(compareImages(picture, reference, settings).error().message.find("no layer 'depth'"), std::string::npos);
}

TEST(ErrorColours, EndsAreMagmasEnds)
{
    const std::vector<float> colours = errorColours(std::vector<float>{0.0f, 1.0f});
    EXPECT_NEAR(srgbFromLinear(colours[0]), 0.0f, 1e-4f);
    EXPECT_NEAR(srgbFromLinear(colours[3]) * 255.0f, 252.0f, 0.1f);
    EXPECT_NEAR(srgbFromLinear(colours[5]) * 255.0f, 191.0f, 0.1f);
}

/// A picture that is off by a known part, against a reference whose noise is three times as large: its error is the part alone.
TEST(Metrics, PartsTakeTheReferencesNoiseOutOfErrors)
{
    constexpr uint32_t kSide = 256;
    constexpr float kTruth = 0.5f, kOff = 0.05f, kNoise[] = {0.15f, 0.15f, 0.02f}; // standard deviation of each part
    ImageSet picture, reference;
    for (ImageSet* images : {&picture, &reference}) images->width = images->height = kSide;
    for (const char* name : {"beauty", "beauty_a", "beauty_b", "beauty_c"}) reference.add(name, 3);
    picture.add("beauty", 3);
    Random random(5, 1);
    const auto normal = [&] { return std::sqrt(-2.0f * std::log(1.0f - random.uniform())) * std::cos(6.2831853f * random.uniform()); };
    for (size_t i = 0; i < 3 * picture.pixelCount(); ++i)
    {
        picture.layers[0].pixels[i] = kTruth + kOff;
        for (size_t part = 1; part < 4; ++part) reference.layers[part].pixels[i] = kTruth + kNoise[part - 1] * normal();
        reference.layers[0].pixels[i] = 0.5f * (reference.layers[1].pixels[i] + reference.layers[2].pixels[i]);
    }
    const auto with = compareImages(picture, reference);
    ASSERT_TRUE(with) << with.error().message;
    const double expected = double(kOff) * kOff, v = double(kNoise[0]) * kNoise[0], scale = kTruth * kTruth + 0.01;
    const double unsure = std::sqrt((2.0 * expected * v + v * v) / (3.0 * kSide * kSide));
    EXPECT_NEAR(*with->mse, expected, 4.0 * unsure);
    EXPECT_NEAR(*with->relMse, expected / scale, 4.0 * unsure / scale + 0.005 * expected / scale); // and 3 times the divisor's variance
    EXPECT_NEAR(*with->relMseUnsure, unsure / scale, 0.05 * unsure / scale);
    // Without parts the noise counts: half of each one's variance, here the mean's.
    reference.layers.resize(1);
    const auto without = compareImages(picture, reference);
    EXPECT_NEAR(*without->mse, expected + 0.5 * v, 0.05 * v);
    EXPECT_FALSE(without->relMseUnsure);
}

/// The truth itself against noisy parts: as large as what is unsure, whatever the signs that chance gave.
TEST(Metrics, ErrorsAreNeverLessThanWhatIsUnsure)
{
    for (uint64_t seed = 0; seed < 8; ++seed)
    {
        ImageSet picture, reference;
        for (ImageSet* images : {&picture, &reference}) images->width = images->height = 8;
        picture.add("beauty", 3);
        for (const char* name : {"beauty", "beauty_a", "beauty_b", "beauty_c"}) reference.add(name, 3);
        Random random(seed, 2);
        for (Layer& layer : reference.layers)
            for (float& value : layer.pixels) value = 0.5f + 0.2f * (random.uniform() - 0.5f);
        for (float& value : picture.layers[0].pixels) value = 0.5f;
        const auto compared = compareImages(picture, reference);
        ASSERT_TRUE(compared) << compared.error().message;
        EXPECT_GE(*compared->relMse, *compared->relMseUnsure);
        EXPECT_GT(*compared->mse, 0.0);
        EXPECT_LT(*compared->relMse, 4.0 * *compared->relMseUnsure);
    }
}

TEST(Metrics, DamagedPartsAreRefused)
{
    ImageSet picture;
    picture.width = picture.height = 4;
    picture.add("beauty", 3);
    ImageSet reference = picture;
    reference.add("beauty_a", 3);
    reference.add("beauty_b", 3);
    reference.layers[2].pixels[7] = std::numeric_limits<float>::quiet_NaN();
    const auto refused = compareImages(picture, reference);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("'beauty_b' is damaged"), std::string::npos) << refused.error().message;
}

} // namespace
} // namespace sconce
