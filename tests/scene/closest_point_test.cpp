#include "scene/closest_point.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

std::string text(vec3 v)
{
    return std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + "; ";
}

using glm::dvec3;

dvec3 onSegment(dvec3 p, dvec3 from, dvec3 to)
{
    const dvec3 edge = to - from;
    const double length2 = glm::dot(edge, edge);
    return from + (length2 > 0.0 ? std::clamp(glm::dot(p - from, edge) / length2, 0.0, 1.0) : 0.0) * edge;
}

/// Another way, in double: the foot of the perpendicular where it lies inside, by the signs of three areas, else the nearest of the edges.
double distanceTo(dvec3 p, dvec3 a, dvec3 b, dvec3 c)
{
    double nearest =
        std::min({glm::distance(p, onSegment(p, a, b)), glm::distance(p, onSegment(p, b, c)), glm::distance(p, onSegment(p, c, a))});
    const dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, normal) == 0.0) return nearest;
    const dvec3 foot = p - normal * (glm::dot(p - a, normal) / glm::dot(normal, normal));
    if (glm::dot(glm::cross(b - a, foot - a), normal) >= 0.0 && glm::dot(glm::cross(c - b, foot - b), normal) >= 0.0 &&
        glm::dot(glm::cross(a - c, foot - c), normal) >= 0.0)
        nearest = std::min(nearest, glm::distance(p, foot));
    return nearest;
}

/// The point must lie on the triangle and be as near as the triangle is. @param error  metres
void expectNearest(vec3 p, vec3 a, vec3 b, vec3 c, double error)
{
    const vec3 found = closestPointOnTriangle(p, a, b, c);
    const auto input = [&] { return text(p) + text(a) + text(b) + text(c); };
    EXPECT_LE(distanceTo(found, a, b, c), error) << "off the triangle: " << input();
    EXPECT_NEAR(glm::distance(dvec3(found), dvec3(p)), distanceTo(p, a, b, c), error) << input();
}

class Points
{
public:
    vec3 within(float reach) { return reach * vec3(number(random), number(random), number(random)); }

private:
    std::mt19937 random{3};
    std::uniform_real_distribution<float> number{-1.0f, 1.0f};
};

TEST(ClosestPoint, IsAsNearAsTheTriangleInEveryRegion)
{
    Points points;
    for (int i = 0; i < 100000; ++i)
    {
        const vec3 a = points.within(1.0f), b = points.within(1.0f), c = points.within(1.0f);
        expectNearest(points.within(i % 2 ? 3.0f : 1.0f), a, b, c, 1e-5); // random triangles include needles
    }
}

// The unit right triangle's regions by hand: three corners, three edges, the inside from both sides.
TEST(ClosestPoint, OfARightTriangleIsItsClosedForm)
{
    const vec3 a(0.0f), b(1, 0, 0), c(0, 1, 0);
    const struct
    {
        vec3 p, nearest;
    } cases[] = {{{-1, -2, 3}, a},
                 {{3, -1, 1}, b},
                 {{-1, 3, -1}, c},
                 {{0.25f, -1, 2}, {0.25f, 0, 0}},
                 {{-1, 0.75f, 2}, {0, 0.75f, 0}},
                 {{1, 1, 0}, {0.5f, 0.5f, 0}},
                 {{0.25f, 0.5f, 7}, {0.25f, 0.5f, 0}},
                 {{0.25f, 0.5f, -7}, {0.25f, 0.5f, 0}},
                 {{0.25f, 0.25f, 0}, {0.25f, 0.25f, 0}}};
    for (const auto& one : cases)
        for (const auto& [x, y, z] : {std::array{a, b, c}, {b, c, a}, {c, b, a}})
            EXPECT_LT(glm::distance(closestPointOnTriangle(one.p, x, y, z), one.nearest), 1e-6f) << text(one.p);
}

// Triangles that are a segment or a point, which imported scenes have.
TEST(ClosestPoint, OfADegenerateTriangleIsOnItsEdges)
{
    Points points;
    for (int i = 0; i < 10000; ++i)
    {
        const vec3 a = points.within(1.0f), b = points.within(1.0f), p = points.within(2.0f);
        expectNearest(p, a, a, a, 1e-6);
        expectNearest(p, a, a, b, 1e-6);
        expectNearest(p, a, b, a, 1e-6);
        expectNearest(p, b, a, a, 1e-6);
        expectNearest(p, a, b, a + 0.25f * (b - a), 1e-5);
        expectNearest(p, a, b, a + 4.0f * (b - a), 1e-5);
    }
}

// A needle whose corners are nearly on a line: areas cancel, the answer must not leave the triangle.
TEST(ClosestPoint, StaysOnANeedle)
{
    Points points;
    for (float width : {1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f})
        for (int i = 0; i < 10000; ++i)
        {
            const vec3 a = points.within(1.0f), b = points.within(1.0f), c = a + 0.5f * (b - a) + width * points.within(1.0f);
            expectNearest(points.within(2.0f), a, b, c, 1e-5);
        }
}

} // namespace
} // namespace sconce
