#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include "scene/scene_gltf.h"

namespace sconce::test
{

using Json = nlohmann::json;

/// A folder of its own per test, removed at the end, and a small glTF document that tests bend to their case.
class GltfFixture : public testing::Test
{
protected:
    void SetUp() override
    {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        base = std::filesystem::temp_directory_path() /
               ("sconce_" + std::string(info->test_suite_name()) + "_" + info->name() + "_" + std::to_string(getpid()));
        folder = base / "scene";
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(base); }

    template <class T> size_t append(const std::vector<T>& values) // to the one buffer, as a view of its own; says which
    {
        while (binary.size() % 4) binary.push_back(0);
        const size_t offset = binary.size();
        binary.resize(offset + values.size() * sizeof(T));
        std::memcpy(binary.data() + offset, values.data(), values.size() * sizeof(T));
        gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
        return gltf["bufferViews"].size() - 1;
    }
    template <class T> size_t accessor(const std::vector<T>& values, int componentType, const char* type, size_t components)
    {
        const size_t view = append(values);
        gltf["accessors"].push_back(
            {{"bufferView", view}, {"componentType", componentType}, {"count", values.size() / components}, {"type", type}});
        return gltf["accessors"].size() - 1;
    }
    /// One right triangle (0,0,0) (1,0,0) (0,1,0) in mesh 0, node 0, scene 0: area 1/2, normal +z.
    void triangle()
    {
        gltf = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
        const size_t position = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
        gltf["meshes"] = Json::array({{{"primitives", {{{"attributes", {{"POSITION", position}}}}}}}});
    }
    Json& primitive() { return gltf["meshes"][0]["primitives"][0]; }

    void write(const std::string& name, const std::string& bytes) { std::ofstream(folder / name, std::ios::binary) << bytes; }
    std::filesystem::path save() // as scene.gltf and scene.bin
    {
        write("scene.bin", std::string(binary.begin(), binary.end()));
        if (!gltf.contains("buffers")) gltf["buffers"] = Json::array({{{"byteLength", binary.size()}, {"uri", "scene.bin"}}});
        write("scene.gltf", gltf.dump());
        return folder / "scene.gltf";
    }
    Scene load()
    {
        auto result = loadGltf(save());
        if (!result)
        {
            ADD_FAILURE() << result.error().message;
            return {};
        }
        return std::move(*result);
    }
    /// The load must fail with a sentence that holds `part`.
    void expectRefused(const std::string& part, const std::filesystem::path& file)
    {
        const auto result = loadGltf(file);
        ASSERT_FALSE(result.ok()) << "accepted, " << result->triangles.size() << " triangles";
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
        EXPECT_TRUE(result.error().message.ends_with(".")) << result.error().message;
    }
    void expectRefused(const std::string& part) { expectRefused(part, save()); }
    static bool warned(const Scene& scene, const std::string& part)
    {
        for (const std::string& warning : scene.warnings)
            if (warning.find(part) != std::string::npos) return true;
        return false;
    }

    Json gltf;
    std::vector<uint8_t> binary;
    std::filesystem::path base, folder;
};

inline std::string pngBytes(uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGBA;
    std::string out(size_t(width) * height * 8 + 1000, '\0');
    png_alloc_size_t size = out.size();
    EXPECT_TRUE(png_image_write_to_memory(&image, out.data(), &size, 0, rgba.data(), 0, nullptr));
    out.resize(size);
    return out;
}

/// Puts another size into a PNG's header, with its check sum right (PNG specification, annex D: CRC-32).
inline std::string withPngSize(std::string png, uint32_t width, uint32_t height)
{
    const auto put = [&](size_t at, uint32_t v)
    {
        for (int i = 0; i < 4; ++i) png[at + size_t(i)] = char(v >> (24 - 8 * i));
    };
    put(16, width);
    put(20, height);
    uint32_t crc = ~0u;
    for (size_t i = 12; i < 29; ++i)
    {
        crc ^= uint8_t(png[i]);
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    put(29, ~crc);
    return png;
}

} // namespace sconce::test
