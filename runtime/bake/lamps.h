#pragma once

#include <vector>

#include "runtime/field/field_data.h"
#include "scene/exact_rays.h"

namespace sconce
{

/// Emitters whose shadows are sharper than texels of surface light, with a map of what they see: shaders/shared/lamps.h.
struct Lamps
{
    std::vector<gpu::Lamp> lamps;
    std::vector<uint32_t> maps;      // FieldData::lampMaps
    std::vector<uint32_t> triangles; // of the scene that they are, ascending
    std::vector<uint32_t> oneOf;     // a triangle of each lamp
};

/// Of a scene's emitters those that are lamps: a triangle or a convex quadrilateral that shines evenly, alone, to one side; seen under less
/// than 0.1 radians from where its light falls, so that a shadow's edge is narrower than a tenth of the way to what casts it; which gives 2
/// % or more of what all emitters would give unshadowed; whose light falls within 63 degrees of its normal. At most gpu::kMostLamps, the
/// brightest first. Deterministic. Cost: 16,384 rays, and for each lamp a ray a texel of its map.
/// @param space   of the field
/// @param probes  whose surroundings tell where light falls
/// @param texels  a side of a map: a multiple of gpu::kLampBlock squared
Lamps findLamps(const ExactRays& rays, const gpu::LightFieldInfo& space, std::span<const gpu::ProbeHeader> probes, uint32_t texels);

/// The same lamps in a scene of the same triangles that shine otherwise, or not at all.
Lamps lampsIn(const Scene& scene, Lamps lamps);

} // namespace sconce
