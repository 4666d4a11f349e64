#include "bench/sparse/scene_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

Scene boxScene()
{
    Scene scene;
    scene.materials = {Material{}};
    test::addBox(scene, vec3(0.0f), 1.0f, 0);
    return scene;
}

/// A horizontal square of side 2 * half about (0, height, 0), seen from both sides.
void addPlate(Scene& scene, float half, float height)
{
    test::addQuad(scene, {0.0f, height, 0.0f}, {half, 0.0f, 0.0f}, {0.0f, 0.0f, -half}, 0);
}

Scene plateOverGround()
{
    Scene scene;
    scene.materials = {Material{}};
    addPlate(scene, 10.0f, 0.0f);
    addPlate(scene, 0.5f, 1.0f);
    return scene;
}

bool withinAMillimetre(vec3 a, vec3 b)
{
    return glm::distance(a, b) <= 1e-3f;
}

size_t silhouettes(const std::vector<SceneEdge>& edges, vec3 eye)
{
    return size_t(std::ranges::count_if(edges, [&](const SceneEdge& edge) { return edge.isSilhouette(eye - edge.ends[0]); }));
}

TEST(SceneEdges, ABoxHasTwelveSharpOnesAndSixOrFourOfItsOutline)
{
    const std::vector<SceneEdge> edges = edgesOf(boxScene());
    ASSERT_EQ(edges.size(), 12u); // none across its faces
    for (const SceneEdge& edge : edges)
    {
        EXPECT_TRUE(edge.sharp);
        EXPECT_FALSE(edge.alone);
        EXPECT_NEAR(glm::length(edge.away), 1.0f, 1e-5f);
    }
    EXPECT_EQ(silhouettes(edges, {3.0f, 4.0f, 5.0f}), 6u); // towards a corner
    EXPECT_EQ(silhouettes(edges, {0.1f, 0.2f, 5.0f}), 4u); // before one face
}

TEST(SceneEdges, ASphereShowsItsOutlineAlone)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addSphere(scene, 1.0f, 32, 0);
    std::vector<SceneEdge> edges = edgesOf(scene);
    std::erase_if(edges,
                  [](const SceneEdge& edge) { return edge.ends[0].y < -0.99f || edge.ends[1].y < -0.99f; }); // sin(pi) isn't 0: no pole
    EXPECT_TRUE(std::ranges::none_of(edges, [](const SceneEdge& edge) { return edge.sharp || edge.alone; }));
    const vec3 eye(0.3f, 0.2f, 4.0f);
    for (const EdgePiece& piece : edgesSeenFrom(edges, eye))
    {
        // Where the view grazes the sphere: dot(p, eye) = 1, but for a facet.
        EXPECT_NEAR(glm::dot(0.5f * (piece.a + piece.b), eye), 1.0f, 0.8f);
    }
    EXPECT_GE(edgesSeenFrom(edges, eye).size(), 32u);
}

TEST(SceneEdges, WhatIsAtOnePlaceIsOneEdgeAndBordersAreOutlinesFromEverywhere)
{
    const std::vector<SceneEdge> edges = edgesOf(plateOverGround());
    EXPECT_EQ(edges.size(), 8u); // the diagonals divide nothing
    EXPECT_TRUE(std::ranges::all_of(edges, [](const SceneEdge& edge) { return edge.alone; }));
    EXPECT_EQ(silhouettes(edges, {0.0f, 5.0f, 0.0f}), 8u);
}

TEST(SceneEdges, ABorderOfMaterialsInOnePlaneIsSharp)
{
    Scene scene = plateOverGround();
    scene.materials.push_back(scene.materials[0]);
    scene.triangleMaterial[0] = 1;
    const std::vector<SceneEdge> edges = edgesOf(scene);
    EXPECT_EQ(std::ranges::count_if(edges, [](const SceneEdge& edge) { return edge.sharp; }), 1);
}

class ShadowBorder : public testing::Test
{
protected:
    /// All pieces of the shadow's border lie on the square of this side about its middle, and make it whole.
    static void expectSquare(const Light& light, vec3 middle, float side)
    {
        const Scene scene = plateOverGround();
        const auto rays = RayScene::create(scene);
        ASSERT_TRUE(rays.ok());
        const auto pieces = shadowEdges(*rays, edgesOf(scene), light, [](vec3 a, vec3 b) { return glm::distance(a, b) < 0.1f; });
        float length = 0.0f;
        for (const EdgePiece& piece : pieces)
        {
            for (const vec3 end : {piece.a, piece.b})
            {
                const vec3 off = glm::abs(end - middle);
                EXPECT_NEAR(std::max(off.x, off.z), 0.5f * side, 2e-3f);
                EXPECT_NEAR(off.y, 0.0f, 1e-4f);
            }
            length += glm::distance(piece.a, piece.b);
        }
        EXPECT_NEAR(length, 4.0f * side, 0.01f * side);
    }
};

TEST_F(ShadowBorder, OfTheSunIsTheThingsOutlineWhereItFalls)
{
    Light sun;
    sun.direction = glm::normalize(vec3(0.5f, -1.0f, 0.25f));
    expectSquare(sun, {0.5f, 0.0f, 0.25f}, 1.0f);
}

TEST_F(ShadowBorder, OfAPointLightGrowsWithTheDistance)
{
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = {0.0f, 3.0f, 0.0f};
    expectSquare(lamp, vec3(0.0f), 1.5f); // 3 m to the ground, 2 m to the plate
}

TEST_F(ShadowBorder, IsNotThrownByWhatLiesInShadowOrInNothing)
{
    Scene scene = plateOverGround();
    addPlate(scene, 0.2f, 0.5f); // in the other's shadow
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    Light sun;
    sun.direction = {0.0f, -1.0f, 0.0f};
    const auto pieces = shadowEdges(*rays, edgesOf(scene), sun, [](vec3 a, vec3 b) { return glm::distance(a, b) < 0.1f; });
    ASSERT_FALSE(pieces.empty());
    for (const EdgePiece& piece : pieces) EXPECT_NEAR(std::max(std::abs(piece.a.x), std::abs(piece.a.z)), 0.5f, 2e-3f);
    sun.direction = {0.0f, 1.0f, 0.0f}; // from below: nothing is above
    const auto none = shadowEdges(*rays, edgesOf(scene), sun, [](vec3 a, vec3 b) { return withinAMillimetre(a, b); });
    EXPECT_TRUE(none.empty());
}

} // namespace
} // namespace sconce
