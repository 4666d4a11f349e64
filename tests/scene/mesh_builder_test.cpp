#include "scene/mesh_builder.h"

#include <numbers>

#include <gtest/gtest.h>

#include "scene/scene_check.h"

namespace sconce
{
namespace
{

// Signed volume by the divergence theorem: positive when every face of a closed mesh looks outwards.
double volume(const Scene& scene)
{
    double six = 0.0;
    for (const uvec3 t : scene.triangles)
        six += glm::dot(glm::dvec3(scene.positions[t.x]), glm::cross(glm::dvec3(scene.positions[t.y]), glm::dvec3(scene.positions[t.z])));
    return six / 6.0;
}

void expectClosed(const Scene& scene)
{
    EXPECT_EQ(validate(scene), "");
    const SceneReport report = checkScene(scene);
    EXPECT_EQ(report.openEdges, 0u);
    EXPECT_EQ(report.degenerateTriangles, 0u);
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) ASSERT_GT(glm::dot(geometricNormal(scene, i), scene.normals[scene.triangles[i][k]]), 0.0f) << i;
}

template <class Build> Scene built(Build&& build)
{
    Scene scene;
    MeshBuilder mesh(scene);
    build(mesh, mesh.material("grey", vec3(0.5f)));
    return scene;
}

constexpr double kPi = std::numbers::pi;

TEST(MeshBuilder, ShapesAreClosedAndHaveTheirVolume)
{
    const Scene box = built([](MeshBuilder& mesh, uint32_t m) { mesh.box({1, 2, 3}, {2, 4, 6}, m); });
    expectClosed(box);
    EXPECT_NEAR(volume(box), 6.0, 1e-5);
    const Scene turned = built([](MeshBuilder& mesh, uint32_t m) { mesh.boxTurned({1, 2, 3}, {1, 2, 3}, 0.7f, m); });
    expectClosed(turned);
    EXPECT_NEAR(volume(turned), 6.0, 1e-5);
    const Scene cone = built([](MeshBuilder& mesh, uint32_t m) { mesh.cylinder({5, 0, 5}, 1.0f, 0.5f, 2.0f, 256, m); });
    expectClosed(cone);
    EXPECT_NEAR(volume(cone), kPi * 2.0 / 3.0 * (1.0 + 0.5 + 0.25), 1e-3);
    const Scene ball = built([](MeshBuilder& mesh, uint32_t m) { mesh.sphere({5, 1, 5}, {1.0f, 2.0f, 0.5f}, 128, 64, m); });
    expectClosed(ball);
    EXPECT_NEAR(volume(ball), 4.0 / 3.0 * kPi, 5e-3);
    const Scene roof = built([](MeshBuilder& mesh, uint32_t m) { mesh.gable({0, 1, 0}, {4, 3, 2}, m, m); });
    expectClosed(roof);
    EXPECT_NEAR(volume(roof), 8.0, 1e-5);
}

TEST(BlockSolid, HollowRoomKeepsTheVolumeOfItsWalls)
{
    const Scene room = built(
        [](MeshBuilder& mesh, uint32_t m)
        {
            BlockSolid solid;
            solid.fill({0, 0, 0}, {4, 3, 5}, m);
            solid.carve({0.2f, 0.2f, 0.2f}, {3.8f, 2.8f, 4.8f});
            solid.carve({1, 0.2f, 4}, {2, 2.2f, 6}); // a door
            solid.addTo(mesh);
        });
    expectClosed(room);
    EXPECT_NEAR(volume(room), 4 * 3 * 5 - 3.6 * 2.6 * 4.6 - 1.0 * 2.0 * 0.2, 1e-4);
}

TEST(BlockSolid, NothingFilledIsNothing)
{
    const Scene none = built([](MeshBuilder& mesh, uint32_t) { BlockSolid().addTo(mesh); });
    EXPECT_TRUE(none.triangles.empty());
}

} // namespace
} // namespace sconce
