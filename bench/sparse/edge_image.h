#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bench/sparse/scene_edges.h"
#include "scene/view_rays.h"

namespace sconce
{

/// Edges in a picture, at most one a pixel, with their place within it, as in the edge-and-point image of Bala, Walter, Greenberg 2003
/// ("Combining Edges and Points for Interactive High-Quality Rendering", section 5).
class EdgeImage
{
public:
    enum class Kind : uint8_t
    {
        empty,   // no edge
        simple,  // what edges it has are nearly one straight line
        complex, // more than a line can say
    };
    /// Through a pixel: where dot(normal, p) is `offset`, p from the pixel's centre.
    struct Line
    {
        vec2 normal{0.0f}; // unit
        float offset = 0.0f;
    };
    struct Counts
    {
        size_t empty = 0, simple = 0, complex = 0;
    };

    /// @param a, b  of each piece, pixels from the picture's top left corner; what lies outside is cut off
    EdgeImage(uint32_t width, uint32_t height, std::span<const std::array<vec2, 2>> pieces);

    uint32_t width() const { return columns; }
    uint32_t height() const { return rows; }
    Kind kind(uint32_t x, uint32_t y) const { return kinds[size_t(y) * columns + x]; }
    Line line(uint32_t x, uint32_t y) const { return lines[size_t(y) * columns + x]; } // of a simple one
    Counts counts() const;
    /// Whether one comes from a pixel's centre to that of its neighbour and passes no edge; never to or from a complex one.
    /// @param dx, dy  one of them 1 or -1, the other 0
    bool joined(uint32_t x, uint32_t y, int dx, int dy) const;
    /// Of a simple pixel, the share of its area that lies on its centre's side of the line, [0.5, 1].
    float shareOfCentre(uint32_t x, uint32_t y) const;

private:
    uint32_t columns, rows;
    std::vector<Kind> kinds;
    std::vector<Line> lines;
};

/// Pieces as a camera's picture has them: those parts that nothing hides, in parts of at most a pixel, each judged by its middle.
std::vector<std::array<vec2, 2>> seenPieces(std::span<const EdgePiece> pieces, const RayScene& rays, const Camera& camera, uint32_t width,
                                            uint32_t height);

} // namespace sconce
