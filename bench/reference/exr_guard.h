#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sconce
{

/// The gate in front of OpenEXR 3.1, in whose readers of deep, tiled and lossily packed pictures faults are known: what it is given is one
/// part of scan lines, unpacked or packed by RLE, ZIP or PIZ, of a size that its bytes can hold (OpenEXR file layout,
/// https://openexr.com/en/latest/OpenEXRFileLayout.html).
struct ExrLimits
{
    static constexpr int64_t side = 16384;                    // pixels
    static constexpr uint64_t headerBytes = 1u << 20;         // of a header
    static constexpr uint64_t pixelBytes = uint64_t(4) << 30; // of all channels as floats
    static constexpr uint64_t mostExpansion = 2 * 1032;       // half floats read as floats, of deflate's greatest ratio
};

/// What is wrong with a picture before a library sees it, as the end of a sentence with what to do; empty: nothing.
/// @param start     the file's first bytes, at least its header
/// @param fileBytes of the whole file
std::string exrProblem(std::span<const std::byte> start, uint64_t fileBytes);

} // namespace sconce
