#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sconce::testing_support
{

/// 8 bits a channel as they are in the file, row 0 at the top.
struct PngFile
{
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

/// A file that can't be read fails the test, and is empty.
PngFile readPng(const std::filesystem::path& file);

} // namespace sconce::testing_support
