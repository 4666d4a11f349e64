#pragma once

#include <cstdint>

namespace sconce
{

/// Probes of a light field: the octree's indices have 16 bits, and the highest says "none".
inline constexpr uint32_t kMostProbes = 65535;

/// Indices of the octree have 8 bits up to this many probes, 16 beyond.
inline constexpr uint32_t kMostProbesOf8Bits = 255;

} // namespace sconce
