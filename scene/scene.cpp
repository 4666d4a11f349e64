#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/numbers.h"

namespace sconce
{

namespace
{

// IEC 61966-2-1 decoding of the 256 codes, so that filtering happens on linear values as the hardware's sRGB formats do.
const std::array<float, 256>& linearFromSrgb()
{
    static const std::array<float, 256> table = []
    {
        std::array<float, 256> values{};
        for (int code = 0; code < 256; ++code)
        {
            const double s = code / 255.0;
            values[size_t(code)] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
        }
        return values;
    }();
    return table;
}

// Brings a coordinate near [0,1] before it meets the texel count, so that uv = 1e6 doesn't lose its fraction in the product.
float reduceCoordinate(float u, Wrap wrap)
{
    if (!std::isfinite(u)) return 0.0f;
    if (wrap == Wrap::clamp) return std::clamp(u, 0.0f, 1.0f);
    return wrap == Wrap::repeat ? u - std::floor(u) : u - 2.0f * std::floor(0.5f * u);
}

uint32_t wrapTexel(int64_t i, uint32_t count, Wrap wrap)
{
    const int64_t n = count;
    if (wrap == Wrap::clamp) return uint32_t(std::clamp<int64_t>(i, 0, n - 1));
    const int64_t period = wrap == Wrap::repeat ? n : 2 * n;
    const int64_t folded = ((i % period) + period) % period;
    return uint32_t(folded < n ? folded : 2 * n - 1 - folded);
}

vec4 texel(const Image& image, uint32_t x, uint32_t y, bool srgb)
{
    const uint8_t* p = &image.rgba[(size_t(y) * image.width + x) * 4];
    if (!srgb) return vec4(p[0], p[1], p[2], p[3]) / 255.0f;
    const auto& decode = linearFromSrgb();
    return {decode[p[0]], decode[p[1]], decode[p[2]], float(p[3]) / 255.0f}; // alpha is never encoded
}

vec4 sampleTexture(const Scene& scene, const TextureRef& texture, vec2 uv, bool srgb)
{
    if (texture.image < 0) return vec4(1.0f);
    const Image& image = scene.images[size_t(texture.image)];
    const vec2 at = texture.uvScaleRotate * uv + texture.uvOffset;
    const float x = reduceCoordinate(at.x, texture.wrapU) * float(image.width) - 0.5f; // texel centres lie at (i + 0.5) / n
    const float y = reduceCoordinate(at.y, texture.wrapV) * float(image.height) - 0.5f;
    const float x0 = std::floor(x), y0 = std::floor(y);
    const uint32_t xs[2] = {wrapTexel(int64_t(x0), image.width, texture.wrapU), wrapTexel(int64_t(x0) + 1, image.width, texture.wrapU)};
    const uint32_t ys[2] = {wrapTexel(int64_t(y0), image.height, texture.wrapV), wrapTexel(int64_t(y0) + 1, image.height, texture.wrapV)};
    const vec4 top = glm::mix(texel(image, xs[0], ys[0], srgb), texel(image, xs[1], ys[0], srgb), x - x0);
    const vec4 bottom = glm::mix(texel(image, xs[0], ys[1], srgb), texel(image, xs[1], ys[1], srgb), x - x0);
    return glm::mix(top, bottom, y - y0);
}

bool nonNegative(vec3 v)
{
    return finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}
bool unit(vec3 v)
{
    return finite(v) && std::abs(glm::length(v) - 1.0f) < 1e-3f;
}
bool inUnitRange(float v)
{
    return v >= 0.0f && v <= 1.0f;
} // false for NaN

std::string textureFault(const Scene& scene, const TextureRef& texture)
{
    if (texture.image < -1 || texture.image >= int(scene.images.size()))
        return fmt::format("reads image {} of {}; use -1 for no texture", texture.image, scene.images.size());
    if (texture.wrapU > Wrap::mirror || texture.wrapV > Wrap::mirror) return "has an unknown wrap mode; use repeat, clamp or mirror";
    if (!finite(texture.uvScaleRotate[0]) || !finite(texture.uvScaleRotate[1]) || !finite(texture.uvOffset))
        return "has a texture transform that is not finite; give finite numbers";
    return {};
}

std::string materialFault(const Scene& scene, const Material& material)
{
    if (!nonNegative(vec3(material.baseColor)) || !inUnitRange(material.baseColor.a))
        return "has a base colour that is not finite, negative or has alpha outside [0,1]; give linear values from 0 up";
    if (!inUnitRange(material.metallic)) return fmt::format("has metallic {:f}; give a value in [0,1]", material.metallic);
    if (!inUnitRange(material.roughness)) return fmt::format("has roughness {:f}; give a value in [0,1]", material.roughness);
    if (!nonNegative(material.emission)) return "has an emission that is negative or not finite; give radiance from 0 up";
    if (!(material.alphaCutoff >= 0.0f) || !std::isfinite(material.alphaCutoff)) return "has a bad alpha cutoff; give 0 (opaque) or more";
    if (!std::isfinite(material.normalStrength)) return "has a normal strength that is not finite; give 1 for the texture's own";
    for (const TextureRef* texture :
         {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.emissionTexture, &material.normalTexture})
        if (const std::string fault = textureFault(scene, *texture); !fault.empty()) return fault;
    return {};
}

std::string lightFault(const Light& light)
{
    if (light.type > LightType::spot) return "has an unknown type; use directional, point or spot";
    if (!finite(light.position)) return "has a position that is not finite; give metres";
    if (!nonNegative(light.intensity)) return "has an intensity that is negative or not finite; give values from 0 up";
    if (light.type != LightType::point && !unit(light.direction)) return "has a direction that is not unit length; normalise it";
    if (!(light.range >= 0.0f) || !std::isfinite(light.range)) return "has a bad range; give metres, or 0 for unlimited";
    if (light.type == LightType::spot && !(light.innerCone >= 0.0f && light.innerCone <= light.outerCone && light.outerCone <= 1.5707964f))
        return "has bad cones; give 0 <= inner <= outer <= pi/2 radians";
    return {};
}

std::string cameraFault(const Camera& camera)
{
    if (!finite(camera.eye)) return "has an eye that is not finite; give metres";
    if (!unit(camera.forward) || !unit(camera.up)) return "has a forward or up that is not unit length; normalise it";
    if (std::abs(glm::dot(camera.forward, camera.up)) > 1e-3f) return "has an up that is not orthogonal to forward; make it so";
    if (!(camera.verticalFov > 0.0f && camera.verticalFov < 3.1415927f)) return "has a bad field of view; give radians in (0, pi)";
    return {};
}

std::string geometryFault(const Scene& scene)
{
    const size_t count = scene.positions.size();
    if (scene.normals.size() != count || scene.uvs.size() != count)
        return fmt::format("The scene has {} positions, {} normals and {} uvs; give one of each per vertex.", count, scene.normals.size(),
                           scene.uvs.size());
    if (count > std::numeric_limits<uint32_t>::max() || scene.triangles.size() > std::numeric_limits<uint32_t>::max())
        return "The scene has more than 2^32 vertices or triangles; split it.";
    if (scene.triangleMaterial.size() != scene.triangles.size())
        return fmt::format("The scene has {} triangles but {} triangle materials; give one per triangle.", scene.triangles.size(),
                           scene.triangleMaterial.size());
    for (size_t i = 0; i < count; ++i)
    {
        if (!finite(scene.positions[i])) return fmt::format("Vertex {} has a position that is not finite; mend the mesh.", i);
        if (!unit(scene.normals[i])) return fmt::format("Vertex {} has a normal that is not unit length; normalise it.", i);
        if (!finite(scene.uvs[i])) return fmt::format("Vertex {} has a uv that is not finite; mend the mesh.", i);
    }
    for (size_t i = 0; i < scene.triangles.size(); ++i)
    {
        const uvec3 t = scene.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= count)
            return fmt::format("Triangle {} uses vertex {} of {}; mend the indices.", i, std::max({t.x, t.y, t.z}), count);
        if (scene.triangleMaterial[i] >= scene.materials.size())
            return fmt::format("Triangle {} uses material {} of {}; mend the index.", i, scene.triangleMaterial[i], scene.materials.size());
    }
    return {};
}

template <class Thing, class Check> std::string firstFault(const char* kind, const std::vector<Thing>& things, Check&& check)
{
    for (size_t i = 0; i < things.size(); ++i)
        if (const std::string fault = check(things[i]); !fault.empty())
            return fmt::format("{} {} ('{}') {}.", kind, i, things[i].name, fault);
    return {};
}

} // namespace

Bounds Scene::bounds() const
{
    Bounds box;
    for (const uvec3& triangle : triangles)
        for (int corner = 0; corner < 3; ++corner)
            if (triangle[corner] < positions.size()) box.add(positions[triangle[corner]]);
    return box;
}

vec3 geometricNormal(const Scene& scene, uint32_t triangle)
{
    const uvec3 t = scene.triangles[triangle];
    // In double: the cross product of short edges far from the origin, or of 1e-20 m edges, would underflow in single precision.
    const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    return length > 0.0 && std::isfinite(length) ? vec3(n / length) : vec3(0.0f, 1.0f, 0.0f);
}

SurfacePoint evaluateMaterial(const Scene& scene, uint32_t material, vec2 uv)
{
    const Material& m = scene.materials[material];
    const vec4 metallicRoughness = sampleTexture(scene, m.metallicRoughnessTexture, uv, false);
    return {m.baseColor * sampleTexture(scene, m.baseColorTexture, uv, true), m.metallic * metallicRoughness.b,
            m.roughness * metallicRoughness.g, m.emission * vec3(sampleTexture(scene, m.emissionTexture, uv, true))};
}

float coverage(const Scene& scene, uint32_t material, vec2 uv)
{
    const Material& m = scene.materials[material];
    if (!m.blended && m.alphaCutoff <= 0.0f) return 1.0f;
    const float alpha = m.baseColor.a * sampleTexture(scene, m.baseColorTexture, uv, true).a;
    return m.blended ? std::clamp(alpha, 0.0f, 1.0f) : alpha < m.alphaCutoff ? 0.0f : 1.0f;
}

bool hasNormalTextures(const Scene& scene)
{
    return std::ranges::any_of(scene.materials, [](const Material& m) { return m.normalTexture.image >= 0; });
}

vec3 readNormalTexture(const Scene& scene, uint32_t material, vec2 uv)
{
    const Material& m = scene.materials[material];
    return m.normalTexture.image < 0 ? vec3(0.5f, 0.5f, 1.0f) : vec3(sampleTexture(scene, m.normalTexture, uv, false));
}

namespace
{

/// Of what `at` says of the middles of equal triangles that a triangle is cut into.
template <class At> auto meanOver(const Scene& scene, uint32_t triangle, At at)
{
    const uvec3 corners = scene.triangles[triangle];
    constexpr int kSteps = 12; // along a side
    decltype(at(vec2(0.0f))) sum(0.0f);
    const auto add = [&](float i, float j)
    {
        const float u = i / kSteps, v = j / kSteps;
        sum += at(scene.uvs[corners.x] * (1.0f - u - v) + scene.uvs[corners.y] * u + scene.uvs[corners.z] * v);
    };
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; i + j < kSteps; ++j)
        {
            add(float(i) + 1.0f / 3.0f, float(j) + 1.0f / 3.0f);
            if (i + j + 1 < kSteps) add(float(i) + 2.0f / 3.0f, float(j) + 2.0f / 3.0f); // the one that stands on its head
        }
    return sum / float(kSteps * kSteps);
}

bool isOpaque(const Material& material)
{
    return !material.blended && material.alphaCutoff <= 0.0f;
}

} // namespace

float meanCoverage(const Scene& scene, uint32_t triangle)
{
    const uint32_t index = scene.triangleMaterial[triangle];
    if (isOpaque(scene.materials[index])) return 1.0f;
    return meanOver(scene, triangle, [&](vec2 uv) { return coverage(scene, index, uv); });
}

bool emitsAlike(const Material& material)
{
    return isOpaque(material) && material.emissionTexture.image < 0;
}

vec3 emissionAt(const Scene& scene, uint32_t material, vec2 uv)
{
    return coverage(scene, material, uv) * evaluateMaterial(scene, material, uv).emission;
}

vec3 meanEmission(const Scene& scene, uint32_t triangle)
{
    const uint32_t index = scene.triangleMaterial[triangle];
    const Material& material = scene.materials[index];
    if (material.emission == vec3(0.0f)) return vec3(0.0f);
    if (emitsAlike(material)) return material.emission;
    return meanOver(scene, triangle, [&](vec2 uv) { return emissionAt(scene, index, uv); });
}

std::string validate(const Scene& scene)
{
    // Indices first: everything after this may follow them without asking.
    if (std::string fault = geometryFault(scene); !fault.empty()) return fault;
    const auto imageFault = [](const Image& image) -> std::string
    {
        if (image.width == 0 || image.height == 0 || image.rgba.size() != size_t(image.width) * image.height * 4)
            return fmt::format("is {}x{} with {} bytes; give width * height * 4 bytes", image.width, image.height, image.rgba.size());
        return {};
    };
    if (std::string fault = firstFault("Image", scene.images, imageFault); !fault.empty()) return fault;
    if (std::string fault = firstFault("Material", scene.materials, [&](const Material& m) { return materialFault(scene, m); });
        !fault.empty())
        return fault;
    if (std::string fault = firstFault("Light", scene.lights, lightFault); !fault.empty()) return fault;
    if (std::string fault = firstFault("Camera", scene.cameras, cameraFault); !fault.empty()) return fault;
    if (!nonNegative(scene.sky)) return "The sky's radiance is negative or not finite; give values from 0 up.";
    return {};
}

bool addDefaultLight(Scene& scene)
{
    if (!scene.lights.empty() || scene.sky != vec3(0.0f)) return false;
    for (const uint32_t material : scene.triangleMaterial) // an emissive material that no triangle uses gives no light
        if (scene.materials[material].emission != vec3(0.0f)) return false;
    Light sun;
    sun.name = "default sun";
    sun.direction = glm::normalize(vec3(kDefaultSunDirection[0], kDefaultSunDirection[1], kDefaultSunDirection[2]));
    sun.intensity = vec3(kDefaultSunIrradiance[0], kDefaultSunIrradiance[1], kDefaultSunIrradiance[2]);
    scene.lights.push_back(sun);
    scene.sky = vec3(kDefaultSky[0], kDefaultSky[1], kDefaultSky[2]);
    return true;
}

} // namespace sconce
