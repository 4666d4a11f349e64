#include "bench/reference/image_io.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

namespace fs = std::filesystem;

class ImageIo : public testing::Test
{
protected:
    void SetUp() override
    {
        folder = fs::path(testing::TempDir()) /
                 ("sconce_image_io_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path folder;
};

ImageSet sample()
{
    ImageSet images;
    images.width = 7;
    images.height = 3;
    for (const char* name : {"beauty", "direct", "normal"}) images.add(name, 3);
    images.add("depth", 1);
    float value = -3.25f;
    for (Layer& layer : images.layers)
        for (float& p : layer.pixels) p = (value += 0.1f);
    return images;
}

TEST_F(ImageIo, ExrReturnsEveryBit)
{
    const ImageSet images = sample();
    const Status written = writeExr(images, folder / "a.exr");
    ASSERT_TRUE(written.ok()) << written.error().message;
    const auto read = readExr(folder / "a.exr");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->width, 7u);
    EXPECT_EQ(read->height, 3u);
    ASSERT_EQ(read->layers.size(), images.layers.size());
    for (const Layer& layer : images.layers)
    {
        const Layer* found = read->find(layer.name);
        ASSERT_NE(found, nullptr) << layer.name;
        EXPECT_EQ(found->channels, layer.channels);
        EXPECT_EQ(found->pixels, layer.pixels) << layer.name;
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1); // no temporary file is left
}

TEST_F(ImageIo, FailuresNameTheFile)
{
    const Status unwritable = writeExr(sample(), folder / "nowhere" / "a.exr");
    ASSERT_FALSE(unwritable.ok());
    EXPECT_EQ(unwritable.error().code, ErrorCode::fileError);
    EXPECT_NE(unwritable.error().message.find("nowhere"), std::string::npos);
    EXPECT_FALSE(readExr(folder / "missing.exr").ok());
    std::ofstream(folder / "text.exr") << "not an EXR";
    EXPECT_FALSE(readExr(folder / "text.exr").ok());
    EXPECT_FALSE(writeExr(ImageSet{}, folder / "empty.exr").ok());
    EXPECT_FALSE(writePng(std::vector<float>(5), 2, 2, folder / "a.png").ok());
}

TEST_F(ImageIo, PngIsWrittenWhole)
{
    ASSERT_TRUE(writePng(std::vector<float>(4 * 2 * 3, 0.5f), 4, 2, folder / "a.png").ok());
    std::ifstream file(folder / "a.png", std::ios::binary);
    std::string head(8, ' ');
    file.read(head.data(), 8);
    EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(ToneMap, RisesFromBlackToWhiteAndInverts)
{
    EXPECT_EQ(toneMapAces(0.0f), 0.0f);
    EXPECT_EQ(toneMapAces(-1.0f), 0.0f);
    EXPECT_EQ(toneMapAces(std::nanf("")), 0.0f);
    EXPECT_EQ(toneMapAces(std::numeric_limits<float>::infinity()), 1.0f);
    for (float x = 0.0f; x < 10.0f; x += 0.1f) EXPECT_LE(toneMapAces(x), toneMapAces(x + 0.1f));
    for (float y : {0.1f, 0.5f, 0.85f}) EXPECT_NEAR(toneMapAces(inverseToneMapAces(y)), y, 1e-5f);
}

TEST(AutoExposure, TakesAGreyPictureToMiddleGrey)
{
    EXPECT_NEAR(autoExposure(std::vector<float>(30, 4.0f)), 0.18f / 4.0f, 1e-5f);
    EXPECT_EQ(autoExposure(std::vector<float>(30, 0.0f)), 1.0f);
}

TEST(Srgb, KnownPoints)
{
    EXPECT_NEAR(srgbFromLinear(0.2140411f), 0.5f, 1e-5f); // IEC 61966-2-1
    EXPECT_EQ(srgbFromLinear(0.0f), 0.0f);
    EXPECT_EQ(srgbFromLinear(2.0f), 1.0f);
}

} // namespace
} // namespace sconce
