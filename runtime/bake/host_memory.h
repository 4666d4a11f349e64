#pragma once

#include <cstdint>

namespace sconce
{

/// Bytes of main memory that can be taken before the machine swaps or ends programs: what Linux calls available. Systems hand out more than
/// they have, so that a refusal must come before. Where it isn't told: the largest number.
uint64_t freeHostBytes();

} // namespace sconce
