#include "placement/grid.h"

#include <algorithm>
#include <cmath>

#include "base/limits.h"

namespace sconce
{

glm::ivec3 gridShape(const Bounds& bounds, uint32_t count)
{
    const vec3 size = glm::max(bounds.size(), vec3(1e-6f * bounds.diagonal() + 1e-30f));
    const int wanted = std::max(int(count), 1);
    const int most = std::max(wanted, std::min(int(std::floor(1.15 * wanted)), int(kMostProbes)));
    const int least = int(std::ceil(0.85 * wanted));
    glm::ivec3 best(wanted, 1, 1);
    double bestScore = 1e300;
    for (int x = 1; x <= most; ++x)
        for (int y = 1; x * y <= most; ++y)
            for (int z = std::max(1, least / (x * y)); x * y * z <= most; ++z)
            {
                if (x * y * z < least) continue;
                const vec3 cell = size / vec3(x, y, z);
                const double stretch = std::log(double(std::max({cell.x, cell.y, cell.z})) / double(std::min({cell.x, cell.y, cell.z})));
                const double miss = std::abs(std::log(double(x * y * z) / double(wanted)));
                const double score = stretch + 4.0 * miss; // 10 % off in number weighs as much as cells half as long again
                if (score < bestScore) bestScore = score, best = {x, y, z};
            }
    return best;
}

ProbeGrid gridIn(const Bounds& bounds, glm::ivec3 count)
{
    const vec3 step = bounds.size() / vec3(count);
    return {count, bounds.low + 0.5f * step, step};
}

} // namespace sconce
