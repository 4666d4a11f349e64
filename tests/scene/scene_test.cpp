#include "scene/scene.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

Scene oneTriangle()
{
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.normals.assign(3, vec3(0, 0, 1));
    scene.uvs.assign(3, vec2(0));
    scene.triangles = {{0, 1, 2}};
    scene.triangleMaterial = {0};
    scene.materials.emplace_back();
    return scene;
}

// Two texels in a row: black and white, alpha 0 and 255.
Scene textured(Wrap wrap)
{
    Scene scene = oneTriangle();
    scene.images.push_back({"two", 2, 1, {0, 0, 0, 0, 255, 255, 255, 255}});
    scene.materials[0].baseColorTexture.image = 0;
    scene.materials[0].baseColorTexture.wrapU = wrap;
    scene.materials[0].baseColorTexture.wrapV = wrap;
    scene.materials[0].metallicRoughnessTexture = scene.materials[0].baseColorTexture;
    scene.materials[0].metallic = 0.5f;
    return scene;
}

float redAt(const Scene& scene, float u)
{
    return evaluateMaterial(scene, 0, {u, 0.5f}).baseColor.r;
}

TEST(SceneGeometry, NormalFollowsTheWinding)
{
    Scene scene = oneTriangle();
    EXPECT_EQ(geometricNormal(scene, 0), vec3(0, 0, 1));
    std::swap(scene.triangles[0].y, scene.triangles[0].z);
    EXPECT_EQ(geometricNormal(scene, 0), vec3(0, 0, -1));
    scene.positions = {{0, 0, 0}, {1e-22f, 0, 0}, {0, 1e-22f, 0}};
    EXPECT_EQ(geometricNormal(scene, 0), vec3(0, 0, -1)) << "tiny triangles have a direction, too";
    scene.positions[2] = {2e-22f, 0, 0};
    EXPECT_EQ(geometricNormal(scene, 0), vec3(0, 1, 0)) << "degenerate";
}

TEST(SceneMaterial, CoverageIsTheCutoffsOrAlphas)
{
    Scene scene = textured(Wrap::clamp); // alpha 0 at u = 0.25, 1 at u = 0.75
    EXPECT_EQ(coverage(scene, 0, {0.3f, 0.5f}), 1.0f) << "opaque";
    scene.materials[0].alphaCutoff = 0.5f;
    EXPECT_EQ(coverage(scene, 0, {0.4f, 0.5f}), 0.0f);
    EXPECT_EQ(coverage(scene, 0, {0.6f, 0.5f}), 1.0f);
    scene.materials[0].blended = true;
    scene.materials[0].baseColor.a = 0.5f;
    EXPECT_FLOAT_EQ(coverage(scene, 0, {0.6f, 0.5f}), 0.35f);
}

// Of a lamp cut in half, what is not there emits nothing.
TEST(SceneMaterial, MeanEmissionLeavesOutWhatAlphaTakesAway)
{
    Scene scene = textured(Wrap::clamp);
    scene.uvs = {{0.0f, 0.5f}, {1.0f, 0.5f}, {0.0f, 0.5f}}; // u grows along one edge; half of u covers 3/4 of the area
    scene.materials[0].emission = vec3(4.0f, 2.0f, 0.0f);
    EXPECT_EQ(meanEmission(scene, 0), vec3(4.0f, 2.0f, 0.0f));
    scene.materials[0].alphaCutoff = 0.5f;
    EXPECT_NEAR(meanEmission(scene, 0).r, 0.25f * 4.0f, 0.2f);
    scene.materials[0].blended = true;
    EXPECT_NEAR(meanEmission(scene, 0).r, 4.0f * 26.0f / 96.0f, 0.1f); // of the ramp from 0.25 to 0.75, times 2 (1 - u)
    scene.materials[0].baseColor.a = 0.0f;
    EXPECT_EQ(meanEmission(scene, 0), vec3(0.0f));
}

TEST(SceneGeometry, BoundsOfNothingAreEmpty)
{
    EXPECT_TRUE(Scene().bounds().empty());
    EXPECT_FALSE(oneTriangle().bounds().empty());
    EXPECT_EQ(oneTriangle().bounds().size(), vec3(1, 1, 0));
}

// A host's pool of vertices may hold others' anywhere.
TEST(SceneGeometry, BoundsAreOfTrianglesAlone)
{
    Scene scene = oneTriangle();
    const Bounds before = scene.bounds();
    scene.positions.push_back(vec3(1e5f));
    EXPECT_EQ(scene.bounds().low, before.low);
    EXPECT_EQ(scene.bounds().high, before.high);
    scene.triangles[0].x = 1u << 30; // which validate() says
    EXPECT_EQ(scene.bounds().high.z, before.high.z);
}

TEST(EvaluateMaterial, TexelCentresAreExact)
{
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
    {
        EXPECT_FLOAT_EQ(redAt(textured(wrap), 0.25f), 0.0f);
        EXPECT_FLOAT_EQ(redAt(textured(wrap), 0.75f), 1.0f);
        EXPECT_FLOAT_EQ(redAt(textured(wrap), 0.5f), 0.5f) << "halfway between linear 0 and 1";
    }
}

TEST(EvaluateMaterial, WrapModesDifferAtTheBorder)
{
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::repeat), 0.0f), 0.5f) << "blends with the other end";
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::clamp), 0.0f), 0.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::mirror), 0.0f), 0.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::repeat), 1.75f), 1.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::clamp), 1.75f), 1.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::mirror), 1.75f), 0.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::repeat), -0.25f), 1.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::mirror), -0.25f), 0.0f);
    EXPECT_FLOAT_EQ(redAt(textured(Wrap::repeat), 1000.75f), 1.0f);
    EXPECT_TRUE(std::isfinite(redAt(textured(Wrap::repeat), INFINITY)));
}

// IEC 61966-2-1: code 128 is 0.2158605 in linear light, code 10 is 0.0030353.
TEST(EvaluateMaterial, ColoursAreDecodedFromSrgbAndNothingElseIs)
{
    Scene scene = textured(Wrap::clamp);
    scene.images[0] = {"grey", 1, 1, {128, 10, 255, 128}};
    const SurfacePoint point = evaluateMaterial(scene, 0, vec2(0.5f));
    EXPECT_NEAR(point.baseColor.r, 0.2158605f, 1e-6f);
    EXPECT_NEAR(point.baseColor.g, 0.0030353f, 1e-6f);
    EXPECT_FLOAT_EQ(point.baseColor.a, 128.0f / 255.0f);
    EXPECT_FLOAT_EQ(point.roughness, 10.0f / 255.0f);
    EXPECT_FLOAT_EQ(point.metallic, 0.5f);
    scene.materials[0].emission = vec3(10.0f);
    scene.materials[0].emissionTexture.image = 0;
    EXPECT_NEAR(evaluateMaterial(scene, 0, vec2(0.5f)).emission.r, 2.158605f, 1e-5f);
}

TEST(EvaluateMaterial, RowZeroIsTheTopAndTransformsApply)
{
    Scene scene = textured(Wrap::clamp);
    scene.images[0] = {"column", 1, 2, {0, 0, 0, 255, 255, 255, 255, 255}};
    EXPECT_FLOAT_EQ(evaluateMaterial(scene, 0, {0.5f, 0.0f}).baseColor.r, 0.0f);
    EXPECT_FLOAT_EQ(evaluateMaterial(scene, 0, {0.5f, 1.0f}).baseColor.r, 1.0f);
    scene.materials[0].baseColorTexture.uvOffset = {0.0f, 1.0f};
    EXPECT_FLOAT_EQ(evaluateMaterial(scene, 0, {0.5f, 0.0f}).baseColor.r, 1.0f);
}

TEST(Validate, FindsEachFault)
{
    EXPECT_EQ(validate(oneTriangle()), "");
    const auto fault = [](auto&& spoil)
    {
        Scene scene = oneTriangle();
        spoil(scene);
        return validate(scene);
    };
    const float nan = std::nanf("");
    EXPECT_NE(fault([](Scene& s) { s.normals.pop_back(); }), "");
    EXPECT_NE(fault([](Scene& s) { s.triangles[0].z = 3; }), "");
    EXPECT_NE(fault([](Scene& s) { s.triangleMaterial[0] = 1; }), "");
    EXPECT_NE(fault([](Scene& s) { s.triangleMaterial.clear(); }), "");
    EXPECT_NE(fault([&](Scene& s) { s.positions[1].y = nan; }), "");
    EXPECT_NE(fault([&](Scene& s) { s.uvs[1].y = INFINITY; }), "");
    EXPECT_NE(fault([](Scene& s) { s.normals[2] = vec3(0, 0, 2); }), "");
    EXPECT_NE(fault([](Scene& s) { s.materials[0].roughness = 1.5f; }), "");
    EXPECT_NE(fault([&](Scene& s) { s.materials[0].metallic = nan; }), "");
    EXPECT_NE(fault([](Scene& s) { s.materials[0].emission.x = -1.0f; }), "");
    EXPECT_NE(fault([](Scene& s) { s.materials[0].baseColorTexture.image = 0; }), "");
    EXPECT_NE(fault([](Scene& s) { s.images.push_back({"short", 2, 2, std::vector<uint8_t>(15)}); }), "");
    EXPECT_NE(fault([&](Scene& s) { s.sky.z = nan; }), "");
    EXPECT_NE(fault([](Scene& s) { s.lights.emplace_back().direction = vec3(0, -2, 0); }), "");
    EXPECT_NE(fault([](Scene& s) { s.cameras.emplace_back().up = vec3(0, 0, 1); }), "");
    EXPECT_NE(fault([](Scene& s) { s.cameras.emplace_back().verticalFov = 0.0f; }), "");
}

TEST(DefaultLight, ComesOnlyToDarkScenes)
{
    Scene dark = oneTriangle();
    EXPECT_TRUE(addDefaultLight(dark));
    EXPECT_EQ(dark.lights.size(), 1u);
    EXPECT_EQ(validate(dark), "");
    EXPECT_FALSE(addDefaultLight(dark)) << "a second time";
    Scene emitter = oneTriangle();
    emitter.materials[0].emission = vec3(1.0f);
    EXPECT_FALSE(addDefaultLight(emitter));
    Scene sky = oneTriangle();
    sky.sky = vec3(0.1f);
    EXPECT_FALSE(addDefaultLight(sky));
    EXPECT_EQ(sky.lights.size(), 0u);
}

} // namespace
} // namespace sconce
