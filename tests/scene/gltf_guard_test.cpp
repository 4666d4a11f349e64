#include "scene/gltf_guard.h"

#include "tests/scene/gltf_fixture.h"

namespace sconce
{
namespace
{

using test::Json;

class GltfGuard : public test::GltfFixture
{
};

TEST_F(GltfGuard, MissingFileIsAFileError)
{
    const auto result = loadGltf(folder / "nowhere.gltf");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::fileError);
    EXPECT_NE(result.error().message.find("nowhere.gltf"), std::string::npos);
    const auto directory = loadGltf(folder);
    ASSERT_FALSE(directory.ok());
    EXPECT_EQ(directory.error().code, ErrorCode::fileError);
}

TEST_F(GltfGuard, UrisCannotLeaveTheFolder)
{
    triangle();
    save();
    std::filesystem::copy_file(folder / "scene.bin", base / "outside.bin");
    const std::string absolute = (base / "outside.bin").string();
    for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"), std::string("sub/../../outside.bin"),
                                   std::string("..%2Foutside.bin"), absolute, "file://" + absolute, std::string("..\\outside.bin"),
                                   std::string("http://example.org/x.bin"), std::string(".."), std::string("")})
    {
        gltf["buffers"][0]["uri"] = uri;
        SCOPED_TRACE(uri);
        expectRefused("Buffer 0");
    }
    gltf["buffers"][0]["uri"] = "./scene.bin";
    EXPECT_EQ(load().triangles.size(), 1u) << "what stays inside is read";
}

TEST_F(GltfGuard, LinksCannotLeaveTheFolder)
{
    triangle();
    save();
    std::filesystem::copy_file(folder / "scene.bin", base / "outside.bin");
    std::filesystem::create_symlink(base / "outside.bin", folder / "link.bin");
    gltf["buffers"][0]["uri"] = "link.bin";
    expectRefused("leads out of the folder");
    std::filesystem::create_symlink("scene.bin", folder / "inner.bin");
    gltf["buffers"][0]["uri"] = "inner.bin";
    EXPECT_EQ(load().triangles.size(), 1u);
    std::filesystem::create_directory(folder / "folder.bin");
    gltf["buffers"][0]["uri"] = "folder.bin";
    expectRefused("no regular file");
}

TEST_F(GltfGuard, UrisWithSpacesAndDataAreRead)
{
    triangle();
    save();
    std::filesystem::copy_file(folder / "scene.bin", folder / "with space.bin");
    gltf["buffers"][0]["uri"] = "with%20space.bin";
    EXPECT_EQ(load().triangles.size(), 1u);
    // 36 bytes: (0,0,0) (1,0,0) (0,1,0); 1.0f is 00 00 80 3f
    gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    EXPECT_EQ(load().positions[1], vec3(1, 0, 0));
    gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAA!";
    expectRefused("not base64");
    gltf["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAA";
    expectRefused("should have 36");
}

TEST_F(GltfGuard, NestingBombIsRefused)
{
    for (const int depth : {65, 20'000, 1'000'000})
    {
        write("scene.gltf",
              "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(size_t(depth), '[') + std::string(size_t(depth), ']') + "}");
        expectRefused("nested deeper", folder / "scene.gltf");
    }
    triangle();
    gltf["asset"]["generator"] = "brackets in text \" \\ [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[";
    EXPECT_EQ(load().triangles.size(), 1u);
}

TEST_F(GltfGuard, JsonThatIsNoGltfIsRefused)
{
    for (const char* text : {"", "{", "[]", "null", "{}", "{\"asset\":{}}", "{\"asset\":{\"version\":\"1.0\"}}",
                             "{\"asset\":{\"version\":\"2.0\"},\"nodes\":3}", "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[7]}",
                             "{\"asset\":{\"version\":\"2.0\"},\"x\":1e999}"})
    {
        SCOPED_TRACE(text);
        write("scene.gltf", text);
        expectRefused("scene.gltf", folder / "scene.gltf");
    }
}

TEST_F(GltfGuard, UnknownRequiredExtensionIsNamed)
{
    triangle();
    gltf["extensionsUsed"] = {"FOO_unknown"};
    EXPECT_TRUE(warned(load(), "FOO_unknown")) << "used only: ignored with a warning";
    gltf["extensionsRequired"] = {"FOO_unknown"};
    expectRefused("FOO_unknown");
    gltf["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    expectRefused("KHR_draco_mesh_compression");
}

TEST_F(GltfGuard, AccessorsPastTheirBufferAreRefused)
{
    triangle();
    const Json good = gltf;
    const auto spoil = [&](const char* key, const Json& value)
    {
        gltf = good;
        gltf["accessors"][0][key] = value;
        SCOPED_TRACE(std::string(key) + " " + value.dump());
        expectRefused("Accessor 0");
    };
    spoil("count", 4);
    spoil("count", 100'000);
    spoil("count", 18446744073709551615ull);
    spoil("count", 357913942); // times 12 is 8 above 2^32
    spoil("count", -3);
    spoil("count", 2.5);
    spoil("byteOffset", 4);
    spoil("byteOffset", 4000000000ull);
    spoil("byteOffset", 18446744073709551612ull);
    spoil("bufferView", 1);
    spoil("componentType", 5130);
    spoil("componentType", 5124);
    spoil("type", "VEC9");
    gltf = good;
    gltf["bufferViews"][0]["byteLength"] = 40;
    expectRefused("Buffer view 0");
    gltf = good;
    gltf["bufferViews"][0]["byteOffset"] = 1099511627776ull;
    expectRefused("Buffer view 0");
    gltf = good;
    gltf["bufferViews"][0]["byteStride"] = 8;
    expectRefused("stride");
}

TEST_F(GltfGuard, SparseAccessorsPastTheirBufferAreRefused)
{
    triangle();
    const size_t indices = append<uint16_t>({1}), values = append<float>({5, 5, 5});
    const Json sparse = {
        {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", 5123}}}, {"values", {{"bufferView", values}}}};
    const auto with = [&](auto&& spoil)
    {
        gltf["accessors"][0]["sparse"] = sparse;
        spoil(gltf["accessors"][0]["sparse"]);
        expectRefused("Accessor 0");
    };
    with([](Json& s) { s["count"] = 2; });
    with([](Json& s) { s["count"] = 4; });
    with([](Json& s) { s["indices"]["byteOffset"] = 2; });
    with([](Json& s) { s["indices"]["componentType"] = 5126; });
    with([](Json& s) { s["values"]["bufferView"] = 9; });
    with([](Json& s) { s["values"]["byteOffset"] = 4294967296ull; });
    with([](Json& s) { s.erase("values"); });
    with([](Json& s) { s = 3; });
}

TEST_F(GltfGuard, IndicesPastTheVerticesAreRefused)
{
    triangle();
    primitive()["indices"] = accessor<uint16_t>({0, 1, 3}, 5123, "SCALAR", 1);
    expectRefused("index 3 of 3");
}

TEST_F(GltfGuard, ReferencesToNothingAreRefused)
{
    triangle();
    const Json good = gltf;
    const auto spoil = [&](const char* where, auto&& change)
    {
        gltf = good;
        change();
        SCOPED_TRACE(where);
        expectRefused(" of ");
    };
    spoil("mesh", [&] { gltf["nodes"][0]["mesh"] = 7; });
    spoil("node", [&] { gltf["scenes"][0]["nodes"] = {5}; });
    spoil("child", [&] { gltf["nodes"][0]["children"] = {-1}; });
    spoil("scene", [&] { gltf["scene"] = 3; });
    spoil("material", [&] { primitive()["material"] = 0; });
    spoil("position", [&] { primitive()["attributes"]["POSITION"] = 8; });
    spoil("camera", [&] { gltf["nodes"][0]["camera"] = 2; });
}

TEST_F(GltfGuard, CyclesSharedNodesAndDeepChainsAreRefused)
{
    triangle();
    gltf["nodes"] = Json::array({{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}});
    expectRefused("cycle");
    gltf["scenes"][0]["nodes"] = Json::array({0});
    gltf["nodes"] = Json::array({{{"children", {1, 1}}}, {{"mesh", 0}}});
    expectRefused("twice");
    gltf["nodes"] = Json::array();
    for (int i = 0; i < 5000; ++i) gltf["nodes"].push_back({{"children", {i + 1}}});
    gltf["nodes"].push_back({{"mesh", 0}});
    expectRefused("levels deep");
}

TEST_F(GltfGuard, InstanceBombIsRefusedFromItsNumbers)
{
    triangle();
    gltf["accessors"].push_back({{"componentType", 5126}, {"count", 3'000'000}, {"type", "VEC3"}}); // zeros, no data behind it
    primitive()["attributes"]["POSITION"] = 1;
    gltf["scenes"][0]["nodes"] = Json::array();
    gltf["nodes"] = Json::array();
    for (int i = 0; i < 100; ++i)
    {
        gltf["nodes"].push_back({{"mesh", 0}});
        gltf["scenes"][0]["nodes"].push_back(i);
    }
    expectRefused("50000000 triangles");
}

TEST_F(GltfGuard, NonFinitePositionsAreRefused)
{
    triangle();
    const float bad[] = {std::nanf(""), INFINITY, -INFINITY};
    for (const float value : bad)
    {
        std::memcpy(binary.data() + 4, &value, 4);
        expectRefused("not finite");
    }
    const float large = 1e30f;
    std::memcpy(binary.data() + 12, &large, 4);
    const float zero = 0.0f;
    std::memcpy(binary.data() + 4, &zero, 4);
    gltf["nodes"][0]["scale"] = {1e30, 1, 1};
    expectRefused("not finite");
}

class GlbGuard : public test::GltfFixture
{
protected:
    static std::string word(uint32_t v) { return {char(v), char(v >> 8), char(v >> 16), char(v >> 24)}; }
    std::string glb()
    {
        triangle();
        gltf["buffers"] = Json::array({{{"byteLength", binary.size()}}});
        std::string json = gltf.dump();
        while (json.size() % 4) json += ' ';
        const std::string chunks = word(uint32_t(json.size())) + "JSON" + json + word(uint32_t(binary.size())) + std::string("BIN\0", 4) +
                                   std::string(binary.begin(), binary.end());
        return "glTF" + word(2) + word(uint32_t(12 + chunks.size())) + chunks;
    }
};

TEST_F(GlbGuard, GoodFileLoads)
{
    write("scene.glb", glb());
    const auto scene = loadGltf(folder / "scene.glb");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->triangles.size(), 1u);
}

TEST_F(GlbGuard, EveryTruncationIsRefused)
{
    const std::string whole = glb();
    for (size_t length = 0; length < whole.size(); ++length)
    {
        write("scene.glb", whole.substr(0, length));
        ASSERT_FALSE(loadGltf(folder / "scene.glb").ok()) << length;
    }
}

TEST_F(GlbGuard, WrongHeadersAreRefused)
{
    const std::string whole = glb();
    const auto with = [&](size_t at, uint32_t value, const std::string& part)
    {
        std::string bytes = whole;
        bytes.replace(at, 4, word(value));
        write("scene.glb", bytes);
        expectRefused(part, folder / "scene.glb");
    };
    with(4, 1, "GLB version 1");
    with(8, uint32_t(whole.size() + 1), "says it has");
    with(12, 0xffffffffu, "past the end");
    with(16, 0x12345678u, "JSON chunk");
}

} // namespace
} // namespace sconce
