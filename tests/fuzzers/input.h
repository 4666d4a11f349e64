#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "tests/support/files.h"

/// Reads bytes that anyone may have written: no crash, no error of a sanitizer, no exception that isn't caught, none of over 1 GB of
/// memory. By libFuzzer's rules (docs: https://llvm.org/docs/LibFuzzer.html): returns 0; keeps nothing from one call to the next.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

namespace sconce::testing_support
{

/// Bytes as the file that a reader is given.
inline std::filesystem::path inputFile(const uint8_t* bytes, size_t size, const char* name = "input")
{
    static const TestFolder folder; // removed when the program ends
    const std::filesystem::path file = folder.path / name;
    std::ofstream(file, std::ios::binary | std::ios::trunc).write(reinterpret_cast<const char*>(bytes), std::streamsize(size));
    return file;
}

} // namespace sconce::testing_support
