#include "bench/race/distance_format.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/parallel.h"
#include "runtime/field/field_space.h"

namespace sconce
{
namespace
{

constexpr DistanceFormat kFormats[] = {{32, 16, 8}, {24, 16, 4}, {20, 12, 4}, {16, 16, 0}, {12, 12, 0}};

/// A half with its last bits rounded away, to nearest; not to 0, which is the sky's.
uint32_t roundedHalf(uint32_t half, int bits)
{
    if (half == 0 || bits == 16) return half;
    const uint32_t step = 1u << (16 - bits);
    return std::clamp((half + step / 2) / step * step, step, 0x7bffu / step * step);
}

/// A gradient byte that `bits` signed bits can say, zero and as many steps either way.
uint32_t roundedGradient(uint32_t byte, int bits)
{
    if (bits == 8) return byte & 0xffu;
    if (bits == 0) return 0;
    const float steps = float((1 << (bits - 1)) - 1);
    const float share = float(int8_t(byte & 0xffu)) / 127.0f;
    return uint32_t(int(std::lround(std::round(share * steps) / steps * 127.0f))) & 0xffu;
}

} // namespace

std::span<const DistanceFormat> distanceFormats()
{
    return kFormats;
}

Result<FieldData> narrowedField(FieldData faces, int bits)
{
    const auto format = std::ranges::find(kFormats, bits, &DistanceFormat::bits);
    if (format == std::end(kFormats))
    {
        std::string known;
        for (const DistanceFormat& one : kFormats) known += fmt::format("{}{}", known.empty() ? "" : ", ", one.bits);
        return Error{ErrorCode::badArgument, fmt::format("There is no distance format of {} bits; there are {}.", bits, known)};
    }
    if (faces.info.chart != gpu::kChartCube)
        return Error{ErrorCode::badInput, "Distance formats are ours, of cube faces; these maps are octahedral. Bake with --chart cube."};
    if (format == std::begin(kFormats)) return faces;
    const size_t texels = size_t(faces.info.faceSize) * faces.info.faceSize, wordsPerFace = faces.info.wordsPerProbe / 6;
    parallelFor(6 * faces.probes.size(),
                [&](size_t face)
                {
                    uint32_t* words = faces.distance.data() + face * wordsPerFace;
                    for (uint32_t& word : std::span(words, texels))
                        word = roundedHalf(word & 0xffffu, format->q) | roundedGradient(word >> 16, format->gradient) << 16 |
                               roundedGradient(word >> 24, format->gradient) << 24;
                    buildChain(words, faces.info.faceSize);
                });
    return faces;
}

uint64_t bytesSaved(const FieldData& faces, int bits)
{
    const uint64_t texels = uint64_t(6) * faces.info.faceSize * faces.info.faceSize * faces.probes.size();
    return texels * uint64_t(kFormats[0].bits - bits) / 8;
}

} // namespace sconce
