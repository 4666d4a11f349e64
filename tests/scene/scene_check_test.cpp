#include "scene/scene_check.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

bool finds(const SceneReport& report, const std::string& code)
{
    return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) { return f.code == code; });
}

bool calls(const SceneReport& report, const std::string& effect)
{
    for (const SceneEffect& e : report.effects)
        if (e.name == effect) return e.called;
    ADD_FAILURE() << "no effect " << effect;
    return false;
}

Scene box(float roughness = 1.0f)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box({0, 0, 0}, {1, 1, 1}, mesh.material("grey", vec3(0.5f), roughness));
    return scene;
}

TEST(SceneCheck, ClosedBoxHasNoOpenEdges)
{
    const SceneReport report = checkScene(box());
    EXPECT_EQ(report.edges, 18u) << "12 edges and 6 diagonals";
    EXPECT_EQ(report.openEdges, 0u);
    EXPECT_NEAR(report.area, 6.0, 1e-6);
    EXPECT_FALSE(finds(report, "open-edges"));
    EXPECT_TRUE(finds(report, "no-light"));
    EXPECT_FALSE(calls(report, "thin-two-sided"));
    EXPECT_TRUE(calls(report, "diffuse"));
    EXPECT_FALSE(calls(report, "glossy"));
}

TEST(SceneCheck, OpenBoxCountsItsRim)
{
    Scene scene = box();
    scene.triangles.resize(10); // without the last face
    scene.triangleMaterial.resize(10);
    const SceneReport report = checkScene(scene);
    EXPECT_EQ(report.edges, 17u);
    EXPECT_EQ(report.openEdges, 4u);
    EXPECT_TRUE(finds(report, "open-edges"));
    EXPECT_TRUE(calls(report, "thin-two-sided"));
}

TEST(SceneCheck, DuplicatesAndDegenerates)
{
    Scene scene = box();
    const uvec3 first = scene.triangles[0];
    scene.triangles.push_back({first.z, first.y, first.x}); // turned around, still the same place
    scene.triangles.push_back({first.x, first.x, first.y});
    scene.triangleMaterial.insert(scene.triangleMaterial.end(), 2, 0);
    const SceneReport report = checkScene(scene);
    EXPECT_EQ(report.duplicateTriangles, 1u);
    EXPECT_EQ(report.degenerateTriangles, 1u);
    EXPECT_TRUE(finds(report, "duplicates"));
    EXPECT_TRUE(finds(report, "degenerate"));
}

TEST(SceneCheck, MaterialsDecideTheEffects)
{
    EXPECT_TRUE(calls(checkScene(box(0.2f)), "glossy"));
    EXPECT_FALSE(calls(checkScene(box(0.2f)), "mirror"));
    EXPECT_TRUE(calls(checkScene(box(0.01f)), "mirror"));
    EXPECT_FALSE(calls(checkScene(box(0.01f)), "glossy"));
    Scene masked = box();
    masked.materials[0].alphaCutoff = 0.5f;
    EXPECT_TRUE(calls(checkScene(masked), "masked"));
    Scene glass = box();
    glass.materials[0].blended = true;
    EXPECT_TRUE(calls(checkScene(glass), "masked"));
    Scene unused = box();
    unused.materials.push_back(box(0.01f).materials[0]);
    EXPECT_FALSE(calls(checkScene(unused), "mirror")) << "no triangle uses that material";
    Scene textured = box();
    textured.images.push_back({"roughness", 2, 1, {0, 255, 0, 255, 0, 51, 0, 255}}); // 1 and 0.2
    textured.materials[0].metallicRoughnessTexture.image = 0;
    EXPECT_TRUE(calls(checkScene(textured), "glossy"));
}

TEST(SceneCheck, LightsDecideTheEffects)
{
    Scene scene = box();
    scene.lights.emplace_back();
    scene.lights.emplace_back().type = LightType::spot;
    scene.sky = vec3(1.0f);
    scene.materials[0].emission = vec3(2.0f);
    const SceneReport report = checkScene(scene);
    for (const char* effect : {"sun", "punctual", "sky", "emitters"}) EXPECT_TRUE(calls(report, effect)) << effect;
    EXPECT_EQ(report.directionalLights, 1u);
    EXPECT_EQ(report.spotLights, 1u);
    EXPECT_EQ(report.emissiveTriangles, 12u);
    EXPECT_NEAR(report.emissiveArea, 6.0, 1e-6);
    EXPECT_FALSE(finds(report, "no-light"));
}

TEST(SceneCheck, BrokenAndEmptyScenesAreReported)
{
    Scene broken = box();
    broken.triangles[0].x = 999;
    EXPECT_TRUE(finds(checkScene(broken), "invalid"));
    EXPECT_TRUE(finds(checkScene(Scene()), "empty"));
}

TEST(SceneCheck, FarAndTinyScenesAreReported)
{
    Scene far = box();
    for (vec3& p : far.positions) p += vec3(100'000.0f, 0, 0);
    EXPECT_TRUE(finds(checkScene(far), "far-from-origin"));
    Scene tiny = box();
    for (vec3& p : tiny.positions) p *= 0.01f;
    EXPECT_TRUE(finds(checkScene(tiny), "tiny"));
}

} // namespace
} // namespace sconce
