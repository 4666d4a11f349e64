#include "scene/builtin_scenes.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scene/scene_check.h"

namespace sconce
{
namespace
{

Scene make(const std::string& name)
{
    return *makeBuiltinScene(name);
}

class BuiltinScenes : public testing::TestWithParam<std::string>
{
};

TEST_P(BuiltinScenes, IsValidLitAndHasACamera)
{
    const Scene scene = make(GetParam());
    EXPECT_EQ(validate(scene), "");
    EXPECT_EQ(scene.name, GetParam());
    ASSERT_FALSE(scene.cameras.empty());
    EXPECT_EQ(scene.cameras[0].name, "main");
    Scene copy = scene;
    EXPECT_FALSE(addDefaultLight(copy)) << "it has its own light";
    const SceneReport report = checkScene(scene);
    EXPECT_EQ(report.degenerateTriangles, 0u);
    EXPECT_EQ(report.duplicateTriangles, 0u);
}

TEST_P(BuiltinScenes, NormalsAgreeWithTheWinding)
{
    const Scene scene = make(GetParam());
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            ASSERT_GT(glm::dot(geometricNormal(scene, i), scene.normals[scene.triangles[i][k]]), 0.0f) << "triangle " << i;
}

// Nearest hit of a ray by testing every triangle (Moeller and Trumbore 1997).
struct Nearest
{
    float t = std::numeric_limits<float>::infinity();
    bool backFace = false;
};
Nearest nearest(const Scene& scene, vec3 origin, vec3 direction)
{
    Nearest found;
    for (const uvec3 t : scene.triangles)
    {
        const vec3 a = scene.positions[t.x], e1 = scene.positions[t.y] - a, e2 = scene.positions[t.z] - a;
        const vec3 p = glm::cross(direction, e2);
        const float determinant = glm::dot(e1, p);
        if (std::abs(determinant) < 1e-12f) continue;
        const vec3 s = (origin - a) / determinant;
        const float u = glm::dot(s, p);
        const vec3 q = glm::cross(s, e1);
        const float v = glm::dot(direction, q), distance = glm::dot(e2, q);
        if (u < 0 || v < 0 || u + v > 1 || distance <= 0 || distance >= found.t) continue;
        found = {distance, determinant < 0};
    }
    return found;
}

TEST_P(BuiltinScenes, CamerasStandInFreeSpace)
{
    const Scene scene = make(GetParam());
    const int side = GetParam() == "town" ? 3 : 5; // rays a side
    for (const Camera& camera : scene.cameras)
    {
        int back = 0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
            {
                const float tangent = std::tan(0.5f * camera.verticalFov);
                const vec3 right = glm::cross(camera.forward, camera.up);
                const float i = 2.0f * (float(x) + 0.5f) / float(side) - 1.0f, j = 2.0f * (float(y) + 0.5f) / float(side) - 1.0f;
                const Nearest hit =
                    nearest(scene, camera.eye, glm::normalize(camera.forward + tangent * (1.3f * i * right + j * camera.up)));
                back += hit.backFace;
                EXPECT_GT(hit.t, 0.3f) << camera.name << ": something is right in front of it";
            }
        EXPECT_EQ(back, 0) << camera.name << " sees back faces: it stands inside something";
    }
}

TEST_P(BuiltinScenes, IsTheSameEveryTime)
{
    const Scene a = make(GetParam()), b = make(GetParam());
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.triangleMaterial, b.triangleMaterial);
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenes, testing::Values("cornell", "cornell-glossy", "temple", "hall", "town", "plain"),
                         [](const auto& param)
                         {
                             std::string name = param.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(BuiltinScene, ListAndNamesAgree)
{
    for (const BuiltinScene& scene : builtinScenes())
    {
        EXPECT_TRUE(makeBuiltinScene(scene.name).ok()) << scene.name;
        EXPECT_FALSE(scene.description.empty());
    }
    const auto unknown = makeBuiltinScene("sponza");
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().code, ErrorCode::badArgument);
    EXPECT_NE(unknown.error().message.find("cornell-glossy"), std::string::npos) << "the sentence lists what there is";
}

TEST(BuiltinScene, CornellIsATwoMetreBox)
{
    const Bounds bounds = make("cornell").bounds();
    EXPECT_EQ(bounds.low, vec3(-1, 0, -1));
    EXPECT_EQ(bounds.high, vec3(1, 2, 1));
    const SceneReport report = checkScene(make("cornell"));
    EXPECT_NEAR(report.emissiveArea, 0.25, 1e-6);
    EXPECT_EQ(report.glossyMaterials, 0u);
    // Five walls of 4 m^2, the lamp, and two boxes: 2 * 0.6^2 + 4 * 0.6 * 1.2 and 6 * 0.6^2.
    EXPECT_NEAR(report.area, 20.0 + 0.25 + 3.6 + 2.16, 1e-4);
}

TEST(BuiltinScene, CornellGlossyIsGlossy)
{
    const SceneReport report = checkScene(make("cornell-glossy"));
    EXPECT_EQ(report.glossyMaterials, report.usedMaterials - 1) << "all but the lamp";
    EXPECT_EQ(report.mirrorMaterials, 0u);
}

TEST(BuiltinScene, HallIsClosedAndLitByEmittersOnly)
{
    const Scene hall = make("hall");
    EXPECT_TRUE(hall.lights.empty());
    EXPECT_EQ(hall.sky, vec3(0.0f));
    EXPECT_EQ(checkScene(hall).openEdges, 0u);
}

TEST(BuiltinScene, TownIsLargeAndMixed)
{
    const Scene town = make("town");
    EXPECT_GE(town.triangles.size(), 100'000u);
    EXPECT_LE(town.triangles.size(), 500'000u) << "software rendering bakes it, too";
    EXPECT_GE(town.cameras.size(), 6u);
    const SceneReport report = checkScene(town);
    EXPECT_GT(report.emissiveTriangles, 0u);
    EXPECT_GT(report.glossyMaterials, 0u);
    EXPECT_GT(report.metalMaterials, 0u);
}

} // namespace
} // namespace sconce
