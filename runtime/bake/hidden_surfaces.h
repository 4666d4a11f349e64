#pragma once

#include "runtime/bake/triangle_gather.h"

namespace sconce
{

/// Gathers light, by exact rays, at surfaces that no texel of a field's surface light shows: undersides, gaps, what stands behind things; a
/// mean for each voxel and facing (shaders/shared/hidden_light.h). Points are drawn evenly over the scene's surface, on each side that can
/// be seen from outside; where nothing arrives, that is kept only where a look-up would find light without, as in a dark room beside a lit
/// one. Afterwards the field's info.hidden and surfaceLight hold them. Cost: a look-up for each of up to some millions of points, and 64
/// rays for each voxel and facing.
/// @param lit   with surface light, without refined texels
/// @param sent  radiance that each texel sends, RGB9E5
void lightHiddenSurfaces(FieldData& lit, const TriangleGather& triangles, std::span<const uint32_t> sent);

} // namespace sconce
