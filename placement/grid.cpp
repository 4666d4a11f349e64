#include "placement/grid.h"

#include <algorithm>
#include <cmath>

#include "base/limits.h"

namespace sconce
{
namespace
{

struct Scored
{
    double score;
    glm::ivec3 shape;
};

/// The best of them; of equal ones those that came first.
std::vector<glm::ivec3> bestOf(std::vector<Scored> all, size_t most)
{
    std::ranges::stable_sort(all, {}, &Scored::score);
    std::vector<glm::ivec3> shapes;
    for (size_t i = 0; i < std::min(most, all.size()); ++i) shapes.push_back(all[i].shape);
    return shapes;
}

/// Of a bounds' sides none is 0, so that flat ones have cells, too.
vec3 sidesOf(const Bounds& bounds)
{
    return glm::max(bounds.size(), vec3(1e-6f * bounds.diagonal() + 1e-30f));
}

double stretchOf(vec3 cell)
{
    return std::log(double(std::max({cell.x, cell.y, cell.z})) / double(std::min({cell.x, cell.y, cell.z})));
}

} // namespace

std::vector<glm::ivec3> gridShapes(const Bounds& bounds, uint32_t count, size_t most)
{
    const vec3 size = sidesOf(bounds);
    const int wanted = std::max(int(count), 1);
    const int upTo = std::max(wanted, std::min(int(std::floor(1.15 * wanted)), int(kMostProbes)));
    const int least = int(std::ceil(0.85 * wanted));
    std::vector<Scored> all;
    for (int x = 1; x <= upTo; ++x)
        for (int y = 1; x * y <= upTo; ++y)
            for (int z = std::max(1, least / (x * y)); x * y * z <= upTo; ++z)
            {
                if (x * y * z < least) continue;
                const double miss = std::abs(std::log(double(x * y * z) / double(wanted)));
                // 10 % off in number weighs as much as cells half as long again.
                all.push_back({stretchOf(size / vec3(x, y, z)) + 4.0 * miss, {x, y, z}});
            }
    return bestOf(std::move(all), most);
}

std::vector<glm::ivec3> powerOfTwoShapes(const Bounds& bounds, uint32_t count, size_t most)
{
    constexpr int kMostLog = 6;
    const vec3 size = sidesOf(bounds);
    std::vector<Scored> all;
    double nearest = std::numeric_limits<double>::infinity();
    for (int x = 0; x <= kMostLog; ++x)
        for (int y = 0; y <= kMostLog; ++y)
            for (int z = 0; z <= kMostLog; ++z)
            {
                if (1u << (x + y + z) > kMostProbes) continue; // more than an index has room for
                const double miss = std::abs(double(x + y + z) - std::log2(double(count)));
                if (miss > nearest) continue;
                if (miss < nearest) all.clear();
                nearest = miss;
                const glm::ivec3 shape(1 << x, 1 << y, 1 << z);
                all.push_back({stretchOf(size / vec3(shape)), shape});
            }
    return bestOf(std::move(all), most);
}

ProbeGrid gridIn(const Bounds& bounds, glm::ivec3 count, float margin)
{
    ProbeGrid grid{count, bounds.centre(), bounds.size()};
    for (int axis = 0; axis < 3; ++axis)
    {
        if (count[axis] < 2) continue;
        grid.step[axis] = bounds.size()[axis] / (float(count[axis] - 1) + 2.0f * margin);
        grid.origin[axis] = bounds.low[axis] + margin * grid.step[axis];
    }
    return grid;
}

} // namespace sconce
