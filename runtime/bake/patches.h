#pragma once

#include <cstdint>
#include <span>

#include "runtime/field/field_data.h"

namespace sconce
{

/// Fills `patches`; on any number of threads the same bytes. Cost: a few ms a probe and core.
/// @param surfaces  reflectance and shading normal a radiance texel, 0: sky
/// @param emitted   emission a radiance texel, R11G11B10F; empty: the scene has no emitters
void makePatches(FieldData& field, std::span<const uint32_t> surfaces, std::span<const uint32_t> emitted);

} // namespace sconce
