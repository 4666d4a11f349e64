#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "scene/closed_parts.h"
#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

std::vector<Outside> outsideOfAll(const Scene& scene)
{
    std::vector<uint32_t> all(scene.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    return outsideOf(scene, all);
}

void turnOver(Scene& scene, size_t first, size_t end)
{
    for (size_t i = first; i < end; ++i) std::swap(scene.triangles[i].y, scene.triangles[i].z);
}

TEST(ClosedParts, ABoxAndASphereAreSeenFromTheirFrontTurnedOverFromTheirBack)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(1000.0f), vec3(1001.0f), white); // far from the origin, where sums about it would cancel
    const size_t box = scene.triangles.size();
    mesh.sphere(vec3(3.0f, 0.0f, 0.0f), 0.01f, 16, 8, white);
    for (const Outside side : outsideOfAll(scene)) EXPECT_EQ(side, Outside::front);
    turnOver(scene, 0, box);
    const std::vector<Outside> turned = outsideOfAll(scene);
    for (size_t i = 0; i < turned.size(); ++i) EXPECT_EQ(turned[i], i < box ? Outside::back : Outside::front) << i;
}

TEST(ClosedParts, SheetsBoxesWithAHoleAndMixedWindingsHaveNoOutside)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, white);
    const size_t sheet = scene.triangles.size();
    mesh.box(vec3(5.0f), vec3(6.0f), white);
    scene.triangles.pop_back(); // a hole
    scene.triangleMaterial.pop_back();
    const size_t holed = scene.triangles.size();
    mesh.box(vec3(8.0f), vec3(9.0f), white);
    turnOver(scene, holed, holed + 1);
    const size_t mixed = scene.triangles.size();
    mesh.box(vec3(11.0f), vec3(12.0f), white);
    const std::vector<Outside> sides = outsideOfAll(scene);
    ASSERT_GT(sheet, 0u);
    for (size_t i = 0; i < sides.size(); ++i) EXPECT_EQ(sides[i], i < mixed ? Outside::both : Outside::front) << i;
}

// Where the walls shine, they shine into the room.
TEST(ClosedParts, ARoomIsSeenFromItsInside)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-2.0f), vec3(2.0f), white);
    const size_t room = scene.triangles.size();
    for (const Outside side : outsideOfAll(scene)) EXPECT_EQ(side, Outside::both) << "it is all there is";
    mesh.box(vec3(-5.0f), vec3(-4.0f), white);
    for (const Outside side : outsideOfAll(scene)) EXPECT_EQ(side, Outside::front) << "a block beside another";
    mesh.box(vec3(0.0f), vec3(0.5f), white);
    const std::vector<Outside> sides = outsideOfAll(scene);
    for (size_t i = 0; i < sides.size(); ++i) EXPECT_EQ(sides[i], i < room ? Outside::both : Outside::front) << i;
}

TEST(ClosedParts, NoTrianglesHaveNoParts)
{
    EXPECT_TRUE(outsideOfAll(Scene()).empty());
}

TEST(Weld, JoinsEqualPositionsAndTheTwoZeros)
{
    EXPECT_EQ(weld({vec3(0.0f), vec3(1.0f), vec3(-0.0f), vec3(1.0f, 1.0f, 1.0000001f)}), (std::vector<uint32_t>{0, 1, 0, 3}));
}

} // namespace
} // namespace sconce
