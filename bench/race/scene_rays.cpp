#include "bench/race/scene_rays.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "base/random.h"
#include "placement/free_space.h"
#include "placement/visibility.h"

namespace sconce
{
namespace
{

constexpr size_t kLeastViewpoints = 64; // cameras and interior points the rays' surfaces are seen from
constexpr size_t kLeastInterior = 6;    // of them in the reachable space

GlossyRaySettings judgedRays(uint32_t count, uint64_t seed)
{
    return {.count = count, .alphaLow = 0.1f, .alphaHigh = 0.3f, .seed = seed};
}

} // namespace

Result<RaySet> sceneRays(const Scene& scene, const RayScene& truth, uint32_t count, uint64_t seed)
{
    auto visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    auto space = findFreeSpace(scene, *visibility, {});
    if (!space) return space.error();
    const auto interior = size_t(std::ranges::count_if(scene.cameras, [&](const Camera& camera) { return space->contains(camera.eye); }));
    const size_t wanted =
        std::max(kLeastViewpoints - std::min(kLeastViewpoints, scene.cameras.size()), kLeastInterior - std::min(kLeastInterior, interior));
    Random random(seed, 77);
    std::vector<vec3> points;
    while (points.size() < wanted) points.push_back(space->randomPoint(random));
    return glossyRays(truth, scene.cameras, points, judgedRays(count, seed));
}

Result<RaySet> cameraRays(const Camera& camera, const RayScene& truth, uint32_t count, uint64_t seed)
{
    return glossyRays(truth, {&camera, 1}, {}, judgedRays(count, seed));
}

double embreeMilliseconds(const RayScene& scene, const RaySet& rays)
{
    std::vector<float> t(rays.size());
    double best = std::numeric_limits<double>::infinity();
    for (int width : {1, 8})
    {
        const auto begin = std::chrono::steady_clock::now();
        scene.distances(rays.origins, rays.directions, width, t);
        best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
}

} // namespace sconce
