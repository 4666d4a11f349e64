#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sconce
{

using glm::mat2x3;
using glm::mat3;
using glm::mat4;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// RGBA8 picture, row 0 at the top. Whether its colours are sRGB-encoded is said by the slot that uses it (base colour and emission
/// are, metallic-roughness is not), as in glTF 2.0.
struct Image
{
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba; // [height][width][4]
};

enum class Wrap : uint32_t
{
    repeat,
    clamp,
    mirror
};

/// Which image a material slot reads, and how. uv' = uvScaleRotate * uv + uvOffset (KHR_texture_transform); one uv set a vertex.
struct TextureRef
{
    int image = -1; // index into Scene::images; -1: no texture, the factor stands alone
    Wrap wrapU = Wrap::repeat;
    Wrap wrapV = Wrap::repeat;
    glm::mat2 uvScaleRotate{1.0f};
    vec2 uvOffset{0.0f};
};

/// glTF metallic-roughness. Every surface is lit and seen from both sides (real assets are not watertight), unless Scene::twoSided
/// says otherwise; doubleSided is kept for reports. Alpha: a point is there when alpha >= alphaCutoff, else it is not there at all; of a
/// blended material each ray, texel and pixel draws a lot whether it is there, with alpha as the chance.
struct Material
{
    std::string name;
    vec4 baseColor{1.0f}; // linear, a is alpha
    TextureRef baseColorTexture;
    float metallic = 0.0f;               // [0,1]
    float roughness = 1.0f;              // [0,1], GGX alpha = roughness^2
    TextureRef metallicRoughnessTexture; // g roughness, b metallic
    vec3 emission{0.0f};                 // radiance, W/(m^2 sr), emissive factor times KHR_materials_emissive_strength
    TextureRef emissionTexture;
    TextureRef normalTexture;    // tangent space, as glTF's: +y along decreasing v
    float normalStrength = 1.0f; // scales the texture's x and y
    float alphaCutoff = 0.0f;    // 0: opaque; without a say where blended
    bool blended = false;        // light passes by 1 - alpha
    bool doubleSided = false;
    bool retroreflective = false; // its specular lobe goes back to where light comes from, as road signs': viewerOfLobes(); glTF: extras
};

enum class LightType : uint32_t
{
    directional,
    point,
    spot
};

/// Light without area: the sun or a punctual light (KHR_lights_punctual, its units taken as radiometric).
struct Light
{
    std::string name;
    LightType type = LightType::directional;
    vec3 position{0.0f};               // metres; point and spot
    vec3 direction{0.0f, -1.0f, 0.0f}; // unit, the way the light travels; directional and spot
    vec3 intensity{0.0f};              // directional: irradiance on a facing surface, W/m^2; point and spot: W/sr
    float range = 0.0f;                // metres, 0: unlimited
    float innerCone = 0.0f;            // radians, half angle, spot
    float outerCone = 0.785398163f;    // radians, half angle, spot
};

struct Camera
{
    std::string name;
    vec3 eye{0.0f};
    vec3 forward{0.0f, 0.0f, -1.0f}; // unit
    vec3 up{0.0f, 1.0f, 0.0f};       // unit, orthogonal to forward
    float verticalFov = 1.0f;        // radians
};

struct Bounds
{
    vec3 low{std::numeric_limits<float>::infinity()};
    vec3 high{-std::numeric_limits<float>::infinity()};

    void add(vec3 point) { low = glm::min(low, point), high = glm::max(high, point); }
    bool empty() const { return !(low.x <= high.x); }
    vec3 size() const { return high - low; }
    vec3 centre() const { return 0.5f * (low + high); }
    float diagonal() const { return glm::length(size()); }
};

/// Everything that is lit: world-space triangles (instances expanded), metres, right-handed, y up. A host fills this from its own
/// meshes; scene_gltf.h fills it from a file, builtin_scenes.h from code.
struct Scene
{
    std::string name;
    std::vector<vec3> positions; // [vertices]
    std::vector<vec3> normals;   // [vertices], unit shading normals
    std::vector<vec2> uvs;       // [vertices]
    std::vector<uvec3> triangles;
    std::vector<uint32_t> triangleMaterial; // [triangles]
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    vec3 sky{0.0f};                    // radiance that arrives from every direction where nothing is hit, W/(m^2 sr)
    bool twoSided = true;              // false: only the front (counter-clockwise) of a triangle is seen, by the eye and by probes
    std::vector<std::string> warnings; // what the importer ignored or mended, a sentence each

    Bounds bounds() const; // of the triangles, not of vertices that none uses; looks at each: keep what it returns
};

/// Geometric normal of a triangle by its winding, unit; +y for a degenerate one.
vec3 geometricNormal(const Scene& scene, uint32_t triangle);

/// Base colour, metallic, roughness and emission at a uv, textures sampled bilinearly; the CPU twin of shaders/shared/material.h.
struct SurfacePoint
{
    vec4 baseColor;
    float metallic;
    float roughness;
    vec3 emission;
};
SurfacePoint evaluateMaterial(const Scene& scene, uint32_t material, vec2 uv);

/// How much of a point is there, [0,1]: 1 or 0 by the cutoff, alpha of a blended material.
float coverage(const Scene& scene, uint32_t material, vec2 uv);

/// Whether any material bends its normals by a texture.
bool hasNormalTextures(const Scene& scene);

/// The normal texture's value at a uv, [0,1]; (0.5, 0.5, 1) where there is none.
vec3 readNormalTexture(const Scene& scene, uint32_t material, vec2 uv);

/// Whether a material emits alike all over: neither a texture nor alpha has a say.
bool emitsAlike(const Material& material);

/// Radiance that a point emits: none where it isn't there.
vec3 emissionAt(const Scene& scene, uint32_t material, vec2 uv);

/// Mean radiance that a triangle emits, over all of its area: points that are not there emit nothing. By 144 points where textures have a
/// say.
vec3 meanEmission(const Scene& scene, uint32_t triangle);

/// Mean of coverage() over a triangle, by the same points.
float meanCoverage(const Scene& scene, uint32_t triangle);

/// Checks what every later stage relies on: array lengths agree, indices in range, all numbers finite, normals unit. A host calls it on
/// its own scenes. Returns the sentence of the first fault, or an empty string.
std::string validate(const Scene& scene);

/// The sun and sky that scenes without any light get: irradiance and radiance in the units above.
inline constexpr float kDefaultSunDirection[3] = {-0.3f, -0.9f, -0.25f}; // the way the light travels, not normalised
inline constexpr float kDefaultSunIrradiance[3] = {3.2f, 3.0f, 2.7f};
inline constexpr float kDefaultSky[3] = {0.45f, 0.55f, 0.70f};

/// Adds the default sun and sky when the scene has no light, no emission and no sky; says whether it did.
bool addDefaultLight(Scene& scene);

} // namespace sconce
