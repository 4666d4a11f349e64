#include "bench/reference/emitters.h"

#include <algorithm>
#include <cmath>

namespace sconce
{
namespace
{

float mean(vec3 v)
{
    return (v.x + v.y + v.z) / 3.0f;
}

/// What a triangle is drawn by. A tenth of the untextured factor is kept so that no emitting point has density 0.
float weightOf(const Scene& scene, uint32_t triangle)
{
    const Material& material = scene.materials[scene.triangleMaterial[triangle]];
    return 0.9f * mean(meanEmission(scene, triangle)) + 0.1f * mean(material.emission);
}

} // namespace

Emitters::Emitters(const Scene& lit) : scene(lit)
{
    std::vector<double> areas;
    double total = 0.0;
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
    {
        const float emission = weightOf(scene, i);
        if (!(emission > 0.0f)) continue;
        const uvec3 t = scene.triangles[i];
        const double area =
            0.5 * glm::length(glm::cross(scene.positions[t.y] - scene.positions[t.x], scene.positions[t.z] - scene.positions[t.x]));
        if (!(area > 0.0)) continue;
        triangles.push_back(i);
        areas.push_back(area);
        total += area * emission;
        cumulative.push_back(total);
    }
    if (triangles.empty()) return;
    pdf.assign(scene.triangles.size(), 0.0f);
    double before = 0.0;
    for (size_t i = 0; i < triangles.size(); ++i)
    {
        pdf[triangles[i]] = static_cast<float>((cumulative[i] - before) / total / areas[i]);
        before = cumulative[i];
        cumulative[i] /= total;
    }
}

Emitters::Sample Emitters::draw(Random& random) const
{
    const double pick = (static_cast<double>(random.bits() >> 32) + 0.5) * 0x1p-32;
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), pick);
    const size_t index = std::min<size_t>(static_cast<size_t>(found - cumulative.begin()), triangles.size() - 1);
    const vec2 u = random.uniform2();
    const float root = std::sqrt(u.x); // uniform on a triangle (Turk 1990)
    const float b1 = root * (1.0f - u.y);
    const float b2 = root * u.y;
    const uvec3 t = scene.triangles[triangles[index]];
    const auto at = [&](const auto& values) { return values[t.x] * (1.0f - b1 - b2) + values[t.y] * b1 + values[t.z] * b2; };
    return {triangles[index], at(scene.positions), at(scene.uvs), pdf[triangles[index]]};
}

} // namespace sconce
