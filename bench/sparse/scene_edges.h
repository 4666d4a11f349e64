#pragma once

#include <functional>
#include <vector>

#include "bench/reference/ray_scene.h"
#include "scene/scene.h"

namespace sconce
{

/// An edge of triangles: where it may hide something behind it, or where two surfaces meet.
struct SceneEdge
{
    vec3 ends[2];       // metres
    vec3 normals[2];    // of its two triangles, by winding; the same of one that has only one
    vec3 away{0.0f};    // unit, at right angles to it, off its triangles: whoever goes there has passed it
    bool alone = false; // it has one triangle, or more than two: a border
    bool sharp = false; // what is seen changes over it, wherever one stands: another material, or normals over kSharp apart

    bool isSilhouette(vec3 toward) const { return alone || glm::dot(normals[0], toward) * glm::dot(normals[1], toward) < 0.0f; }
};
inline constexpr float kSharp = 30.0f; // degrees between normals

/// All edges that can be either, each once; vertices at the same place are one. In the order of the triangles.
std::vector<SceneEdge> edgesOf(const Scene& scene);

/// A straight piece of a line, metres.
struct EdgePiece
{
    vec3 a, b;
};

/// Pieces of edges that an eye sees with two surfaces, one on each side: silhouettes and sharp edges, hidden or not.
std::vector<EdgePiece> edgesSeenFrom(std::span<const SceneEdge> edges, vec3 eye);

/// Borders of the hard shadows of lights without extent, where they fall: silhouettes as the light sees them, moved along its rays to what
/// they meet. The event surface of an edge and a point light is a plane, and it is walked, rather than intersected with all triangles as
/// by Bala, Walter, Greenberg 2003, "Combining Edges and Points for Interactive High-Quality Rendering", section 4.
/// @param fine  whether two places are so near to each other that a straight line may join them (a pixel of the picture)
std::vector<EdgePiece> shadowEdges(const RayScene& rays, std::span<const SceneEdge> edges, const Light& light,
                                   const std::function<bool(vec3, vec3)>& fine);

} // namespace sconce
