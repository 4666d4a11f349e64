#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace sconce
{

/// For every vertex the first vertex with the same position, bit by bit but -0 and 0 alike: meshes repeat positions for their normals.
std::vector<uint32_t> weld(const std::vector<vec3>& positions);

/// For each of some triangles the place in the list of the first that it hangs together with, by corners that these triangles share. Cost:
/// a sort of their corners.
std::vector<uint32_t> joinedParts(const Scene& scene, std::span<const uint32_t> triangles);

/// Which side of a triangle can be seen from outside.
enum class Outside : int8_t
{
    both = 0,  // of a sheet, or of a part that is not closed
    front = 1, // the side from which its corners run counter-clockwise
    back = -1,
};

/// For each of some triangles: `front` or `back` where it belongs to a closed part, triangles joined by corners each of whose edges is run
/// along as often one way as the other, in which there is nothing; else `both`: a room is seen from its inside, and so may be all that
/// there is. Cost: a sort of all edges, and a look at each vertex for each closed part asked about.
std::vector<Outside> outsideOf(const Scene& scene, std::span<const uint32_t> triangles);

} // namespace sconce
