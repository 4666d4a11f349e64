#include "bench/sparse/edge_image.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sconce
{
namespace
{

constexpr float kStraight = 0.25f; // pixels that what is in a simple pixel may be off its line
constexpr float kHiddenBy = 1e-3f; // of the distance: what is nearer by more hides an edge

/// The shares of a piece's way at which it enters another pixel, and its ends.
std::vector<float> crossings(vec2 a, vec2 b)
{
    std::vector<float> shares = {0.0f, 1.0f};
    for (int axis = 0; axis < 2; ++axis)
    {
        const float low = std::min(a[axis], b[axis]), high = std::max(a[axis], b[axis]);
        for (float at = std::floor(low) + 1.0f; at < high; at += 1.0f) shares.push_back((at - a[axis]) / (b[axis] - a[axis]));
    }
    std::ranges::sort(shares);
    return shares;
}

/// A part of an edge within one pixel, from the pixel's centre.
struct Part
{
    uint32_t pixel;
    vec2 a, b;
};

std::vector<Part> partsOf(std::span<const std::array<vec2, 2>> pieces, uint32_t columns, uint32_t rows)
{
    std::vector<Part> parts;
    for (const auto& [a, b] : pieces)
    {
        const std::vector<float> shares = crossings(a, b);
        for (size_t i = 1; i < shares.size(); ++i)
        {
            const vec2 from = glm::mix(a, b, shares[i - 1]), to = glm::mix(a, b, shares[i]), pixel = glm::floor(0.5f * (from + to));
            if (pixel.x < 0.0f || pixel.y < 0.0f || pixel.x >= float(columns) || pixel.y >= float(rows)) continue;
            const vec2 centre = pixel + 0.5f;
            parts.push_back({uint32_t(pixel.y) * columns + uint32_t(pixel.x), from - centre, to - centre});
        }
    }
    std::ranges::stable_sort(parts, {}, &Part::pixel);
    return parts;
}

/// The line through the two ends that are farthest from each other; whether all others are near to it.
bool fitLine(std::span<const Part> parts, EdgeImage::Line& line)
{
    std::vector<vec2> ends;
    for (const Part& part : parts) ends.push_back(part.a), ends.push_back(part.b);
    vec2 first = ends[0], last = ends[1];
    for (const vec2 a : ends)
        for (const vec2 b : ends)
            if (glm::distance(a, b) > glm::distance(first, last)) first = a, last = b;
    const vec2 along = last - first;
    line.normal = glm::length(along) > 0.0f ? glm::normalize(vec2(-along.y, along.x)) : vec2(1.0f, 0.0f);
    line.offset = glm::dot(line.normal, first);
    return std::ranges::all_of(ends, [&](vec2 end) { return std::abs(glm::dot(line.normal, end) - line.offset) <= kStraight; });
}

} // namespace

EdgeImage::EdgeImage(uint32_t width, uint32_t height, std::span<const std::array<vec2, 2>> pieces)
    : columns(width), rows(height), kinds(size_t(width) * height, Kind::empty), lines(kinds.size())
{
    const std::vector<Part> parts = partsOf(pieces, columns, rows);
    for (size_t first = 0, last = 0; first < parts.size(); first = last)
    {
        while (last < parts.size() && parts[last].pixel == parts[first].pixel) ++last;
        const std::span<const Part> of(&parts[first], last - first);
        kinds[parts[first].pixel] = fitLine(of, lines[parts[first].pixel]) ? Kind::simple : Kind::complex;
    }
}

EdgeImage::Counts EdgeImage::counts() const
{
    const auto of = [&](Kind kind) { return size_t(std::ranges::count(kinds, kind)); };
    return {of(Kind::empty), of(Kind::simple), of(Kind::complex)};
}

bool EdgeImage::joined(uint32_t x, uint32_t y, int dx, int dy) const
{
    const uint32_t otherX = uint32_t(int(x) + dx), otherY = uint32_t(int(y) + dy);
    const Kind own = kind(x, y), other = kind(otherX, otherY);
    if (own == Kind::complex || other == Kind::complex) return false;
    const vec2 half = 0.5f * vec2(dx, dy);
    const auto passes = [](const Line& of, vec2 to) { return (of.offset > 0.0f) != (of.offset > glm::dot(of.normal, to)); };
    return !(own == Kind::simple && passes(line(x, y), half)) && !(other == Kind::simple && passes(line(otherX, otherY), -half));
}

float EdgeImage::shareOfCentre(uint32_t x, uint32_t y) const
{
    const Line of = line(x, y);
    // The pixel cut by the line: Sutherland and Hodgman 1974; the part that holds the centre.
    const float side = of.offset > 0.0f ? -1.0f : 1.0f;
    const vec2 corners[4] = {{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}};
    std::vector<vec2> kept;
    for (int i = 0; i < 4; ++i)
    {
        const vec2 a = corners[i], b = corners[(i + 1) % 4];
        const float heightA = side * (glm::dot(of.normal, a) - of.offset), heightB = side * (glm::dot(of.normal, b) - of.offset);
        if (heightA >= 0.0f) kept.push_back(a);
        if ((heightA >= 0.0f) != (heightB >= 0.0f)) kept.push_back(glm::mix(a, b, heightA / (heightA - heightB)));
    }
    float twice = 0.0f;
    for (size_t i = 0; i < kept.size(); ++i)
    {
        const vec2 a = kept[i], b = kept[(i + 1) % kept.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::clamp(0.5f * std::abs(twice), 0.5f, 1.0f);
}

std::vector<std::array<vec2, 2>> seenPieces(std::span<const EdgePiece> pieces, const RayScene& rays, const Camera& camera, uint32_t width,
                                            uint32_t height)
{
    const Pinhole pinhole(camera, width, height);
    const vec2 size(width, height);
    const float nearest = 8.0f * rays.offset(); // of the view's plane, metres
    const auto depthOf = [&](vec3 point) { return glm::dot(point - pinhole.eye, pinhole.forward); };
    const auto pixelOf = [&](vec3 point)
    {
        const vec3 way = (point - pinhole.eye) / depthOf(point);
        const vec2 at(glm::dot(way, pinhole.right) / glm::dot(pinhole.right, pinhole.right),
                      -glm::dot(way, pinhole.up) / glm::dot(pinhole.up, pinhole.up));
        return 0.5f * (at + 1.0f) * size;
    };
    std::vector<std::array<vec2, 2>> seen;
    for (EdgePiece piece : pieces)
    {
        float depthA = depthOf(piece.a), depthB = depthOf(piece.b);
        if (depthA <= nearest && depthB <= nearest) continue;
        if (depthA <= nearest) piece.a = glm::mix(piece.a, piece.b, (nearest - depthA) / (depthB - depthA)), depthA = nearest;
        if (depthB <= nearest) piece.b = glm::mix(piece.b, piece.a, (nearest - depthB) / (depthA - depthB)), depthB = nearest;
        const vec2 a = pixelOf(piece.a), b = pixelOf(piece.b);
        if (glm::any(glm::lessThan(glm::max(a, b), vec2(0.0f))) || glm::any(glm::greaterThan(glm::min(a, b), size))) continue;
        // Cut to the picture first: a piece that passes the eye is long.
        float first = 0.0f, last = 1.0f;
        for (int axis = 0; axis < 2; ++axis)
        {
            const float from = a[axis], to = b[axis];
            if (from == to) continue;
            const float low = -from / (to - from), high = (size[axis] - from) / (to - from);
            first = std::max(first, std::min(low, high)), last = std::min(last, std::max(low, high));
        }
        if (!(first < last)) continue;
        const int parts = std::max(1, int(std::ceil(glm::distance(a, b) * (last - first))));
        for (int i = 0; i < parts; ++i)
        {
            const vec2 from = glm::mix(a, b, glm::mix(first, last, float(i) / float(parts))),
                       to = glm::mix(a, b, glm::mix(first, last, float(i + 1) / float(parts)));
            // The same place in space: shares of a picture's line aren't those of the line.
            const float share = glm::mix(first, last, (float(i) + 0.5f) / float(parts));
            const float there = share * depthA / (share * depthA + (1.0f - share) * depthB);
            const vec3 way = glm::mix(piece.a, piece.b, there) - pinhole.eye;
            const float length = glm::length(way);
            if (!rays.occluded(pinhole.eye, way / length, length * (1.0f - kHiddenBy))) seen.push_back({from, to});
        }
    }
    return seen;
}

} // namespace sconce
