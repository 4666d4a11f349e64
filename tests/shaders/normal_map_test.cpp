#include <gtest/gtest.h>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<double>;
using dvec3 = glm::dvec3;

const dvec3 kUp(0.0, 0.0, 1.0);

/// A texture value of a direction in tangent space.
dvec3 coded(dvec3 local)
{
    return 0.5 * glm::normalize(local) + 0.5;
}
void expectNear(dvec3 found, dvec3 expected, const char* what)
{
    EXPECT_LT(glm::length(found - glm::normalize(expected)), 1e-6) << what << ": " << found.x << ' ' << found.y << ' ' << found.z;
}

// A picture hung on a wall as it is seen: u to the right, v downwards, so that the texture's green points up.
const Text::UvTangents kHung = Text::uvTangents({2, 0, 0}, {0, 2, 0}, {1, 0}, {0, -1});

TEST(NormalMap, TheFlatTextureChangesNothing)
{
    expectNear(Text::bentNormal(kUp, kHung, {0.5, 0.5, 1.0}, 1.0), kUp, "flat");
}

TEST(NormalMap, RedPointsAlongUAndGreenAgainstV)
{
    expectNear(Text::bentNormal(kUp, kHung, coded({1, 0, 1}), 1.0), {1, 0, 1}, "red");
    expectNear(Text::bentNormal(kUp, kHung, coded({0, 1, 1}), 1.0), {0, 1, 1}, "green");
    expectNear(Text::bentNormal(kUp, kHung, coded({0, 1, 1}), 0.5), {0, 0.5, 1}, "half the strength");
}

TEST(NormalMap, MirroredTexturesBendTheOtherWay)
{
    const Text::UvTangents mirrored = Text::uvTangents({2, 0, 0}, {0, 2, 0}, {-1, 0}, {0, -1});
    expectNear(Text::bentNormal(kUp, mirrored, coded({1, 0, 1}), 1.0), {-1, 0, 1}, "red");
    expectNear(Text::bentNormal(kUp, mirrored, coded({0, 1, 1}), 1.0), {0, 1, 1}, "green");
}

// Which two changes of position the tangents come from doesn't matter: a triangle's edges or a pixel's neighbours.
TEST(NormalMap, TangentsDependOnTheSurfaceAlone)
{
    const auto uvOf = [](dvec3 p) { return glm::dvec2(0.3 * p.x - 0.4 * p.y, 0.7 * p.x + 0.2 * p.y); };
    const dvec3 read = coded({0.3, -0.5, 1}), normal = glm::normalize(dvec3(0.2, -0.1, 1));
    const dvec3 edges[] = {{1, 0, 0}, {0, 1, 0}, {-0.5, 0.2, 0}, {0.01, 0.03, 0}};
    const dvec3 expected = Text::bentNormal(normal, Text::uvTangents(edges[0], edges[1], uvOf(edges[0]), uvOf(edges[1])), read, 1.0);
    for (const dvec3& a : edges)
        for (const dvec3& b : edges)
            if (glm::length(glm::cross(a, b)) > 1e-9)
            {
                expectNear(Text::bentNormal(normal, Text::uvTangents(a, b, uvOf(a), uvOf(b)), read, 1.0), expected, "another pair");
            }
}

TEST(NormalMap, CoordinatesThatSpanNothingBendNothing)
{
    const Text::UvTangents none = Text::uvTangents({1, 0, 0}, {0, 1, 0}, {0, 0}, {0, 0});
    expectNear(Text::bentNormal(kUp, none, coded({1, 1, 1}), 1.0), kUp, "no coordinates");
}

TEST(NormalMap, NoTextureBendsANormalUnderItsSurface)
{
    EXPECT_GT(Text::bentNormal(kUp, kHung, {1.0, 0.5, 0.0}, 1.0).z, 0.0);
}

} // namespace
} // namespace sconce
