#include "runtime/frame/environment_brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "shaders/shared/frame.h"

namespace sconce
{
namespace
{

constexpr double kPi = std::numbers::pi;

/// Scale and bias by their definition, the integral of BRDF times cosine over the hemisphere of light, in double and from the formulas of
/// the papers: GGX (Walter et al. 2007, equation 33), height-correlated Smith (Heitz 2014, equation 99), Schlick 1994. The half vector is
/// integrated over, by tan(theta) = alpha sqrt(u / (1 - u)), whose density is D cos(theta): the lobe is flat in u however narrow it is.
glm::dvec2 reflected(double nv, double alpha)
{
    constexpr int kRings = 1000, kAround = 240;
    const glm::dvec3 view(std::sqrt(1.0 - nv * nv), 0.0, nv);
    const auto lambda = [&](double cosine) { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0); };
    glm::dvec2 sum(0.0);
    for (int ring = 0; ring < kRings; ++ring)
    {
        const double u = (ring + 0.5) / kRings, tangent = alpha * std::sqrt(u / (1.0 - u)), nh = 1.0 / std::sqrt(1.0 + tangent * tangent);
        for (int i = 0; i < kAround; ++i)
        {
            const double phi = 2.0 * kPi * (i + 0.5) / kAround;
            const glm::dvec3 half(tangent * nh * std::cos(phi), tangent * nh * std::sin(phi), nh);
            const double vh = glm::dot(view, half);
            const double nl = 2.0 * vh * nh - nv;
            if (vh <= 0.0 || nl <= 0.0) continue;
            // D G / (4 nl nv) nl dl, with dl = 4 vh dh and D nh dh uniform in u and phi
            const double weight = vh / (nv * nh) / (1.0 + lambda(nl) + lambda(nv)), schlick = std::pow(1.0 - vh, 5.0);
            sum += glm::dvec2(weight * (1.0 - schlick), weight * schlick);
        }
    }
    return sum / double(kRings * kAround);
}

class EnvironmentBrdf : public testing::Test
{
protected:
    static constexpr int kSide = int(gpu::kEnvironmentBrdfSide);
    static const std::vector<glm::vec2>& table()
    {
        static const std::vector<glm::vec2> made = environmentBrdf();
        return made;
    }
    static glm::vec2 at(int roughness, int cosine) { return table()[size_t(roughness * kSide + cosine)]; }
};

TEST_F(EnvironmentBrdf, AgreesWithQuadrature)
{
    ASSERT_EQ(table().size(), size_t(kSide) * kSide);
    for (const int row : {6, 9, 12, 16, 20, 24, 31})
        for (const int column : {2, 4, 8, 10, 16, 20, 31})
        {
            const double root = double(row) / (kSide - 1);
            const glm::dvec2 truth = reflected(double(column) / (kSide - 1), root * root), found = at(row, column);
            for (const double atNormal : {0.04, 1.0})
            {
                const double light = atNormal * truth.x + truth.y;
                EXPECT_NEAR(atNormal * found.x + found.y, light,
                            0.008 * std::max(light, 0.1)) // 512 samples an entry: 0.7 % off at a grazing angle
                    << "roughness " << root << ", column " << column;
            }
        }
}

// No surface reflects more than it gets, and none less than nothing.
TEST_F(EnvironmentBrdf, ReflectsAShare)
{
    for (const glm::vec2 entry : table())
    {
        EXPECT_TRUE(entry.x >= 0.0f && entry.y >= 0.0f && entry.x + entry.y <= 1.0f + 1e-5f) << entry.x << ' ' << entry.y;
    }
}

// The smoothest lobe is a mirror: scale and bias are Schlick's.
TEST_F(EnvironmentBrdf, SmoothestIsSchlick)
{
    for (int column = 4; column < kSide; ++column)
    {
        const double schlick = std::pow(1.0 - double(column) / (kSide - 1), 5.0);
        EXPECT_NEAR(at(0, column).x, 1.0 - schlick, 2e-3) << column;
        EXPECT_NEAR(at(0, column).y, schlick, 2e-3) << column;
    }
}

} // namespace
} // namespace sconce
