#pragma once

#include <vector>

#include "placement/visibility.h"
#include "scene/scene.h"

namespace sconce
{

/// Unsigned distance to the nearest surface at the cell centres of a dense box of cubes. Unsigned because real assets are not watertight.
/// Exact within kExactBand cells of a surface; farther out the distance to the nearest surface cell, at most one cell off.
struct DistanceField
{
    vec3 origin{0.0f};  // low corner of cell (0,0,0), metres
    float voxel = 0.0f; // side of a cell, metres
    glm::ivec3 size{0};
    std::vector<float> distance; // metres, [z][y][x]

    size_t cells() const { return distance.size(); }
    size_t index(glm::ivec3 cell) const { return size_t(cell.x) + size_t(size.x) * (size_t(cell.y) + size_t(size.y) * size_t(cell.z)); }
    glm::ivec3 cell(size_t at) const
    {
        const auto i = uint32_t(at), row = i / uint32_t(size.x); // of 32 bits, as all cells' numbers: several times as fast to divide
        return {int(i - row * uint32_t(size.x)), int(row % uint32_t(size.y)), int(row / uint32_t(size.y))};
    }
    bool inside(glm::ivec3 at) const { return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, size)); }
    glm::ivec3 cellAt(vec3 point) const { return glm::ivec3(glm::floor((point - origin) / voxel)); } // may lie outside
    vec3 centre(glm::ivec3 at) const { return origin + voxel * (vec3(at) + 0.5f); }
};

inline constexpr float kExactBand = 3.0f; // cells

/// @param box     what to cover, metres; triangles outside it (beyond the band) are ignored
/// @param voxels  most cells; the cell's side follows from it, but no axis gets more than 1,024 cells
DistanceField buildDistanceField(const Scene& scene, const std::vector<Presence>& presence, const Bounds& box, uint32_t voxels);

} // namespace sconce
