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

/// Points evenly by area over the triangles that are there.
class AreaPoints
{
public:
    AreaPoints(const Scene& drawn, const Visibility& visibility) : scene(drawn), areaUpTo(drawn.triangles.size())
    {
        for (size_t triangle = 0; triangle < areaUpTo.size(); ++triangle)
        {
            const uvec3 corners = scene.triangles[triangle];
            const vec3 a = scene.positions[corners.x];
            if (visibility.presence()[triangle] != Presence::absent)
                total += 0.5 * double(glm::length(glm::cross(scene.positions[corners.y] - a, scene.positions[corners.z] - a)));
            areaUpTo[triangle] = total;
        }
    }

    /// Uniform on a triangle: Turk 1990, "Generating Random Points in Triangles".
    vec3 draw(Random& random, uint32_t& triangle) const
    {
        const double pick = total * double(random.uniform());
        triangle = uint32_t(std::upper_bound(areaUpTo.begin(), areaUpTo.end() - 1, pick) - areaUpTo.begin());
        const uvec3 corners = scene.triangles[triangle];
        const float root = std::sqrt(random.uniform()), split = random.uniform();
        return (1.0f - root) * scene.positions[corners.x] + root * (1.0f - split) * scene.positions[corners.y] +
               root * split * scene.positions[corners.z];
    }

private:
    const Scene& scene;
    std::vector<double> areaUpTo;
    double total = 0.0;
};

/// Whether space that counts lies before a surface point: cells that touch the surface are not free, so the next ones are asked, too.
bool countsBefore(const Visibility& visibility, const FreeSpace& space, vec3 point, vec3 normal)
{
    for (const float cells : {0.75f, 1.5f, 2.25f})
    {
        const vec3 before = point + cells * space.field.voxel * normal;
        if (space.contains(before) && visibility.sees(before, point, normal)) return true;
    }
    return false;
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
    const AreaPoints points(scene, visibility);
    return collect(count, 24,
                   [&](size_t stream, Surfel& surfel) -> bool
                   {
                       Random random(seed, stream);
                       uint32_t triangle;
                       const vec3 point = points.draw(random, triangle);
                       // Either side, since surfaces are seen from both; the side that nobody gets to is dropped.
                       const vec3 normal = geometricNormal(scene, triangle) * (random.uniform() < 0.5f ? 1.0f : -1.0f);
                       if (!countsBefore(visibility, space, point, normal)) return false;
                       surfel = {point, normal, triangle, false};
                       return true;
                   });
}

float shareLeftOut(const Scene& scene, const Visibility& visibility, const FreeSpace& space, uint64_t seed)
{
    constexpr size_t kPoints = 8000;
    const AreaPoints points(scene, visibility);
    std::vector<uint8_t> out(kPoints);
    tbb::parallel_for(size_t(0), kPoints,
                      [&](size_t i)
                      {
                          Random random(seed, i);
                          uint32_t triangle;
                          const vec3 point = points.draw(random, triangle), normal = geometricNormal(scene, triangle);
                          out[i] = !countsBefore(visibility, space, point, normal) && !countsBefore(visibility, space, point, -normal);
                      });
    return float(std::count(out.begin(), out.end(), uint8_t(1))) / float(kPoints);
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
