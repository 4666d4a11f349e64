#include "placement/skeleton.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "base/random.h"

namespace sconce
{
namespace
{

constexpr float kRidgeSlope =
    0.75f; // two walls that meet at 83 degrees or less give a steeper field; the noise of the far field is below 0.2

bool onRidge(const DistanceField& field, size_t at)
{
    const glm::ivec3 cell = field.cell(at);
    // Across a thin wall the unsigned field rises again, so never look past the nearest surface.
    const int step = std::min(2, int(field.distance[at] / field.voxel));
    if (step < 1) return false;
    vec3 slope(0.0f);
    for (int axis = 0; axis < 3; ++axis)
    {
        glm::ivec3 low = cell, high = cell;
        low[axis] = std::max(cell[axis] - step, 0);
        high[axis] = std::min(cell[axis] + step, field.size[axis] - 1);
        if (high[axis] == low[axis]) continue;
        slope[axis] =
            (field.distance[field.index(high)] - field.distance[field.index(low)]) / (field.voxel * float(high[axis] - low[axis]));
    }
    return glm::length(slope) < kRidgeSlope;
}

struct Cluster
{
    glm::dvec3 sum{0.0};
    size_t cells = 0;
};

uint64_t clusterKey(glm::ivec3 cell, int side)
{
    const glm::ivec3 block = cell / side;
    return uint64_t(block.x) | uint64_t(block.y) << 20 | uint64_t(block.z) << 40;
}

size_t countClusters(const DistanceField& field, const std::vector<uint32_t>& ridge, int side)
{
    std::vector<uint64_t> keys;
    keys.reserve(ridge.size());
    for (uint32_t at : ridge) keys.push_back(clusterKey(field.cell(at), side));
    std::sort(keys.begin(), keys.end());
    return size_t(std::unique(keys.begin(), keys.end()) - keys.begin());
}

/// A position before a surface point: out along a random direction of the point's hemisphere, anywhere up to what is hit there. False when
/// the one drawn is not legal.
bool drawBefore(const LegalSpace& legal, const Surfel& surfel, float clearance, Random& random, vec3& position)
{
    vec3 direction = random.direction();
    if (glm::dot(direction, surfel.normal) < 0.0f) direction = -direction;
    const vec3 start = surfel.position + legal.visibility.epsilon() * surfel.normal;
    RayHit hit;
    const float reach = legal.visibility.cast(start, direction, hit) ? hit.t : legal.space.bounds.diagonal();
    // Squared: the far part of a cone is free more often, the near part sees more of what hides in a corner.
    const float share = random.uniform();
    position = start + share * share * reach * direction;
    return legal.allows(position, clearance);
}

} // namespace

bool LegalSpace::allows(vec3 point, float clearance) const
{
    for (const Pin& pin : pins)
        if (pin.kind == Pin::Kind::forbid && glm::distance(point, pin.position) <= pin.radius) return false;
    if (!space.contains(point) || visibility.distance(point, 1.001f * clearance) < clearance) return false;
    // A cell next to a thin wall may hold points beyond it: the way to the cell's centre must be free.
    const vec3 centre = space.field.centre(space.field.cellAt(point));
    return visibility.unoccluded(point, centre);
}

std::vector<Candidate> skeletonCandidates(const LegalSpace& legal, size_t count, float clearance)
{
    const FreeSpace& space = legal.space;
    const DistanceField& field = space.field;
    std::vector<uint8_t> isRidge(space.cells.size());
    tbb::parallel_for(size_t(0), space.cells.size(),
                      [&](size_t i)
                      {
                          const uint32_t at = space.cells[i];
                          isRidge[i] = field.distance[at] >= clearance && onRidge(field, at);
                      });
    std::vector<uint32_t> ridge;
    for (size_t i = 0; i < isRidge.size(); ++i)
        if (isRidge[i]) ridge.push_back(space.cells[i]);
    if (ridge.empty()) return {};

    // The smallest cluster side that gives no more than `count` clusters; the number falls as the side grows.
    int low = 1, high = std::max({field.size.x, field.size.y, field.size.z});
    while (low < high)
    {
        const int middle = (low + high) / 2;
        if (countClusters(field, ridge, middle) > count)
            low = middle + 1;
        else
            high = middle;
    }
    const int side = low;
    std::unordered_map<uint64_t, Cluster> clusters;
    for (uint32_t at : ridge)
    {
        Cluster& cluster = clusters[clusterKey(field.cell(at), side)];
        cluster.sum += glm::dvec3(field.cell(at));
        ++cluster.cells;
    }
    std::unordered_map<uint64_t, std::pair<double, uint32_t>> nearest; // to the centroid: squared distance in cells, cell
    std::vector<uint64_t> order;                                       // of first appearance, so that the result does not hang on hashing
    for (uint32_t at : ridge)
    {
        const uint64_t key = clusterKey(field.cell(at), side);
        const Cluster& cluster = clusters[key];
        const glm::dvec3 away = glm::dvec3(field.cell(at)) - cluster.sum / double(cluster.cells);
        const auto [entry, isNew] = nearest.try_emplace(key, glm::dot(away, away), at);
        if (isNew)
            order.push_back(key);
        else if (glm::dot(away, away) < entry->second.first)
            entry->second = {glm::dot(away, away), at};
    }
    std::vector<Candidate> found;
    for (uint64_t key : order)
    {
        const vec3 position = field.centre(field.cell(nearest[key].second));
        if (legal.allows(position, clearance)) found.push_back({position, Candidate::Origin::ridge});
    }
    return found;
}

std::vector<Candidate> spreadCandidates(const LegalSpace& legal, size_t count, float clearance, uint64_t seed)
{
    std::vector<Candidate> found;
    std::vector<vec3> drawn(std::max<size_t>(count, 64));
    std::vector<uint8_t> allowed(drawn.size());
    for (size_t round = 0; round < 64 && found.size() < count; ++round)
    {
        tbb::parallel_for(size_t(0), drawn.size(),
                          [&](size_t i)
                          {
                              Random random(seed, round * drawn.size() + i);
                              drawn[i] = legal.space.randomPoint(random);
                              allowed[i] = legal.allows(drawn[i], clearance);
                          });
        for (size_t i = 0; i < drawn.size() && found.size() < count; ++i)
            if (allowed[i]) found.push_back({drawn[i], Candidate::Origin::spread});
    }
    return found;
}

std::vector<Candidate> gapCandidates(const LegalSpace& legal, std::span<const Surfel> gaps, size_t count, float clearance, uint64_t seed)
{
    if (gaps.empty()) return {};
    std::vector<Candidate> found;
    std::vector<vec3> drawn(count);
    std::vector<uint8_t> allowed(count);
    for (size_t round = 0; round < 12 && found.size() < count; ++round)
    {
        tbb::parallel_for(size_t(0), count,
                          [&](size_t i)
                          {
                              Random random(seed, round * count + i);
                              allowed[i] = drawBefore(legal, gaps[random.below(gaps.size())], clearance, random, drawn[i]);
                          });
        for (size_t i = 0; i < count && found.size() < count; ++i)
            if (allowed[i]) found.push_back({drawn[i], Candidate::Origin::gap});
    }
    return found;
}

} // namespace sconce
