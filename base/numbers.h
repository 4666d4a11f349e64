#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace sconce
{

/// Whether every component is a finite number.
template <glm::length_t N, class T> bool finite(const glm::vec<N, T>& v)
{
    for (glm::length_t i = 0; i < N; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

/// Relative luminance of linear RGB with BT.709's primaries. Source: ITU-R BT.709-6, item 3.2.
inline constexpr glm::vec3 kLuminance{0.2126f, 0.7152f, 0.0722f};
inline float luminance(const glm::vec3& linearRgb)
{
    return kLuminance.x * linearRgb.x + kLuminance.y * linearRgb.y + kLuminance.z * linearRgb.z;
}

/// The lowest 10 bits, each followed by two zeros.
inline uint32_t spreadBits(uint32_t v)
{
    v &= 0x3ffu;
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

/// Place of a cell along a Morton curve through 1,024 cells an axis: neighbours on the curve are neighbours in space.
inline uint32_t mortonCode(const glm::uvec3& cell)
{
    return spreadBits(cell.x) | spreadBits(cell.y) << 1 | spreadBits(cell.z) << 2;
}

} // namespace sconce
