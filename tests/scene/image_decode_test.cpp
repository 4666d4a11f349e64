#include "scene/image_decode.h"

#include "tests/scene/gltf_fixture.h"

namespace sconce
{
namespace
{

std::span<const uint8_t> asBytes(const std::string& text)
{
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

TEST(ImageDecode, PngIsExact)
{
    const std::vector<uint8_t> pixels{255, 0, 0, 255, 1, 2, 3, 4, 0, 255, 0, 128, 9, 8, 7, 0};
    const auto image = decodeImage(asBytes(test::pngBytes(2, 2, pixels)), "four");
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_EQ(image->width, 2u);
    EXPECT_EQ(image->rgba, pixels);
    EXPECT_EQ(image->name, "four");
}

TEST(ImageDecode, HugeHeadersAreRefusedBeforeDecoding)
{
    const std::string png = test::pngBytes(1, 1, {1, 2, 3, 4});
    for (const auto& [width, height] : {std::pair{30'000u, 30'000u}, {20'000u, 1u}, {16'000u, 16'000u}})
    {
        const auto image = decodeImage(asBytes(test::withPngSize(png, width, height)), "bomb");
        ASSERT_FALSE(image.ok());
        EXPECT_NE(image.error().message.find("'bomb' is " + std::to_string(width)), std::string::npos) << image.error().message;
    }
}

TEST(ImageDecode, EveryTruncationIsRefused)
{
    std::string png = test::pngBytes(16, 16, std::vector<uint8_t>(16 * 16 * 4, 77));
    const size_t end = png.rfind("IEND") - 4; // what is missing after the last pixel does no harm
    for (size_t length = 0; length + 8 < end; ++length) EXPECT_FALSE(decodeImage(asBytes(png.substr(0, length)), "cut").ok()) << length;
}

TEST(ImageDecode, OtherFormatsAreNamed)
{
    const auto fails = [](const std::string& bytes, const std::string& part)
    {
        const auto image = decodeImage(asBytes(bytes), "strange");
        ASSERT_FALSE(image.ok());
        EXPECT_NE(image.error().message.find(part), std::string::npos) << image.error().message;
    };
    fails("", "none of PNG, JPEG and WebP");
    fails("DDS |some pixels", "none of PNG, JPEG and WebP");
    fails(std::string("\xabKTX 20\xbb\r\n", 10), "KTX2");
    fails("\xff\xd8\xff\xe0garbage", "JPEG");
    fails(std::string("RIFF\x10\0\0\0WEBPVP8 garbage", 23), "WebP");
}

} // namespace
} // namespace sconce
