#include "tests/placement/yardstick.h"

#include <tbb/parallel_for.h>

#include "base/random.h"
#include "placement/surface_samples.h"

namespace sconce::test
{

std::vector<vec3> yardstickProbes(const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed, size_t candidates,
                                  size_t surfels)
{
    std::vector<vec3> points;
    for (uint64_t stream = 0; points.size() < candidates && stream < 100 * candidates; ++stream)
    {
        Random random(seed, stream);
        const vec3 point = space.randomPoint(random);
        if (visibility.distance(point, space.field.voxel) >= space.field.voxel) points.push_back(point);
    }
    const std::vector<Surfel> targets = raySurfels(visibility, space, surfels, seed + 1);
    std::vector<std::vector<uint8_t>> sees(points.size(), std::vector<uint8_t>(targets.size(), 0));
    tbb::parallel_for(size_t(0), points.size(),
                      [&](size_t p)
                      {
                          for (size_t s = 0; s < targets.size(); ++s)
                          {
                              const vec3 toProbe = points[p] - targets[s].position;
                              sees[p][s] = glm::dot(toProbe, targets[s].normal) > kLeastCosine * glm::length(toProbe) &&
                                           visibility.sees(points[p], targets[s].position, targets[s].normal);
                          }
                      });
    std::vector<uint8_t> open(targets.size(), 1);
    std::vector<uint8_t> used(points.size(), 0);
    std::vector<vec3> chosen;
    while (chosen.size() < std::min(count, points.size()))
    {
        size_t best = points.size(), most = 0;
        for (size_t p = 0; p < points.size(); ++p)
        {
            if (used[p]) continue;
            size_t fresh = 0;
            for (size_t s = 0; s < targets.size(); ++s) fresh += sees[p][s] & open[s];
            if (best == points.size() || fresh > most) best = p, most = fresh; // nothing new: the first point left, which is a random one
        }
        used[best] = 1;
        chosen.push_back(points[best]);
        for (size_t s = 0; s < targets.size(); ++s) open[s] = open[s] & uint8_t(1 - sees[best][s]);
    }
    return chosen;
}

} // namespace sconce::test
