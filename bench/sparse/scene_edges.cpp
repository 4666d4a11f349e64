#include "bench/sparse/scene_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "scene/closed_parts.h"

namespace sconce
{
namespace
{

constexpr int kMostHalvings = 12; // of an edge, on its way to a shadow's border
constexpr int kFirstParts = 4;    // of an edge, so that a border that leaves a surface and comes back is found

/// The triangles of an edge, by its welded ends.
struct Neighbours
{
    std::array<uint32_t, 2> triangles{};
    uint32_t count = 0;
};

float areaOf(const Scene& scene, uint32_t triangle)
{
    const uvec3 t = scene.triangles[triangle];
    return glm::length(glm::cross(scene.positions[t.y] - scene.positions[t.x], scene.positions[t.z] - scene.positions[t.x]));
}

vec3 middleOf(const Scene& scene, uint32_t triangle)
{
    const uvec3 t = scene.triangles[triangle];
    return (scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z]) / 3.0f;
}

SceneEdge makeEdge(const Scene& scene, vec3 a, vec3 b, const Neighbours& of)
{
    const uint32_t first = of.triangles[0], second = of.count > 1 ? of.triangles[1] : first;
    SceneEdge edge{{a, b}, {geometricNormal(scene, first), geometricNormal(scene, second)}};
    edge.alone = of.count != 2;
    const float cosine = std::cos(kSharp * std::numbers::pi_v<float> / 180.0f);
    edge.sharp = !edge.alone &&
                 (scene.triangleMaterial[first] != scene.triangleMaterial[second] || glm::dot(edge.normals[0], edge.normals[1]) < cosine);
    const vec3 along = glm::normalize(b - a);
    vec3 off = 0.5f * (a + b) - 0.5f * (middleOf(scene, first) + middleOf(scene, second));
    off -= glm::dot(off, along) * along;
    if (const float length = glm::length(off); length > 0.0f) edge.away = off / length;
    return edge;
}

/// A light as an edge sees it.
struct From
{
    const Light& light;

    bool isFar() const { return light.type == LightType::directional; }
    vec3 toward(vec3 point) const { return isFar() ? -light.direction : light.position - point; }
    vec3 travel(vec3 point) const { return glm::normalize(-toward(point)); }
    float distance(vec3 point) const { return isFar() ? 1e30f : glm::length(toward(point)); }
    bool reaches(vec3 point) const
    {
        if (light.range > 0.0f && distance(point) > light.range) return false;
        return light.type != LightType::spot || glm::dot(travel(point), light.direction) > std::cos(light.outerCone);
    }
};

/// Walks the border of the shadow that one edge throws.
class Border
{
public:
    Border(const RayScene& scene, const SceneEdge& of, const Light& light, const std::function<bool(vec3, vec3)>& near,
           std::vector<EdgePiece>& to)
        : rays(scene), edge(of), from{light}, fine(near), pieces(to)
    {
    }

    void walk()
    {
        std::optional<Met> before = at(0.0f);
        for (int i = 1; i <= kFirstParts; ++i)
        {
            const std::optional<Met> after = at(float(i) / kFirstParts);
            between(float(i - 1) / kFirstParts, before, float(i) / kFirstParts, after, 0);
            before = after;
        }
    }

private:
    struct Met
    {
        vec3 place, normal;
    };

    /// Where light that just passes the edge there ends; nothing where it doesn't come so far, or leaves the scene.
    std::optional<Met> at(float share) const
    {
        const vec3 point = glm::mix(edge.ends[0], edge.ends[1], share);
        if (!from.reaches(point)) return std::nullopt;
        const vec3 passing = point + 8.0f * rays.offset() * edge.away, travel = from.travel(point);
        if (rays.occluded(passing, -travel, from.distance(point) * 0.999f)) return std::nullopt;
        const auto hit = rays.closest(passing, travel);
        if (!hit || hit->t < 16.0f * rays.offset()) return std::nullopt; // nothing lies in this shadow
        if (!from.reaches(hit->position)) return std::nullopt;
        return Met{hit->position, hit->geometricNormal};
    }
    static bool onOneSurface(const Met& a, const Met& b)
    {
        const vec3 way = b.place - a.place;
        const float length = glm::length(way);
        return length == 0.0f || (std::abs(glm::dot(way, a.normal)) < 0.2f * length && std::abs(glm::dot(way, b.normal)) < 0.2f * length);
    }
    void between(float first, const std::optional<Met>& a, float last, const std::optional<Met>& b, int halvings)
    {
        if (!a && !b) return;
        if (a && b && onOneSurface(*a, *b) && fine(a->place, b->place))
        {
            pieces.push_back({a->place, b->place});
            return;
        }
        if (halvings == kMostHalvings) return;
        const float middle = 0.5f * (first + last);
        const std::optional<Met> m = at(middle);
        between(first, a, middle, m, halvings + 1);
        between(middle, m, last, b, halvings + 1);
    }

    const RayScene& rays;
    const SceneEdge& edge;
    From from;
    const std::function<bool(vec3, vec3)>& fine;
    std::vector<EdgePiece>& pieces;
};

} // namespace

std::vector<SceneEdge> edgesOf(const Scene& scene)
{
    const std::vector<uint32_t> welded = weld(scene.positions);
    const std::vector<Presence> presence = trianglePresence(scene);
    std::map<std::array<uint32_t, 2>, Neighbours> found;
    std::vector<std::array<uint32_t, 2>> order;
    for (uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle)
    {
        if (presence[triangle] == Presence::absent || !(areaOf(scene, triangle) > 0.0f)) continue;
        for (int i = 0; i < 3; ++i)
        {
            const uint32_t a = welded[scene.triangles[triangle][i]], b = welded[scene.triangles[triangle][(i + 1) % 3]];
            if (a == b) continue;
            const std::array<uint32_t, 2> key = {std::min(a, b), std::max(a, b)};
            const auto [entry, isNew] = found.try_emplace(key);
            if (isNew) order.push_back(key);
            if (entry->second.count < 2) entry->second.triangles[entry->second.count] = triangle;
            ++entry->second.count;
        }
    }
    std::vector<SceneEdge> edges;
    for (const auto& key : order)
    {
        SceneEdge edge = makeEdge(scene, scene.positions[key[0]], scene.positions[key[1]], found.at(key));
        if (edge.alone || edge.sharp || edge.normals[0] != edge.normals[1]) edges.push_back(edge);
    }
    return edges;
}

std::vector<EdgePiece> edgesSeenFrom(std::span<const SceneEdge> edges, vec3 eye)
{
    std::vector<EdgePiece> seen;
    for (const SceneEdge& edge : edges)
        if (edge.sharp || edge.isSilhouette(eye - edge.ends[0])) seen.push_back({edge.ends[0], edge.ends[1]});
    return seen;
}

std::vector<EdgePiece> shadowEdges(const RayScene& rays, std::span<const SceneEdge> edges, const Light& light,
                                   const std::function<bool(vec3, vec3)>& fine)
{
    std::vector<EdgePiece> pieces;
    const From from{light};
    for (const SceneEdge& edge : edges)
        if (edge.isSilhouette(from.toward(edge.ends[0]))) Border(rays, edge, light, fine, pieces).walk();
    return pieces;
}

} // namespace sconce
