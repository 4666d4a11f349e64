#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "camera.h"

struct Vertex // in the host's world
{
    glm::vec3 position;
    glm::vec3 normal;
    glm::vec2 uv;
};

/// RGBA8, row 0 at the top.
struct Picture
{
    uint32_t width = 0, height = 0;
    std::vector<unsigned char> rgba;
};

struct Material
{
    glm::vec4 baseColor{1.0f}; // linear
    float metallic = 1.0f, roughness = 1.0f;
    glm::vec3 emission{0.0f}; // radiance, W/(m^2 sr)
    float normalScale = 1.0f;
    float alphaCutoff = 0.0f;                                                                           // 0: opaque
    int baseColorPicture = -1, metallicRoughnessPicture = -1, emissionPicture = -1, normalPicture = -1; // of Model::pictures; -1: none
};

struct Part // one draw
{
    uint32_t firstIndex = 0, indices = 0;
    uint32_t material = 0;
};

struct Sun
{
    glm::vec3 along{0.0f, -1.0f, 0.0f}; // unit, the way its light travels
    glm::vec3 irradiance{0.0f};         // on a surface that faces it, W/m^2
};

/// What a glTF file holds of what this host draws: triangles, metallic-roughness materials with textures, cameras and the first directional
/// light.
struct Model
{
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices; // three a triangle
    std::vector<Part> parts;
    std::vector<Material> materials;
    std::vector<Picture> pictures;
    std::vector<Camera> cameras;
    std::optional<Sun> sun;
    glm::vec3 low{0.0f}, high{0.0f};   // of all positions
    std::vector<std::string> warnings; // what was left out, a sentence each
};

/// @param axes  what each of glTF's axes is times in the host's world; see Convention
/// Throws std::runtime_error with a sentence where the file can't be read or refers to what it doesn't have.
Model loadGltf(const std::filesystem::path& file, glm::vec3 axes);
