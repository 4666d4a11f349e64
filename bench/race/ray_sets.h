#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "bench/race/trace_score.h"
#include "bench/reference/ray_scene.h"

namespace sconce
{

struct GlossyRaySettings
{
    uint32_t count = 100000;
    float alphaLow = 0.02f; // GGX alpha, drawn uniformly between low and high, [1e-3, 1]
    float alphaHigh = 0.3f;
    uint64_t seed = 1;
};

/// Reflection rays as glossy surfaces send them: from what random pixels of the cameras see (square pictures) and what random
/// directions from the interior points see, reflected about a visible GGX normal around the shading normal. In the order of the
/// viewpoints' pictures, each along a Z-order curve: as coherent as a frame's rays. The same rays for the same seed and any number of
/// threads. Errors: badArgument names the setting; badInput when no viewpoint sees a surface.
Result<RaySet> glossyRays(const RayScene& rays, std::span<const Camera> cameras, std::span<const vec3> points,
                          const GlossyRaySettings& settings);

/// A set from given rays, with Embree's truth; directions must be unit. startCosine is 1.
RaySet raySetFrom(const RayScene& rays, std::span<const vec3> origins, std::span<const vec3> directions);

} // namespace sconce
