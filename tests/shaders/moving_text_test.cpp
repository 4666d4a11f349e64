// Shapes that move: what they hide, against sums over directions; where rays meet them, against walks along the ray.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<double>;
using glm::dvec3;

dvec3 unit(Random& random)
{
    const double z = 2.0 * random.uniform() - 1.0, turn = 2.0 * std::numbers::pi * random.uniform(), r = std::sqrt(1.0 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

dvec3 within(Random& random, double side)
{
    return side * (2.0 * dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
}

/// Whether a point is within a capsule, by many points of its axis.
bool inCapsule(dvec3 at, double radius, double halfLength)
{
    double nearest = 1e30;
    for (int i = 0; i <= 2000; ++i) nearest = std::min(nearest, glm::length(at - dvec3(0.0, halfLength * (i / 1000.0 - 1.0), 0.0)));
    return nearest < radius;
}

bool inBox(dvec3 at, dvec3 half)
{
    return std::abs(at.x) < half.x && std::abs(at.y) < half.y && std::abs(at.z) < half.z;
}

/// Share of cosine-weighted directions, in n x n cells, whose ray meets something.
template <class Meets> double hiddenShare(dvec3 normal, int n, Meets meets)
{
    const Text::TangentFrame frame = Text::tangentFrame(normal);
    int met = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
        {
            const double u = (i + 0.5) / n, turn = 2.0 * std::numbers::pi * (j + 0.5) / n, r = std::sqrt(u);
            met += meets(Text::toWorld(frame, dvec3(r * std::cos(turn), r * std::sin(turn), std::sqrt(1.0 - u))));
        }
    return double(met) / (double(n) * n);
}

// A sphere whole above the horizon hides sin^2 of its half angle times the cosine.
TEST(MovingText, ASphereHidesItsFormFactor)
{
    EXPECT_NEAR(Text::shareOfSphere({0, 0, 2}, 1.0, {0, 0, 1}), 0.25, 1e-12);
    EXPECT_NEAR(Text::shareOfSphere({0, 3, 4}, 1.0, {0, 0, 1}), 0.8 / 25.0, 1e-12);
    EXPECT_EQ(Text::shareOfSphere({0, 0, -2}, 1.0, {0, 0, 1}), 0.0);
    EXPECT_EQ(Text::shareOfSphere({0, 0, 0.5}, 1.0, {0, 0, 1}), 1.0) << "within it";
}

TEST(MovingText, WhatASphereHidesIsTheSumOverDirectionsWhereTheHorizonCutsIt)
{
    Random random(3, 0);
    double worst = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        const double radius = 0.1 + 0.8 * random.uniform();
        const dvec3 to = (1.05 + 2.0 * random.uniform()) * radius * unit(random), normal = unit(random);
        const double truth = hiddenShare(normal, 400, [&](dvec3 way) { return Text::rayToRound(-to, way, radius, 0.0) > 0.0; });
        worst = std::max(worst, std::abs(Text::shareOfSphere(to, radius, normal) - truth));
        EXPECT_NEAR(double(Pure<float>::shareOfSphere(to, float(radius), normal)), Text::shareOfSphere(to, radius, normal), 1e-5) << i;
    }
    EXPECT_LT(worst, 0.003) << "the sum's own error";
}

TEST(MovingText, WhatABoxHidesIsTheSumOverDirections)
{
    Random random(4, 0);
    double worst = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        const dvec3 half = 0.1 + dvec3(random.uniform(), random.uniform(), random.uniform());
        dvec3 at = within(random, 3.0);
        while (Text::distanceToBox(at, half).away < 0.01) at = within(random, 3.0);
        const dvec3 normal = unit(random);
        const double truth = hiddenShare(normal, 400, [&](dvec3 way) { return Text::rayToBox(at, way, half) > 0.0; });
        worst = std::max(worst, std::abs(Text::shareOfBox(at, half, normal) - truth));
    }
    EXPECT_LT(worst, 0.003) << "the sum's own error";
}

TEST(MovingText, WhatACapsuleHidesIsNearTheSumOverDirections)
{
    Random random(5, 0);
    double worst = 0.0, sum = 0.0;
    constexpr int kCount = 100;
    for (int i = 0; i < kCount; ++i)
    {
        const double radius = 0.1 + 0.4 * random.uniform(), halfLength = 1.5 * random.uniform();
        dvec3 at = within(random, 3.0);
        while (Text::distanceToRound(at, radius, halfLength).away < 0.05) at = within(random, 3.0);
        const dvec3 normal = unit(random);
        const double truth = hiddenShare(normal, 300, [&](dvec3 way) { return Text::rayToRound(at, way, radius, halfLength) > 0.0; });
        const double off = std::abs(Text::shareOfRound(at, radius, halfLength, normal) - truth);
        worst = std::max(worst, off);
        sum += off;
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 0.04);
    EXPECT_LT(sum / kCount, 0.005);
}

// Up to the hit the ray is outside, just behind it inside; a ray that meets nothing is outside all along.
TEST(MovingText, RaysMeetShapesWhereAWalkDoes)
{
    Random random(6, 0);
    int met = 0;
    for (int i = 0; i < 400; ++i)
    {
        const bool box = i % 2 == 0;
        const dvec3 half(0.2 + random.uniform(), 0.2 + random.uniform(), 0.2 + random.uniform());
        const double halfLength = i % 4 == 1 ? 0.0 : half.y;
        const auto inside = [&](dvec3 at) { return box ? inBox(at, half) : inCapsule(at, half.x, halfLength); };
        dvec3 origin = within(random, 4.0);
        while (inside(origin)) origin = within(random, 4.0);
        const dvec3 way = glm::normalize(within(random, 1.2) - origin);
        const double t = box ? Text::rayToBox(origin, way, half) : Text::rayToRound(origin, way, half.x, halfLength);
        const double last = t > 0.0 ? t - 1e-4 : 12.0;
        for (int step = 0; step < 40; ++step) EXPECT_FALSE(inside(origin + way * (last * (step + 0.5) / 40))) << i;
        if (!(t > 0.0)) continue;
        ++met;
        EXPECT_FALSE(inside(origin + last * way)) << i;
        // A ray that grazes is inside only for a moment.
        const auto distance =
            box ? Text::distanceToBox(origin + t * way, half) : Text::distanceToRound(origin + t * way, half.x, halfLength);
        EXPECT_NEAR(distance.away, 0.0, 1e-9) << i;
        EXPECT_LT(glm::dot(distance.outward, way), 1e-3) << i;
        const float single =
            box ? Pure<float>::rayToBox(origin, way, half) : Pure<float>::rayToRound(origin, way, float(half.x), float(halfLength));
        EXPECT_NEAR(double(single), t, 2e-3) << i; // of a grazing ray
    }
    EXPECT_GT(met, 150);
}

TEST(MovingText, ADistanceIsToTheNearestPoint)
{
    EXPECT_NEAR(Text::distanceToBox({2, 0, 0}, {1, 1, 1}).away, 1.0, 1e-12);
    EXPECT_NEAR(Text::distanceToBox({2, 2, 0}, {1, 1, 1}).away, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(Text::distanceToBox({0.9, 0, 0}, {1, 1, 1}).away, -0.1, 1e-12);
    EXPECT_EQ(Text::distanceToBox({-0.9, 0, 0}, {1, 1, 1}).outward, dvec3(-1, 0, 0));
    EXPECT_NEAR(Text::distanceToRound({0, 3, 0}, 0.5, 1.0).away, 1.5, 1e-12);
    EXPECT_NEAR(Text::distanceToRound({2, 0.7, 0}, 0.5, 1.0).away, 1.5, 1e-12);
    EXPECT_EQ(Text::distanceToRound({2, 0.7, 0}, 0.5, 1.0).outward, dvec3(1, 0, 0));
}

} // namespace
} // namespace sconce
