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

/// Grey, 8 x 8, darker to the right and downwards.
std::string greyJpeg()
{
    const std::string hex =
        "ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d3042605565645f555d5b6a"
        "7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0000b080008000801011100ffc400140001000000000000000000000000"
        "00000003ffc40017100003010000000000000000000000000000030461ffda0008010100003f0066d3a7ffd9";
    std::string bytes;
    for (size_t i = 0; i < hex.size(); i += 2) bytes += char(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
}

// Cameras and old exporters leave bytes between markers; a file that ends early is another thing.
TEST(ImageDecode, BytesBetweenAJpegsMarkersDoNoHarm)
{
    const std::string whole = greyJpeg();
    const auto image = decodeImage(asBytes(whole), "grey");
    ASSERT_TRUE(image.ok()) << image.error().message;
    std::string padded = whole;
    padded.insert(20, "\x01\x02"); // after the first header
    const auto same = decodeImage(asBytes(padded), "grey");
    ASSERT_TRUE(same.ok()) << same.error().message;
    EXPECT_EQ(same->rgba, image->rgba);
    EXPECT_FALSE(decodeImage(asBytes(whole.substr(0, whole.size() - 6)), "cut").ok());
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
