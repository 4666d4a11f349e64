#include "scene/closed_parts.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace sconce
{

std::vector<uint32_t> weld(const std::vector<vec3>& positions)
{
    std::vector<uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](uint32_t i) { return std::array<float, 3>{positions[i].x, positions[i].y, positions[i].z}; };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    for (size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
    return first;
}

namespace
{

/// Sets that grow together (union-find with path halving), named by the lowest of their members.
class Sets
{
public:
    explicit Sets(size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0u); }
    uint32_t rootOf(uint32_t v)
    {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    }
    void join(uint32_t a, uint32_t b)
    {
        const uint32_t rootA = rootOf(a), rootB = rootOf(b);
        parent[std::max(rootA, rootB)] = std::min(rootA, rootB);
    }

private:
    std::vector<uint32_t> parent;
};

} // namespace

std::vector<uint32_t> joinedParts(const Scene& scene, std::span<const uint32_t> triangles)
{
    std::vector<vec3> corners;
    for (const uint32_t triangle : triangles)
        for (int i = 0; i < 3; ++i) corners.push_back(scene.positions[scene.triangles[triangle][i]]);
    const std::vector<uint32_t> welded = weld(corners);
    Sets parts(triangles.size());
    for (uint32_t c = 0; c < corners.size(); ++c) parts.join(c / 3, welded[c] / 3);
    std::vector<uint32_t> first;
    for (uint32_t i = 0; i < triangles.size(); ++i) first.push_back(parts.rootOf(i));
    return first;
}

std::vector<Outside> outsideOf(const Scene& scene, std::span<const uint32_t> triangles)
{
    const std::vector<uint32_t> welded = weld(scene.positions);
    Sets parts(scene.positions.size()); // of vertices
    const auto rootOf = [&](uint32_t v) { return parts.rootOf(v); };
    struct Edge
    {
        uint64_t between; // lower vertex, higher vertex
        int way;          // 1: from the lower to the higher
    };
    std::vector<Edge> edges;
    edges.reserve(3 * scene.triangles.size());
    std::vector<double> volume(scene.positions.size(), 0.0); // of a part, at its root; signed, six times
    for (const uvec3 t : scene.triangles)
    {
        const uint32_t corner[3] = {welded[t.x], welded[t.y], welded[t.z]};
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue; // no area, no side
        for (int i = 0; i < 3; ++i)
        {
            const uint32_t a = corner[i], b = corner[(i + 1) % 3];
            parts.join(a, b);
            edges.push_back({uint64_t(std::min(a, b)) << 32 | std::max(a, b), a < b ? 1 : -1});
        }
    }
    for (const uvec3 t : scene.triangles)
    {
        // About the part's own vertex: far from the origin the sum would cancel.
        const uint32_t root = rootOf(welded[t.x]);
        const glm::dvec3 origin(scene.positions[root]);
        const glm::dvec3 a = glm::dvec3(scene.positions[t.x]) - origin, b = glm::dvec3(scene.positions[t.y]) - origin,
                         c = glm::dvec3(scene.positions[t.z]) - origin;
        volume[root] += glm::dot(a, glm::cross(b, c));
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.between < b.between; });
    std::vector<bool> open(scene.positions.size(), false);
    for (size_t i = 0; i < edges.size();)
    {
        int sum = 0;
        const uint64_t between = edges[i].between;
        for (; i < edges.size() && edges[i].between == between; ++i) sum += edges[i].way;
        if (sum != 0) open[rootOf(uint32_t(between >> 32))] = true;
    }
    std::map<uint32_t, Bounds> closed; // of the parts asked about, by root
    for (const uint32_t triangle : triangles)
    {
        const uint32_t root = rootOf(welded[scene.triangles[triangle].x]);
        if (!open[root] && volume[root] != 0.0) closed.emplace(root, Bounds());
    }
    for (const uvec3 t : scene.triangles)
        if (const auto part = closed.find(rootOf(welded[t.x])); part != closed.end())
            for (int i = 0; i < 3; ++i) part->second.add(scene.positions[t[i]]);
    const Bounds all = scene.bounds();
    std::erase_if(closed,
                  [&](const auto& part)
                  {
                      const auto& [root, box] = part;
                      if (box.low == all.low && box.high == all.high) return true;
                      for (const uvec3 t : scene.triangles)
                      {
                          const vec3 p = scene.positions[t.x];
                          const bool within = glm::all(glm::greaterThan(p, box.low)) && glm::all(glm::lessThan(p, box.high));
                          if (within && rootOf(welded[t.x]) != root) return true;
                      }
                      return false;
                  });
    std::vector<Outside> outside;
    for (const uint32_t triangle : triangles)
    {
        const uint32_t root = rootOf(welded[scene.triangles[triangle].x]);
        outside.push_back(!closed.contains(root) ? Outside::both : volume[root] > 0.0 ? Outside::front : Outside::back);
    }
    return outside;
}

} // namespace sconce
