#pragma once

#include "bench/race/ray_sets.h"

namespace sconce
{

/// The rays that tracers are judged by: glossyRays() with GGX alpha 0.1 to 0.3 from surfaces that the scene's cameras see and, so that
/// there are 64 viewpoints and 6 of them inside, random points of the reachable space. (With 8 viewpoints shares move by a point with the
/// seed.) Errors: badArgument, badInput (a scene without surfaces or free space).
Result<RaySet> sceneRays(const Scene& scene, const RayScene& truth, uint32_t count, uint64_t seed);

/// Such rays from what one camera sees alone: of one frame.
Result<RaySet> cameraRays(const Camera& camera, const RayScene& truth, uint32_t count, uint64_t seed);

/// Wall-clock milliseconds that Embree takes for the distances of the rays on all cores, robust, the faster of one and eight rays a call.
double embreeMilliseconds(const RayScene& scene, const RaySet& rays);

} // namespace sconce
