#include "placement/surface_samples.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "base/random.h"

namespace sconce
{
namespace
{

/// Draws candidates in batches, each from its own stream, and keeps the accepted ones in order: the same surfels for any number of threads.
template <class Draw> std::vector<Surfel> collect(size_t count, size_t triesEach, const Draw& draw)
{
    std::vector<Surfel> surfels;
    surfels.reserve(count);
    const size_t batch = std::max<size_t>(count, 256);
    std::vector<Surfel> drawn(batch);
    std::vector<uint8_t> accepted(batch);
    for (size_t round = 0; round < triesEach && surfels.size() < count; ++round)
    {
        tbb::parallel_for(size_t(0), batch, [&](size_t i) { accepted[i] = draw(round * batch + i, drawn[i]); });
        for (size_t i = 0; i < batch && surfels.size() < count; ++i)
            if (accepted[i]) surfels.push_back(drawn[i]);
    }
    return surfels;
}

} // namespace

std::vector<Surfel> raySurfels(const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed)
{
    return collect(count, 8,
                   [&](size_t stream, Surfel& surfel) -> bool
                   {
                       Random random(seed, stream);
                       const vec3 origin = space.randomPoint(random);
                       const vec3 direction = random.direction();
                       RayHit hit;
                       if (!visibility.cast(origin, direction, hit)) return false;
                       surfel = {origin + hit.t * direction, hit.normal, hit.triangle, hit.back};
                       return true;
                   });
}

std::vector<Surfel> areaSurfels(const Scene& scene, const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed)
{
    std::vector<double> areaUpTo(scene.triangles.size());
    double total = 0.0;
    for (size_t triangle = 0; triangle < areaUpTo.size(); ++triangle)
    {
        const uvec3 corners = scene.triangles[triangle];
        const vec3 a = scene.positions[corners.x];
        if (visibility.presence()[triangle] != Presence::absent)
            total += 0.5 * double(glm::length(glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a)));
        areaUpTo[triangle] = total;
    }
    return collect(count, 24,
                   [&](size_t stream, Surfel& surfel) -> bool
                   {
                       Random random(seed, stream);
                       const double pick = total * double(random.uniform());
                       const size_t triangle = size_t(std::upper_bound(areaUpTo.begin(), areaUpTo.end() - 1, pick) - areaUpTo.begin());
                       const uvec3 corners = scene.triangles[triangle];
                       // Uniform on a triangle: Turk 1990, "Generating Random Points in Triangles".
                       const float root = std::sqrt(random.uniform()), split = random.uniform();
                       const vec3 point = (1.0f - root) * scene.positions[corners.x] + root * (1.0f - split) * scene.positions[corners.y] +
                                          root * split * scene.positions[corners.z];
                       // Either side, since surfaces are seen from both; the test below drops the side that nobody gets to.
                       const vec3 normal = geometricNormal(scene, uint32_t(triangle)) * (random.uniform() < 0.5f ? 1.0f : -1.0f);
                       // A surfel counts where free space lies before it: cells that touch the surface are not free, so the next ones are
                       // asked, too.
                       for (const float cells : {0.75f, 1.5f, 2.25f})
                       {
                           const vec3 before = point + cells * space.field.voxel * normal;
                           if (!space.contains(before) || !visibility.sees(before, point, normal)) continue;
                           surfel = {point, normal, uint32_t(triangle), false};
                           return true;
                       }
                       return false;
                   });
}

float viewQuality(const Surfel& surfel, vec3 probe, float spacing)
{
    const vec3 toProbe = probe - surfel.position;
    const float distance = glm::length(toProbe);
    const float facing = glm::dot(surfel.normal, toProbe);
    if (!(facing > kLeastCosine * distance)) return 0.0f; // also a probe on the surfel itself
    return facing / distance * spacing / (spacing + distance);
}

} // namespace sconce
