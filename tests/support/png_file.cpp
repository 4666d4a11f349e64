#include "tests/support/png_file.h"

#include <gtest/gtest.h>
#include <png.h>

namespace sconce::testing_support
{

PngFile readPng(const std::filesystem::path& file)
{
    PngFile read;
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image, file.c_str()))
    {
        ADD_FAILURE() << file << ": " << image.message;
        return read;
    }
    image.format = PNG_FORMAT_RGB;
    read.rgb.resize(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, read.rgb.data(), 0, nullptr))
    {
        ADD_FAILURE() << file << ": " << image.message;
        return {};
    }
    read.width = image.width;
    read.height = image.height;
    return read;
}

} // namespace sconce::testing_support
