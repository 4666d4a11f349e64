#include "bench/sweep/picture_files.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::readText;
using testing_support::TestFolder;

/// The 16-bit (or 32-bit) numbers behind the header, which is checked, by the bytes as docs/results.md has them.
std::vector<uint32_t> numbersOf(const std::string& bytes, uint32_t width, uint32_t height, uint32_t kind)
{
    const auto number = [&](size_t at, size_t size)
    {
        uint32_t value = 0;
        for (size_t i = 0; i < size; ++i) value |= uint32_t(uint8_t(bytes.at(at + i))) << (8 * i);
        return value;
    };
    EXPECT_EQ(bytes.substr(0, 4), "SCNI");
    EXPECT_EQ(number(4, 4), width);
    EXPECT_EQ(number(8, 4), height);
    EXPECT_EQ(number(12, 4), kind);
    const size_t size = kind == 0 ? 2 : 4;
    EXPECT_EQ(bytes.size(), 16 + size_t(width) * height * (kind == 0 ? 3 : 1) * size);
    std::vector<uint32_t> numbers;
    for (size_t at = 16; at < bytes.size(); at += size) numbers.push_back(number(at, size));
    return numbers;
}

// Bits of half floats by IEEE 754-2008: sign, 5 exponent bits of bias 15, 10 of mantissa.
TEST(PictureFiles, HalvesAreWrittenByTheirBits)
{
    const TestFolder folder;
    const float rgb[] = {0.0f, 1.0f, 0.5f, -2.0f, 65504.0f, 1e9f, INFINITY, std::nanf(""), 1.0f + 1.0f / 1024.0f};
    ASSERT_TRUE(writeHalfPicture(folder / "a.bin", 3, 1, rgb).ok());
    const std::vector<uint32_t> halves = numbersOf(readText(folder / "a.bin"), 3, 1, 0);
    ASSERT_EQ(halves.size(), 9u);
    EXPECT_EQ(halves[0], 0x0000u);
    EXPECT_EQ(halves[1], 0x3c00u);
    EXPECT_EQ(halves[2], 0x3800u);
    EXPECT_EQ(halves[3], 0xc000u);
    EXPECT_EQ(halves[4], 0x7bffu);
    EXPECT_EQ(halves[5], 0x7bffu) << "the largest half, not infinity, which a page can't show";
    EXPECT_EQ(halves[6], 0x7bffu);
    EXPECT_EQ(halves[7] & 0x7c00u, 0x7c00u);
    EXPECT_NE(halves[7] & 0x03ffu, 0u) << "not a number";
    EXPECT_EQ(halves[8], 0x3c01u);
}

TEST(PictureFiles, NumbersAreWrittenAsTheyAre)
{
    const TestFolder folder;
    const uint32_t numbers[] = {0, 1, 0x01020304u, 0xffffffffu};
    ASSERT_TRUE(writeNumberPicture(folder / "a.bin", 2, 2, numbers).ok());
    EXPECT_EQ(numbersOf(readText(folder / "a.bin"), 2, 2, 1), (std::vector<uint32_t>(std::begin(numbers), std::end(numbers))));
    EXPECT_EQ(writeNumberPicture(folder / "none/a.bin", 2, 2, numbers).error().code, ErrorCode::fileError);
}

TEST(PictureFiles, LayersOfAFrameAreThoseOfAReference)
{
    RenderedFrame frame;
    frame.width = 2, frame.height = 1;
    frame.beauty = {{1, 2, 3}, {4, 5, 6}};
    frame.diffuseIndirect = {{7, 8, 9}, {10, 11, 12}};
    frame.glossyIndirect = {{13, 14, 15}, {16, 17, 18}};
    frame.depth = {0.5f, 0.0f};
    const ImageSet images = lightLayers(frame);
    EXPECT_EQ(images.width, 2u);
    EXPECT_EQ(images.height, 1u);
    ASSERT_EQ(images.layers.size(), 4u);
    ASSERT_NE(images.find("depth"), nullptr);
    EXPECT_EQ(images.find("depth")->pixels, (std::vector<float>{0.5f, 0.0f}));
    float next = 1.0f;
    for (const char* name : {"beauty", "diffuse_indirect", "glossy_indirect"})
    {
        ASSERT_NE(images.find(name), nullptr) << name;
        EXPECT_EQ(images.find(name)->channels, 3u);
        for (const float value : images.find(name)->pixels) EXPECT_EQ(value, next++) << name;
    }
    EXPECT_EQ(next, 19.0f);
}

} // namespace
} // namespace sconce
