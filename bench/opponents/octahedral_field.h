#pragma once

#include "base/result.h"
#include "runtime/field/field_data.h"

namespace sconce
{

/// What our tracer reads on the octahedral chart, made from cube faces: a map of N x N texels a probe, each the plane of the face texel
/// that its centre's direction falls in, and the chain over it (shaders/shared/face_chain.h). A texel's plane is that of the octant its
/// centre lies in; on the map's diagonals, where octants meet within texels, it is exact on one side. Radiance by the same texels;
/// irradiance, headers and octree are the faces' own.
/// @param size  N, texels a side, a multiple of 64
/// Errors: badArgument (the size), badInput (not cube faces). Cost: 5 N^2 texels a probe, all cores.
Result<FieldData> octahedralField(const FieldData& faces, uint32_t size);

/// The same light field with octahedral maps of N x N texels that hold nothing yet: what does not depend on the chart is the faces' own.
FieldData octahedralCopy(const FieldData& faces, uint32_t size, uint32_t topLevel, uint32_t wordsPerProbe);

} // namespace sconce
