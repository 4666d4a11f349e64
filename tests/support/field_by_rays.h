#pragma once

#include <span>

#include "bench/reference/ray_scene.h"
#include "runtime/field/field_data.h"
#include "svo/build_octree.h"

namespace sconce::testing_support
{

/// A light field whose cube-face distance maps are cast with Embree instead of rasterised: the same words from other means, so that the
/// tracer is tested apart from the bake and the bake against something that is not itself. Radiance is black, irradiance empty.
/// @param positions world, metres
FieldData fieldByRays(const RayScene& scene, std::span<const glm::vec3> positions, uint32_t faceSize, const OctreeSettings& octree = {});

/// A uniform grid of octahedral probes for the baselines, cast the same way. Probe (x,y,z) lies at origin + step * (x,y,z), world metres.
FieldData gridByRays(const RayScene& scene, glm::ivec3 count, glm::vec3 origin, glm::vec3 step, uint32_t size);

/// Tracing settings of the medium quality.
gpu::TraceQuality defaultQuality();

} // namespace sconce::testing_support
