// What OpenEXR is not to be given is told from its first bytes.
#include "bench/reference/exr_guard.h"

#include <cstring>

#include <gtest/gtest.h>

#include "bench/reference/image_io.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using testing_support::TestFolder;

/// A picture of 7x3 pixels and four channels.
std::string picture()
{
    const TestFolder folder;
    ImageSet images;
    images.width = 7, images.height = 3;
    images.add("beauty", 3);
    images.add("depth", 1);
    EXPECT_TRUE(writeExr(images, folder / "a.exr"));
    return testing_support::readText(folder / "a.exr");
}

std::string problemOf(std::string_view file)
{
    return exrProblem(std::as_bytes(std::span(file)), file.size());
}

/// The value of an attribute: after its name, its type and 4 bytes of size.
size_t valueOf(const std::string& file, const std::string& name, const std::string& type)
{
    return file.find(name + '\0' + type + '\0') + name.size() + type.size() + 2 + 4;
}

template <class T> std::string with(std::string file, size_t at, T value)
{
    std::memcpy(file.data() + at, &value, sizeof(T));
    return file;
}

TEST(ExrGuard, OursPassAndOtherKindsAreRefusedByName)
{
    const std::string good = picture();
    EXPECT_EQ(problemOf(good), "");
    EXPECT_NE(problemOf("not an EXR").find("no OpenEXR picture"), std::string::npos);
    for (const uint32_t flag : {0x200u, 0x800u, 0x1000u}) // tiled, deep, of several parts
        EXPECT_NE(problemOf(with(good, 4, 2u | flag)).find("tiled, deep or of several parts"), std::string::npos) << flag;
    EXPECT_EQ(problemOf(with(good, 4, 2u | 0x400u)), "") << "long names";
    const size_t compression = valueOf(good, "compression", "compression");
    for (uint8_t kind = 0; kind < 12; ++kind) EXPECT_EQ(problemOf(with(good, compression, kind)).empty(), kind <= 4) << int(kind);
}

TEST(ExrGuard, SizesThatItsBytesCannotHoldAreRefused)
{
    const std::string good = picture();
    const size_t window = valueOf(good, "dataWindow", "box2i");
    const auto sized = [&](int32_t left, int32_t top, int32_t right, int32_t bottom)
    { return problemOf(with(with(with(with(good, window, left), window + 4, top), window + 8, right), window + 12, bottom)); };
    EXPECT_EQ(sized(-3, 5, 3, 7), "");
    EXPECT_NE(sized(0, 0, -1, 2).find("0x3 pixels"), std::string::npos);
    EXPECT_NE(sized(0, 0, INT32_MAX, 2).find("2147483648x3 pixels"), std::string::npos);
    EXPECT_NE(sized(INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX).find("4294967296x4294967296"), std::string::npos);
    EXPECT_NE(sized(INT32_MAX - 6, 0, INT32_MAX, 2).find("from the origin"), std::string::npos);
    EXPECT_NE(sized(0, 0, 16383, 16383).find("don't fit"), std::string::npos);
    const size_t channels = valueOf(good, "channels", "chlist");
    const size_t sampling = good.find('\0', channels) + 1 + 8; // after the first channel's name, type and linearity
    EXPECT_NE(problemOf(with(good, sampling, 2)).find("attribute 'channels'"), std::string::npos);
}

// OpenEXR 3.1 took 1.9 GB for a header of 300 bytes.
TEST(ExrGuard, ValuesOfAnotherSizeThanTheirTypesAreRefused)
{
    const std::string good = picture();
    for (const auto& [name, type] : {std::pair("dataWindow", "box2i"), {"compression", "compression"}, {"pixelAspectRatio", "float"}})
    {
        const size_t value = valueOf(good, name, type);
        const auto size = uint32_t(uint8_t(good[value - 4]));
        std::string longer = with(good, value - 4, size + 1);
        longer.insert(value + size, 1, '\0');
        EXPECT_NE(problemOf(longer).find("attribute '" + std::string(name) + "' is damaged"), std::string::npos) << problemOf(longer);
    }
    std::string other = good;
    other.replace(other.find("pixelAspectRatio") + 17, 5, "thing");
    EXPECT_NE(problemOf(other).find("of a kind that isn't read"), std::string::npos) << problemOf(other);
}

TEST(ExrGuard, AHeaderThatIsCutShortIsRefused)
{
    const std::string good = picture();
    const size_t end = valueOf(good, "screenWindowWidth", "float") + 4 + 1; // the header's last
    EXPECT_EQ(problemOf(good.substr(0, end)), "");
    for (size_t size = 0; size < end; ++size) EXPECT_NE(problemOf(good.substr(0, size)), "") << size;
}

TEST(ExrGuard, NoChangedByteOfAHeaderEndsTheProgram)
{
    const TestFolder folder;
    const std::string good = picture();
    for (size_t at = 0; at < good.size(); ++at)
        for (const char flip : {char(1), char(0x80)})
        {
            testing_support::writeText(folder / "a.exr", with(good, at, char(good[at] ^ flip)));
            if (const auto read = readExr(folder / "a.exr"); !read)
            {
                EXPECT_NE(read.error().message.find("a.exr"), std::string::npos);
            }
        }
}

} // namespace
} // namespace sconce
