#pragma once

#include <cstdint>
#include <span>

#include "runtime/bake/bake.h"

namespace sconce
{

/// Tells bakes apart by all that their fields' bytes depend on but program and device: scene, its name, probes, settings, and what earlier
/// bakes left in the layout. Cost: a hash of the scene's and its images' bytes.
uint64_t bakeKey(const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings);

/// Tells devices and their drivers apart, whose last bits may differ.
uint64_t deviceKey(const HostVulkan& host);

} // namespace sconce
