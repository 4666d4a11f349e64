#include "placement/ball_shrinking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <nanoflann.hpp>
#include <tbb/parallel_for.h>

#include "placement/surface_samples.h"

namespace sconce
{
namespace
{

constexpr size_t kSamplesEach = 12; // surface samples a candidate
constexpr size_t kLeastSamples = 20000;
constexpr size_t kMostSamples = 400000;
constexpr int kMostSteps = 48; // of shrinking; a handful is usual

/// Cosine of the least angle between the two touching points as seen from the centre, 20 degrees. Nearer ones are one jagged surface, whose
/// wrinkles would draw the ball in (the separation angle of Peters 2018, "Geographical point cloud modelling with the 3D medial axis
/// transform").
constexpr float kAlike = 0.94f;

struct Points
{
    const std::vector<Surfel>& surfels;
    size_t kdtree_get_point_count() const { return surfels.size(); }
    float kdtree_get_pt(size_t point, size_t axis) const { return surfels[point].position[int(axis)]; }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, uint32_t>;

/// Centre of the largest empty ball that touches the surface at a surfel.
vec3 shrunkenBall(const Tree& tree, const std::vector<Surfel>& surfels, const Surfel& surfel, float radius)
{
    for (int step = 0; step < kMostSteps; ++step)
    {
        const vec3 centre = surfel.position + radius * surfel.normal;
        uint32_t nearest = 0;
        float squared = 0.0f;
        tree.knnSearch(&centre.x, 1, &nearest, &squared);
        if (squared >= radius * radius * (1.0f - 1e-4f)) return centre;
        const vec3 away = surfels[nearest].position - surfel.position;
        const float rise = glm::dot(away, surfel.normal);
        if (!(rise > 0.0f)) return centre; // on or behind the tangent plane: rounding
        if (glm::dot(-surfel.normal, glm::normalize(surfels[nearest].position - centre)) > kAlike) return centre;
        radius = 0.5f * glm::dot(away, away) / rise;
    }
    return surfel.position + radius * surfel.normal;
}

/// Cell of the surfel in cells of `side` metres, and which way it faces.
std::array<int, 4> groupOf(const Surfel& surfel, vec3 low, float side)
{
    const glm::ivec3 cell = glm::max(glm::ivec3(glm::floor((surfel.position - low) / side)), glm::ivec3(0));
    const vec3 size = glm::abs(surfel.normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return {cell.x, cell.y, cell.z, 2 * axis + (surfel.normal[axis] > 0.0f)};
}

// Ordered, so that the order of the candidates does not hang on hashing.
using Groups = std::map<std::array<int, 4>, std::vector<uint32_t>>; // samples

Groups groupsOf(const std::vector<Surfel>& surfels, const std::vector<uint32_t>& members, vec3 low, float side)
{
    Groups groups;
    for (uint32_t member : members) groups[groupOf(surfels[member], low, side)].push_back(member);
    return groups;
}

} // namespace

std::vector<Candidate> ballCandidates(const Scene& scene, const LegalSpace& legal, size_t count, float clearance, uint64_t seed)
{
    const FreeSpace& space = legal.space;
    const std::vector<Surfel> surfels =
        areaSurfels(scene, legal.visibility, space, std::clamp(kSamplesEach * count, kLeastSamples, kMostSamples), seed);
    if (surfels.empty() || count == 0) return {};
    const Points points{surfels};
    Tree tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree.buildIndex();

    std::vector<vec3> centres(surfels.size());
    std::vector<uint8_t> allowed(surfels.size());
    tbb::parallel_for(size_t(0), surfels.size(),
                      [&](size_t s)
                      {
                          // A ball can't be wider than the way to the opposite surface, however sparse that one's samples are.
                          RayHit hit;
                          const vec3 start = surfels[s].position + legal.visibility.epsilon() * surfels[s].normal;
                          const float most = 0.5f * space.bounds.diagonal();
                          const float radius = legal.visibility.cast(start, surfels[s].normal, hit) ? std::min(0.5f * hit.t, most) : most;
                          centres[s] = shrunkenBall(tree, surfels, surfels[s], radius);
                          allowed[s] = legal.allows(centres[s], clearance);
                      });
    std::vector<uint32_t> members;
    for (uint32_t s = 0; s < surfels.size(); ++s)
        if (allowed[s]) members.push_back(s);

    // The smallest groups of which there are no more than `count`.
    float low = 0.0f, high = space.bounds.diagonal();
    for (int halving = 0; halving < 16; ++halving)
    {
        const float middle = 0.5f * (low + high);
        (groupsOf(surfels, members, space.bounds.low, middle).size() > count ? low : high) = middle;
    }
    std::vector<Candidate> found;
    for (const auto& [key, group] : groupsOf(surfels, members, space.bounds.low, high))
    {
        glm::dvec3 sum(0.0);
        for (uint32_t member : group) sum += glm::dvec3(centres[member]);
        vec3 position(sum / double(group.size()));
        if (!legal.allows(position, clearance))
            position = centres[*std::min_element(group.begin(), group.end(),
                                                 [&](uint32_t a, uint32_t b)
                                                 { return glm::distance(centres[a], position) < glm::distance(centres[b], position); })];
        found.push_back({position, Candidate::Origin::ball});
    }
    return found;
}

} // namespace sconce
