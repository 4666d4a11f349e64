#pragma once

#include <cmath>
#include <numbers>

#include "bench/reference/reference.h"
#include "scene/scene.h"

namespace sconce::test
{

inline Material plain(vec3 baseColor, float roughness, float metallic = 0.0f, vec3 emission = vec3(0.0f))
{
    Material material;
    material.baseColor = {baseColor.x, baseColor.y, baseColor.z, 1.0f};
    material.roughness = roughness;
    material.metallic = metallic;
    material.emission = emission;
    return material;
}

inline Light light(LightType type, vec3 position, vec3 direction, float intensity)
{
    Light made;
    made.type = type;
    made.position = position;
    made.direction = direction;
    made.intensity = vec3(intensity);
    return made;
}

inline void addTriangle(Scene& scene, const vec3 (&corners)[3], const vec3 (&normals)[3], uint32_t material)
{
    const auto first = static_cast<uint32_t>(scene.positions.size());
    for (int i = 0; i < 3; ++i)
    {
        scene.positions.push_back(corners[i]);
        scene.normals.push_back(normals[i]);
        scene.uvs.emplace_back(float(i == 1), float(i == 2));
    }
    scene.triangles.emplace_back(first, first + 1, first + 2);
    scene.triangleMaterial.push_back(material);
}

/// Parallelogram centre +- u +- v, normal u x v.
inline void addQuad(Scene& scene, vec3 centre, vec3 u, vec3 v, uint32_t material)
{
    const vec3 n = glm::normalize(glm::cross(u, v));
    const vec3 a = centre - u - v, b = centre + u - v, c = centre + u + v, d = centre - u + v;
    addTriangle(scene, {a, b, c}, {n, n, n}, material);
    addTriangle(scene, {a, c, d}, {n, n, n}, material);
}

inline void addBox(Scene& scene, vec3 centre, float half, uint32_t material)
{
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f})
        {
            vec3 n(0.0f), u(0.0f), v(0.0f);
            n[axis] = side * half, u[(axis + 1) % 3] = half, v[(axis + 2) % 3] = side * half;
            addQuad(scene, centre + n, u, v, material);
        }
}

inline void addSphere(Scene& scene, float radius, int rings, uint32_t material)
{
    const auto at = [&](int i, int j)
    {
        const float theta = std::numbers::pi_v<float> * float(i) / float(rings);
        const float phi = std::numbers::pi_v<float> * float(j % (2 * rings)) / float(rings);
        return vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
    };
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < 2 * rings; ++j)
        {
            const vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (i + 1 < rings) addTriangle(scene, {radius * a, radius * b, radius * c}, {a, b, c}, material);
            if (i > 0) addTriangle(scene, {radius * a, radius * c, radius * d}, {a, c, d}, material);
        }
}

/// Camera whose middle looks from `eye` to `target`.
inline ReferenceSettings view(vec3 eye, vec3 target, uint32_t size, uint32_t samples, float fov = 0.01f)
{
    ReferenceSettings settings;
    settings.bounces = 2;
    settings.width = settings.height = size;
    settings.samples = samples;
    settings.camera.eye = eye;
    settings.camera.forward = glm::normalize(target - eye);
    const vec3 side = std::abs(settings.camera.forward.y) > 0.9f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    settings.camera.up = glm::normalize(side - glm::dot(side, settings.camera.forward) * settings.camera.forward);
    settings.camera.verticalFov = fov;
    return settings;
}

/// Mean and standard error of a layer's first channel over its pixels.
struct Mean
{
    double value = 0.0;
    double error = 0.0;
};
inline Mean meanOf(const ImageSet& images, const char* layer)
{
    const Layer& l = *images.find(layer);
    double sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < images.pixelCount(); ++i)
    {
        const double v = l.pixels[i * l.channels];
        sum += v, squares += v * v;
    }
    const auto n = static_cast<double>(images.pixelCount());
    return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n) / n)};
}

/// The project's reflection model at roughness 1, in double from its definitions: there GGX is 1/pi and Smith's visibility 0.5/(nl + nv).
/// The gain is Turquin's (2019), the share that is left to the diffuse lobe Kulla and Conty's (2017).
struct RoughModel
{
    double baseColor;
    double metallic = 0.0;

    static constexpr double kAtNormal = 0.04; // a dielectric's reflectance
    static constexpr int kSteps = 64;         // of the midpoint rules

    static double schlick(double vh) { return std::pow(1.0 - vh, 5.0); }
    static double cosineToHalf(double nl, double nv, double phi)
    {
        const double vl = nl * nv + std::sqrt((1.0 - nl * nl) * (1.0 - nv * nv)) * std::cos(phi);
        return std::sqrt(0.5 * (1.0 + vl));
    }
    /// Of white light, what a white lobe reflects at once: the integral of nl / (nl + nv) over nl.
    static double white(double nv) { return 1.0 - nv * std::log(1.0 + 1.0 / nv); }
    /// The same weighted by (1 - v.h)^5.
    static double edge(double nv)
    {
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
            {
                const double nl = (i + 0.5) / kSteps;
                sum += schlick(cosineToHalf(nl, nv, std::numbers::pi * (j + 0.5) / kSteps)) * nl / (nl + nv);
            }
        return sum / (kSteps * kSteps);
    }
    static double gain(double color, double nv) { return 1.0 + color * (1.0 / white(nv) - 1.0); }
    /// Of white light, what a lobe of this colour at normal incidence reflects.
    static double reflected(double color, double nv) { return (color * white(nv) + (1.0 - color) * edge(nv)) * gain(color, nv); }
    static double meanReflected(double color)
    {
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) sum += 2.0 * (i + 0.5) / kSteps / kSteps * reflected(color, (i + 0.5) / kSteps);
        return sum;
    }
    double diffuse(double nl, double nv) const
    {
        static const double mean = meanReflected(kAtNormal);
        return baseColor * (1.0 - metallic) / std::numbers::pi * (1.0 - reflected(kAtNormal, nl)) * (1.0 - reflected(kAtNormal, nv)) /
               (1.0 - mean);
    }
    double specular(double vh, double nl, double nv) const
    {
        const auto lobe = [&](double color) { return (color + (1.0 - color) * schlick(vh)) * gain(color, nv); };
        return ((1.0 - metallic) * lobe(kAtNormal) + metallic * lobe(baseColor)) / std::numbers::pi * 0.5 / (nl + nv);
    }
    /// Integral over phi of both lobes, (nl, nv).
    double ring(double nl, double nv) const
    {
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) sum += specular(cosineToHalf(nl, nv, 2.0 * std::numbers::pi * (i + 0.5) / kSteps), nl, nv);
        return 2.0 * std::numbers::pi * (sum / kSteps + diffuse(nl, nv));
    }
    /// Of white light from all sides, what goes to all sides.
    double hemisphericalAlbedo() const
    {
        return baseColor * (1.0 - metallic) * (1.0 - meanReflected(kAtNormal)) + (1.0 - metallic) * meanReflected(kAtNormal) +
               metallic * meanReflected(baseColor);
    }
    /// The base colour of the dielectric that reflects so much.
    static float baseColorOf(double albedo)
    {
        const double specular = meanReflected(kAtNormal);
        return float((albedo - specular) / (1.0 - specular));
    }
};

} // namespace sconce::test
