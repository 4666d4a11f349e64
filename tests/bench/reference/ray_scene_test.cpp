#include "bench/reference/ray_scene.h"

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

TEST(RayScene, HitHasDistanceUvNormalAndMaterial)
{
    Scene scene;
    scene.materials = {Material{}, Material{}};
    test::addTriangle(scene, {{0, 0, -2}, {1, 0, -2}, {0, 1, -2}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, 1);
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    const auto hit = rays->closest({0.25f, 0.5f, 0}, {0, 0, -1});
    ASSERT_TRUE(hit.has_value());
    EXPECT_FLOAT_EQ(hit->t, 2.0f);
    EXPECT_FLOAT_EQ(hit->uv.x, 0.25f); // corner i's uv is the i-th unit vector
    EXPECT_FLOAT_EQ(hit->uv.y, 0.5f);
    EXPECT_EQ(hit->geometricNormal, vec3(0, 0, 1));
    EXPECT_EQ(hit->material, 1u);
    EXPECT_TRUE(rays->occluded({0.25f, 0.5f, 0}, {0, 0, -1}, 2.1f));
    EXPECT_FALSE(rays->occluded({0.25f, 0.5f, 0}, {0, 0, -1}, 1.9f));
    EXPECT_FALSE(rays->closest({0.75f, 0.75f, 0}, {0, 0, -1}).has_value());
}

// Left half of the picture has alpha 0.5, the right one 1; a cutoff of 0.75 cuts the left half out, one of 0.5 (alpha >= cutoff) none.
TEST(RayScene, AlphaBelowTheCutoffIsNotThere)
{
    Scene scene;
    Image image{"mask", 8, 1, {}};
    for (int i = 0; i < 8; ++i) image.rgba.insert(image.rgba.end(), {255, 255, 255, uint8_t(i < 4 ? 128 : 255)});
    scene.images = {image};
    Material material;
    material.baseColorTexture.image = 0;
    material.alphaCutoff = 0.75f;
    scene.materials = {material, Material{}};
    test::addTriangle(scene, {{0, 0, -2}, {1, 0, -2}, {0, 1, -2}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, 0);
    test::addQuad(scene, {0, 0, -3}, {5, 0, 0}, {0, 5, 0}, 1);
    const auto behind = [&](float x) { return RayScene::create(scene)->closest({x, 0.1f, 0}, {0, 0, -1})->t; };
    EXPECT_FLOAT_EQ(behind(0.2f), 3.0f);
    EXPECT_FLOAT_EQ(behind(0.8f), 2.0f);
    EXPECT_FALSE(RayScene::create(scene)->occluded({0.2f, 0.1f, 0}, {0, 0, -1}, 2.5f));
    EXPECT_TRUE(RayScene::create(scene)->occluded({0.8f, 0.1f, 0}, {0, 0, -1}, 2.5f));
    scene.materials[0].alphaCutoff = 0.5f;
    EXPECT_FLOAT_EQ(behind(0.2f), 2.0f);
    scene.materials[0].baseColorTexture.image = -1;
    scene.materials[0].baseColor.a = 0.5f; // equal to the cutoff: there
    EXPECT_FLOAT_EQ(behind(0.2f), 2.0f);
}

TEST(RayScene, EmptySceneMisses)
{
    const Scene scene;
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    EXPECT_FALSE(rays->closest(vec3(0.0f), {0, 0, 1}).has_value());
}

// One at a time, eight at a time and one call a ray must tell one distance; 21 rays leave a call of eight part empty.
TEST(RayScene, ManyRaysAtOnceAreTheSameRays)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addQuad(scene, vec3(0.0f), {2, 0, 0}, {0, 0, 2}, 0);
    const auto rays = RayScene::create(scene);
    ASSERT_TRUE(rays.ok());
    std::vector<vec3> origins, directions;
    for (int i = 0; i < 21; ++i)
    {
        origins.emplace_back(0.0f, 1.0f, 0.0f);
        directions.push_back(glm::normalize(vec3(0.2f * float(i) - 2.0f, -1.0f, 0.1f)));
    }
    std::vector<float> one(21), eight(21);
    rays->distances(origins, directions, 1, one);
    rays->distances(origins, directions, 8, eight);
    for (int i = 0; i < 21; ++i)
    {
        const auto hit = rays->closest(origins[i], directions[i]);
        EXPECT_EQ(one[i], hit ? hit->t : std::numeric_limits<float>::infinity());
        EXPECT_NEAR(std::min(eight[i], 1e9f), std::min(one[i], 1e9f), 1e-5f);
    }
}

} // namespace
} // namespace sconce
