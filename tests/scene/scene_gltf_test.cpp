#include "scene/scene_gltf.h"

#include <cmath>
#include <numbers>

#include "tests/scene/gltf_fixture.h"

namespace sconce
{
namespace
{

using test::Json;

class SceneGltf : public test::GltfFixture
{
protected:
    void expectTriangle(const Scene& scene, size_t index, vec3 a, vec3 b, vec3 c)
    {
        ASSERT_LT(index, scene.triangles.size());
        const uvec3 t = scene.triangles[index];
        for (const auto& [got, want] : {std::pair{t.x, a}, {t.y, b}, {t.z, c}})
            EXPECT_LT(glm::length(scene.positions[got] - want), 1e-5f)
                << got << ": " << scene.positions[got].x << " " << scene.positions[got].y << " " << scene.positions[got].z;
    }
};

TEST_F(SceneGltf, TriangleWithoutNormalsIsFlat)
{
    triangle();
    const Scene scene = load();
    expectTriangle(scene, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (const vec3 n : scene.normals) EXPECT_EQ(n, vec3(0, 0, 1));
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(scene.materials[0].metallic, 1.0f) << "no material means glTF's defaults";
}

TEST_F(SceneGltf, IndicesOfEveryWidth)
{
    for (const int type : {5121, 5123, 5125})
    {
        binary.clear();
        triangle();
        primitive()["indices"] = type == 5121   ? accessor<uint8_t>({2, 0, 1}, type, "SCALAR", 1)
                                 : type == 5123 ? accessor<uint16_t>({2, 0, 1}, type, "SCALAR", 1)
                                                : accessor<uint32_t>({2, 0, 1}, type, "SCALAR", 1);
        expectTriangle(load(), 0, {0, 1, 0}, {0, 0, 0}, {1, 0, 0});
    }
}

TEST_F(SceneGltf, StripsAndFansKeepTheirWinding)
{
    triangle();
    const size_t square = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 5126, "VEC3", 3);
    primitive() = {{"attributes", {{"POSITION", square}}}, {"mode", 5}};
    const Scene strip = load();
    ASSERT_EQ(strip.triangles.size(), 2u);
    const size_t round = accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 5126, "VEC3", 3);
    primitive() = {{"attributes", {{"POSITION", round}}}, {"mode", 6}};
    gltf.erase("buffers");
    const Scene fan = load();
    ASSERT_EQ(fan.triangles.size(), 2u);
    for (uint32_t i = 0; i < 2; ++i)
    {
        EXPECT_EQ(geometricNormal(strip, i), vec3(0, 0, 1));
        EXPECT_EQ(geometricNormal(fan, i), vec3(0, 0, 1));
    }
    primitive()["mode"] = 1;
    const Scene lines = load();
    EXPECT_TRUE(lines.triangles.empty());
    EXPECT_TRUE(warned(lines, "lines"));
    EXPECT_TRUE(warned(lines, "no triangles"));
}

TEST_F(SceneGltf, NodesMultiplyFromTheRoot)
{
    triangle();
    // Root moves by x 10, child turns 90 degrees about z, grandchild scales by 2.
    const double h = std::sqrt(0.5);
    gltf["nodes"] = Json::array({{{"translation", {10, 0, 0}}, {"children", {1}}},
                                 {{"rotation", {0, 0, h, h}}, {"children", {2}}},
                                 {{"mesh", 0}, {"scale", {2, 2, 2}}}});
    expectTriangle(load(), 0, {10, 0, 0}, {10, 2, 0}, {8, 0, 0});
    gltf["nodes"] = Json::array({{{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}});
    expectTriangle(load(), 0, {5, 6, 7}, {5, 7, 7}, {4, 6, 7});
}

TEST_F(SceneGltf, NegativeScaleKeepsTheFrontOutside)
{
    triangle();
    primitive()["attributes"]["NORMAL"] = accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
    for (const std::vector<int>& scale : {std::vector{-1, 1, 1}, {1, -3, 1}, {-1, -1, -1}, {1, 1, -1}})
    {
        gltf["nodes"][0]["scale"] = scale;
        const Scene scene = load();
        ASSERT_EQ(scene.triangles.size(), 1u);
        const vec3 expected(0, 0, scale[2] < 0 ? -1 : 1); // the image of +z
        EXPECT_EQ(geometricNormal(scene, 0), expected);
        EXPECT_LT(glm::length(scene.normals[0] - expected), 1e-6f);
    }
}

TEST_F(SceneGltf, NormalsStayPerpendicularUnderUnevenScale)
{
    triangle();
    gltf["nodes"][0] = {{"mesh", 0}, {"scale", {1, 1, 4}}};
    const size_t slope = accessor<float>({0, 0, 0, 1, 0, 1, 0, 1, 0}, 5126, "VEC3", 3);
    const float h = std::sqrt(0.5f);
    primitive()["attributes"] = {{"POSITION", slope}, {"NORMAL", accessor<float>({-h, 0, h, -h, 0, h, -h, 0, h}, 5126, "VEC3", 3)}};
    const Scene scene = load();
    EXPECT_LT(glm::length(scene.normals[0] - geometricNormal(scene, 0)), 1e-6f);
}

TEST_F(SceneGltf, ZeroNormalsBecomeGeometricAndLongOnesUnit)
{
    triangle();
    primitive()["attributes"]["NORMAL"] = accessor<float>({0, 0, 0, 0, 0, 9, 0, 0, 1}, 5126, "VEC3", 3);
    const Scene scene = load();
    for (const vec3 n : scene.normals) EXPECT_EQ(n, vec3(0, 0, 1));
    EXPECT_TRUE(warned(scene, "Normals of length 0"));
}

TEST_F(SceneGltf, InstancesAreExpandedAndDegeneratesCounted)
{
    triangle();
    gltf["nodes"] = Json::array({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 0, 5}}}, {{"mesh", 0}, {"scale", {0, 1, 1}}}});
    gltf["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = load();
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_TRUE(warned(scene, "1 triangles without area"));
    expectTriangle(scene, 1, {0, 0, 5}, {1, 0, 5}, {0, 1, 5});
}

TEST_F(SceneGltf, GpuInstancing)
{
    triangle();
    const size_t at = accessor<float>({0, 0, 0, 0, 0, 3, 7, 0, 0}, 5126, "VEC3", 3),
                 size = accessor<float>({1, 1, 1, 2, 2, 2, 1, 1, 1}, 5126, "VEC3", 3);
    gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", at}, {"SCALE", size}};
    gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 3u);
    expectTriangle(scene, 1, {0, 0, 3}, {2, 0, 3}, {0, 2, 3});
    expectTriangle(scene, 2, {7, 0, 0}, {8, 0, 0}, {7, 1, 0});
}

TEST_F(SceneGltf, OnlyTheDefaultSceneIsImported)
{
    triangle();
    gltf["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
    gltf["scenes"] = Json::array({{{"nodes", {0}}}, {{"nodes", {1}}}});
    gltf["scene"] = 1;
    expectTriangle(load(), 0, {0, 0, 1}, {1, 0, 1}, {0, 1, 1});
    gltf.erase("scene");
    EXPECT_EQ(load().triangles.size(), 1u) << "scene 0";
    gltf.erase("scenes");
    EXPECT_EQ(load().triangles.size(), 2u) << "all root nodes";
}

TEST_F(SceneGltf, QuantizedPositionsAndUvs)
{
    triangle();
    gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
    const size_t position = accessor<int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0}, 5122, "VEC3", 4);
    gltf["accessors"][position]["normalized"] = true;
    gltf["bufferViews"][gltf["accessors"][position]["bufferView"].get<size_t>()]["byteStride"] = 8; // three of four shorts
    primitive()["attributes"] = {{"POSITION", position}};
    gltf["nodes"][0]["scale"] = {2, 2, 2};
    expectTriangle(load(), 0, {0, 0, 0}, {2, 0, 0}, {0, -2, 0});
    gltf["accessors"][position]["normalized"] = false;
    expectTriangle(load(), 0, {0, 0, 0}, {65534, 0, 0}, {0, -65534, 0});
}

TEST_F(SceneGltf, SparseReplacesSingleVertices)
{
    triangle();
    const size_t indices = append<uint8_t>({0, 2}), values = append<float>({-1, -1, 0, 0, 9, 0});
    gltf["accessors"][0]["sparse"] = {
        {"count", 2}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
    expectTriangle(load(), 0, {-1, -1, 0}, {1, 0, 0}, {0, 9, 0});
    gltf["accessors"][0].erase("bufferView"); // then the rest is zero
    expectTriangle(load(), 0, {-1, -1, 0}, {0, 0, 0}, {0, 9, 0});
}

TEST_F(SceneGltf, InterleavedAttributes)
{
    triangle();
    const size_t view = append<float>({0, 0, 0, 0.1f, 0.2f, 0, 1, 0, 0, 0.3f, 0.4f, 0, 0, 1, 0, 0.5f, 0.6f, 0});
    gltf["bufferViews"][view]["byteStride"] = 24;
    gltf["accessors"] = Json::array({{{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                                     {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}});
    primitive()["attributes"] = {{"POSITION", 0}, {"TEXCOORD_0", 1}};
    const Scene scene = load();
    expectTriangle(scene, 0, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_EQ(scene.uvs[scene.triangles[0].z], vec2(0.5f, 0.6f));
}

TEST_F(SceneGltf, MaterialFactorsAndEmissiveStrength)
{
    triangle();
    gltf["materials"] = Json::array(
        {{{"name", "lamp"},
          {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0.25}, {"roughnessFactor", 0.5}}},
          {"emissiveFactor", {1, 0.5, 0}},
          {"doubleSided", true},
          {"alphaMode", "MASK"},
          {"alphaCutoff", 0.3},
          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 15}}}}}}});
    primitive()["material"] = 0;
    const Material m = load().materials[0];
    EXPECT_EQ(m.baseColor, vec4(0.1f, 0.2f, 0.3f, 1.0f));
    EXPECT_FLOAT_EQ(m.metallic, 0.25f);
    EXPECT_FLOAT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.emission, vec3(15.0f, 7.5f, 0.0f));
    EXPECT_FLOAT_EQ(m.alphaCutoff, 0.3f);
    EXPECT_TRUE(m.doubleSided);
    EXPECT_FALSE(m.retroreflective);
}

TEST_F(SceneGltf, ExtrasMakeAMaterialRetroreflective)
{
    triangle();
    primitive()["material"] = 0;
    for (const auto& [extras, expected] : {std::pair{Json{{"retroreflective", true}}, true},
                                           {Json{{"retroreflective", false}}, false},
                                           {Json{{"retroreflective", 1}}, false},
                                           {Json::array({"retroreflective"}), false},
                                           {Json("retroreflective"), false}})
    {
        gltf["materials"] = Json::array({{{"extras", extras}}});
        EXPECT_EQ(load().materials[0].retroreflective, expected) << extras.dump();
    }
}

TEST_F(SceneGltf, ConstantAlphaBelowTheCutoffIsNotThere)
{
    triangle();
    gltf["materials"] = Json::array({{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.1}}}}}});
    primitive()["material"] = 0;
    const Scene holes = load();
    EXPECT_TRUE(holes.triangles.empty());
    EXPECT_TRUE(warned(holes, "1 triangles that their constant alpha"));
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.6;
    EXPECT_EQ(load().triangles.size(), 1u);
}

TEST_F(SceneGltf, BlendedMaterialsKeepTheirAlpha)
{
    triangle();
    gltf["materials"] = Json::array({{{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.1}}}}}});
    primitive()["material"] = 0;
    const Scene glass = load();
    ASSERT_EQ(glass.triangles.size(), 1u);
    EXPECT_TRUE(glass.materials[0].blended);
    EXPECT_FLOAT_EQ(coverage(glass, 0, vec2(0.5f)), 0.1f);
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.0;
    EXPECT_TRUE(load().triangles.empty());
}

TEST_F(SceneGltf, NormalTexturesAreReadWithTheirScale)
{
    triangle();
    write("bumps.png", test::pngBytes(1, 1, {255, 128, 128, 255}));
    gltf["images"] = Json::array({{{"uri", "bumps.png"}}});
    gltf["textures"] = Json::array({{{"source", 0}}});
    gltf["materials"] = Json::array({{{"normalTexture", {{"index", 0}, {"scale", 0.25}}}}});
    primitive()["material"] = 0;
    const Scene scene = load();
    EXPECT_EQ(scene.materials[0].normalTexture.image, 0);
    EXPECT_FLOAT_EQ(scene.materials[0].normalStrength, 0.25f);
    EXPECT_EQ(readNormalTexture(scene, 0, vec2(0.5f)), vec3(255.0f, 128.0f, 128.0f) / 255.0f);
}

TEST_F(SceneGltf, TexturesWithTransformWrapAndSecondUvs)
{
    triangle();
    write("a picture.png", test::pngBytes(2, 1, {255, 0, 0, 255, 0, 255, 0, 255}));
    gltf["images"] = Json::array({{{"uri", "a%20picture.png"}}});
    gltf["samplers"] = Json::array({{{"wrapS", 33071}, {"wrapT", 33648}}});
    gltf["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}});
    const double quarter = std::numbers::pi / 2;
    gltf["materials"] = Json::array(
        {{{"pbrMetallicRoughness",
           {{"baseColorTexture",
             {{"index", 0},
              {"texCoord", 1},
              {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", quarter}}}}}}}}}}});
    primitive()["material"] = 0;
    primitive()["attributes"]["TEXCOORD_0"] = accessor<float>({9, 9, 9, 9, 9, 9}, 5126, "VEC2", 2);
    primitive()["attributes"]["TEXCOORD_1"] = accessor<float>({0, 0, 1, 0, 0, 1}, 5126, "VEC2", 2);
    const Scene scene = load();
    EXPECT_EQ(scene.uvs[scene.triangles[0].y], vec2(1, 0));
    const TextureRef& texture = scene.materials[0].baseColorTexture;
    EXPECT_EQ(texture.wrapU, Wrap::clamp);
    EXPECT_EQ(texture.wrapV, Wrap::mirror);
    // A quarter turn counter-clockwise in a space with v down: u goes to -v, v goes to u.
    const vec2 u = texture.uvScaleRotate * vec2(1, 0) + texture.uvOffset, v = texture.uvScaleRotate * vec2(0, 1) + texture.uvOffset;
    EXPECT_LT(glm::length(u - vec2(0.5f, 0.25f - 2.0f)), 1e-6f);
    EXPECT_LT(glm::length(v - vec2(0.5f + 3.0f, 0.25f)), 1e-6f);
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].rgba[0], 255);
    EXPECT_EQ(scene.images[0].rgba[5], 255);
}

TEST_F(SceneGltf, BadImagesAreNamed)
{
    triangle();
    gltf["images"] = Json::array({{{"uri", "wall.png"}}});
    gltf["textures"] = Json::array({{{"source", 0}}});
    gltf["materials"] = Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    primitive()["material"] = 0;
    expectRefused("wall.png");
    write("wall.png", "no picture");
    expectRefused("wall.png");
    write("wall.png", test::withPngSize(test::pngBytes(1, 1, {1, 2, 3, 4}), 30'000, 30'000));
    expectRefused("30000x30000");
    gltf["images"][0]["uri"] = "../wall.png";
    expectRefused("leads out");
}

TEST_F(SceneGltf, PunctualLights)
{
    triangle();
    gltf["extensionsUsed"] = {"KHR_lights_punctual"};
    gltf["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}},
                     {{"type", "point"}, {"intensity", 40}, {"range", 8}},
                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.4}}}}});
    const auto node = [](int light, Json more)
    {
        more["extensions"]["KHR_lights_punctual"]["light"] = light;
        return more;
    };
    const double h = std::sqrt(0.5);
    gltf["nodes"] =
        Json::array({node(0, {{"rotation", {-h, 0, 0, h}}}), node(1, {{"translation", {1, 2, 3}}}), node(2, {{"scale", {5, 5, 5}}})});
    gltf["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = load();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    EXPECT_LT(glm::length(scene.lights[0].direction - vec3(0, -1, 0)), 1e-6f) << "-z turned by -90 degrees about x";
    EXPECT_EQ(scene.lights[0].intensity, vec3(3.0f, 1.5f, 0.75f));
    EXPECT_EQ(scene.lights[1].position, vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[1].range, 8.0f);
    EXPECT_EQ(scene.lights[2].direction, vec3(0, 0, -1));
    EXPECT_FLOAT_EQ(scene.lights[2].innerCone, 0.1f);
    EXPECT_FLOAT_EQ(scene.lights[2].outerCone, 0.4f);
}

TEST_F(SceneGltf, Cameras)
{
    triangle();
    gltf["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}}}},
                                   {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}});
    const double h = std::sqrt(0.5);
    gltf["nodes"] =
        Json::array({{{"camera", 0}, {"name", "from the side"}, {"translation", {5, 1, 0}}, {"rotation", {0, h, 0, h}}}, {{"camera", 1}}});
    gltf["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = load();
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_TRUE(warned(scene, "Orthographic"));
    const Camera& camera = scene.cameras[0];
    EXPECT_EQ(camera.name, "from the side");
    EXPECT_EQ(camera.eye, vec3(5, 1, 0));
    EXPECT_LT(glm::length(camera.forward - vec3(-1, 0, 0)), 1e-6f);
    EXPECT_LT(glm::length(camera.up - vec3(0, 1, 0)), 1e-6f);
    EXPECT_FLOAT_EQ(camera.verticalFov, 0.9f);
}

TEST_F(SceneGltf, EmptySceneLoadsWithAWarning)
{
    gltf = {{"asset", {{"version", "2.0"}}}};
    gltf["buffers"] = Json::array();
    const Scene scene = load();
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_TRUE(warned(scene, "no triangles"));
}

TEST_F(SceneGltf, ProgressCanCancel)
{
    triangle();
    const auto result = loadGltf(save(), [](std::string_view stage, double) { return stage != "meshes"; });
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace sconce
