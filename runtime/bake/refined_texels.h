#pragma once

#include "runtime/bake/triangle_gather.h"

namespace sconce
{

/// Refines the texels of a field's surface light (shaders/shared/surface_light.h) within which light changes most, for their area: those
/// whose light is off what their neighbours on the same surface would have it, of the two probes that light a place; into finer ones,
/// gathered by exact rays. Afterwards the field's info.refinedTexels and surfaceLight hold them.
/// @param lit    with surface light, none of it refined
/// @param sent   radiance that each texel sends, RGB9E5
/// @param share  of all texels, at most
void refineTexels(FieldData& lit, const TriangleGather& triangles, std::span<const uint32_t> sent, float share);

} // namespace sconce
