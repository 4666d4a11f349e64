#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sconce
{

/// The leaf-only sparse voxel octree: which up to four ranked probes a point asks. It lies in a 3D texture of 2x2x2-texel bricks; every
/// texel is either a leaf (probe indices, best first; missing ones repeat an earlier one) or, when its w equals the marker, points to the
/// brick of its eight children (brick = x + y B + z B^2, B = marker + 1); equal bricks are stored once. The first bricks are the top grid,
/// addressed by arithmetic.
/// Leaf-only payload: Wang et al. 2019, "Fast Non-uniform Radiance Probe Placement and Tracing", section 4.1; the layout is our own.
struct Octree
{
    glm::vec3 boundsLow{0.0f}; // field space
    glm::vec3 boundsHigh{0.0f};
    float voxel = 0.0f; // field units per finest voxel
    glm::ivec3 topCells{0};
    int topShift = 0;             // a top cell covers 2^topShift finest voxels a side
    glm::uvec3 bricks{0};         // bricks along each axis of the texture; the texture has 2x that many texels
    uint32_t marker = 255;        // 255: channels are 8 bit; 65535: 16 bit
    std::vector<uint16_t> texels; // [z][y][x][4]
    uint32_t leaves = 0;          // of the tree, before equal bricks are shared
    uint32_t nodes = 0;           // interior ones, the same

    glm::uvec3 textureSize() const { return 2u * bricks; }
    size_t bytes() const { return texels.size() / 4 * (marker == 255 ? 4 : 8); }
};

} // namespace sconce
