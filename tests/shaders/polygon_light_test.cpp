// Light of polygons in closed form, against quadratures over their area in double and published form factors.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<double>;
using Corners = std::array<glm::dvec3, 4>;

/// A square of a given angular size (its side over its distance) whose middle is seen in a direction, turned at random.
Corners squareAt(glm::dvec3 direction, double angle, Random& random)
{
    const glm::dvec3 axis = glm::normalize(glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
    const glm::dvec3 tilted = glm::normalize(direction + 0.7 * axis);
    const glm::dvec3 x = glm::normalize(glm::cross(tilted, glm::dvec3(0.3, 0.9, 0.2))), y = glm::cross(tilted, x);
    const double distance = 3.0, half = 0.5 * angle * distance;
    const glm::dvec3 middle = distance * direction;
    return {middle - half * x - half * y, middle + half * x - half * y, middle + half * x + half * y, middle - half * x + half * y};
}

/// Integral over the polygon's solid angle: midpoints of n x n cells of the parallelogram.
template <class F> auto overSquare(const Corners& corners, int n, F f) -> decltype(f(glm::dvec3()))
{
    const glm::dvec3 x = corners[1] - corners[0], y = corners[3] - corners[0], normal = glm::cross(x, y);
    auto sum = 0.0 * f(glm::dvec3(0.0, 0.0, 1.0));
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
        {
            const glm::dvec3 to = corners[0] + x * ((i + 0.5) / n) + y * ((j + 0.5) / n);
            const double d2 = glm::dot(to, to), solidAngle = std::abs(glm::dot(normal, to)) / (n * n * d2 * std::sqrt(d2));
            sum += solidAngle * f(to / std::sqrt(d2));
        }
    return sum;
}

// A unit square over the corner of another surface element: Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4.
TEST(PolygonLight, IrradianceIsThePublishedFormFactor)
{
    const double x = 1.0, y = 1.0; // sides over distance
    const double factor = (x / std::sqrt(1.0 + x * x) * std::atan(y / std::sqrt(1.0 + x * x)) +
                           y / std::sqrt(1.0 + y * y) * std::atan(x / std::sqrt(1.0 + y * y))) /
                          (2.0 * std::numbers::pi);
    const double found = Text::polygonIrradiance({0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2});
    EXPECT_NEAR(found / std::numbers::pi, factor, 1e-12);
    EXPECT_NEAR(double(Pure<float>::polygonIrradiance({0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2})), found, 1e-6);
}

TEST(PolygonLight, IrradianceIsTheQuadratureWhereTheHorizonCutsIt)
{
    Random random(5, 0);
    for (int i = 0; i < 200; ++i)
    {
        const double z = 0.8 * random.uniform() - 0.3, turn = 6.0 * random.uniform(), r = std::sqrt(1.0 - z * z);
        const Corners c = squareAt({r * std::cos(turn), r * std::sin(turn), z}, 0.05 + random.uniform(), random);
        const double truth = overSquare(c, 400, [](glm::dvec3 to) { return std::max(to.z, 0.0); });
        EXPECT_NEAR(Text::polygonIrradiance(c[0], c[1], c[2], c[3]), truth, 2e-4) << i;
        EXPECT_NEAR(Text::polygonIrradiance(c[3], c[2], c[1], c[0]), truth, 2e-4) << "from its other side";
    }
}

TEST(PolygonLight, TrianglesAreCornersThatComeTwice)
{
    const glm::dvec3 a(0.1, 0.2, 1.0), b(0.9, -0.1, 1.2), c(0.3, 0.8, 0.9);
    const double whole = Text::polygonIrradiance(a, b, c, c);
    const glm::dvec3 half = 0.5 * (b + c);
    EXPECT_NEAR(whole, Text::polygonIrradiance(a, b, half, half) + Text::polygonIrradiance(a, half, c, c), 1e-12);
}

// The error is that of all viewers together.
TEST(PolygonLight, ReflectionIsTheQuadratureOfTheLobe)
{
    Random random(7, 0);
    for (const double roughness : {0.1, 0.2, 0.3, 0.5, 0.7, 1.0})
        for (const double angle : {0.02, 0.1, 0.3})
        {
            const Text::BrdfSurface surface{Text::vec3(0.7), 0.5, roughness};
            const double alpha = Text::ggxAlpha(roughness);
            double off = 0.0, all = 0.0, sum = 0.0;
            for (int i = 0; i < 60; ++i)
            {
                const double nv = 0.08 + 0.92 * random.uniform();
                const glm::dvec3 view(std::sqrt(1.0 - nv * nv), 0.0, nv);
                // Within what the lobe reflects to the viewer: others get next to nothing.
                const glm::dvec3 half = Text::sampleVisibleNormal(view, alpha, glm::dvec2(random.uniform(), random.uniform()));
                const glm::dvec3 direction = 2.0 * glm::dot(view, half) * half - view;
                if (direction.z < 0.5 * angle) continue;
                const Corners c = squareAt(direction, angle, random);
                const Text::BrdfLobes lobes = Text::lobesAt(surface, nv);
                const double truth =
                    overSquare(c, 300,
                               [&](glm::dvec3 to) {
                                   return Text::evaluateLobes(lobes, roughness, {0, 0, 1}, view, to).specular.g * std::max(to.z, 0.0);
                               });
                const double found = Text::polygonReflected(lobes, alpha, view, c[0], c[1], c[2], c[3]).g;
                off += std::abs(found - truth);
                sum += found;
                all += truth;
            }
            const std::string named = "roughness " + std::to_string(roughness) + ", angle " + std::to_string(angle);
            // Half vectors of a wide lamp have bent edges, and the rest of the lobe is no longer the same all over it.
            EXPECT_LT(off / all, angle < 0.05 ? 0.01 : angle < 0.2 ? 0.04 : 0.1) << named;
            EXPECT_NEAR(sum / all, 1.0, angle < 0.05 ? 0.003 : angle < 0.2 ? 0.02 : 0.08) << named;
            RecordProperty("error and mean, " + named, std::to_string(off / all) + " " + std::to_string(sum / all));
        }
}

} // namespace
} // namespace sconce
