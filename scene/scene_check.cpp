#include "scene/scene_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "scene/closed_parts.h"
#include "shaders/shared/brdf.h"

namespace sconce
{

namespace
{

std::string count(uint64_t n, const char* one, const char* many)
{
    return fmt::format("{} {}", n, n == 1 ? one : many);
}

std::string percent(double share)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
    return text;
}

// Edges with one triangle only, and triangles that lie on another one, whichever way either faces.
void checkTopology(const Scene& scene, SceneReport& report)
{
    const std::vector<uint32_t> welded = weld(scene.positions);
    std::vector<uint64_t> edges;
    std::vector<std::array<uint32_t, 3>> faces;
    edges.reserve(scene.triangles.size() * 3);
    faces.reserve(scene.triangles.size());
    for (const uvec3 t : scene.triangles)
    {
        std::array<uint32_t, 3> corner{welded[t.x], welded[t.y], welded[t.z]};
        std::sort(corner.begin(), corner.end());
        if (corner[0] == corner[1] || corner[1] == corner[2]) continue; // has collapsed, and is counted as degenerate
        faces.push_back(corner);
        for (const auto& [a, b] : {std::pair{corner[0], corner[1]}, {corner[1], corner[2]}, {corner[0], corner[2]}})
            edges.push_back(uint64_t(a) << 32 | b);
    }
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size();)
    {
        size_t end = i;
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        ++report.edges;
        report.openEdges += end - i == 1;
        i = end;
    }
    report.openEdgeShare = report.edges ? double(report.openEdges) / double(report.edges) : 0.0;
    std::sort(faces.begin(), faces.end());
    report.duplicateTriangles = uint64_t(faces.end() - std::unique(faces.begin(), faces.end()));
}

/// Least and greatest roughness of a material's texels.
std::pair<float, float> roughnessRange(const Scene& scene, const Material& material)
{
    if (material.metallicRoughnessTexture.image < 0) return {material.roughness, material.roughness};
    const Image& image = scene.images[size_t(material.metallicRoughnessTexture.image)];
    uint8_t low = 255, high = 0;
    for (size_t i = 1; i < image.rgba.size(); i += 4) low = std::min(low, image.rgba[i]), high = std::max(high, image.rgba[i]);
    return {material.roughness * float(low) / 255.0f, material.roughness * float(high) / 255.0f};
}

void countMaterials(const Scene& scene, float raysBelow, SceneReport& report)
{
    std::vector<bool> used(scene.materials.size(), false);
    for (const uint32_t material : scene.triangleMaterial) used[material] = true;
    for (size_t i = 0; i < used.size(); ++i)
    {
        if (!used[i]) continue;
        const Material& material = scene.materials[i];
        const auto [smoothest, roughest] = roughnessRange(scene, material);
        ++report.usedMaterials;
        report.mirrorMaterials += isMirror(smoothest);
        report.glossyMaterials += smoothest < raysBelow + gpu::kRaysBlend && !isMirror(roughest);
        report.roughMaterials += roughest > raysBelow - gpu::kRaysBlend;
        report.metalMaterials += material.metallic >= 0.5f;
        report.maskedMaterials += material.blended || material.alphaCutoff > 0.0f;
        report.doubleSidedMaterials += material.doubleSided;
    }
}

void measureTriangles(const Scene& scene, SceneReport& report)
{
    for (size_t i = 0; i < scene.triangles.size(); ++i)
    {
        const uvec3 t = scene.triangles[i];
        // In double: the cross product of a sliver's edges loses its digits in float.
        const glm::dvec3 a(scene.positions[t.x]), b(scene.positions[t.y]), c(scene.positions[t.z]);
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        report.area += area;
        report.degenerateTriangles += !(area > 0.0);
        if (scene.materials[scene.triangleMaterial[i]].emission == vec3(0.0f)) continue;
        ++report.emissiveTriangles;
        report.emissiveArea += area;
    }
}

void addFindings(const Scene& scene, SceneReport& report)
{
    const auto find = [&](const char* code, Severity severity, std::string sentence) {
        report.findings.push_back({code, severity, std::move(sentence)});
    };
    if (report.triangles == 0) find("empty", Severity::error, "The scene has no triangles; add a mesh or choose another file.");
    const bool lit = !scene.lights.empty() || report.emissiveTriangles > 0 || scene.sky != vec3(0.0f);
    if (!lit)
        find("no-light", Severity::warning, "The scene has no light, emitter or sky; add one, or let the default sun and sky be added.");
    if (report.degenerateTriangles > 0)
        find("degenerate", Severity::warning,
             fmt::format("{} no area; remove them in the modeller.", count(report.degenerateTriangles, "triangle has", "triangles have")));
    if (report.duplicateTriangles > 0)
        find("duplicates", Severity::warning,
             fmt::format("{} exactly on another one, which flickers where their materials differ; remove one of each pair.",
                         count(report.duplicateTriangles, "triangle lies", "triangles lie")));
    if (report.openEdges > 0)
        find("open-edges", report.openEdgeShare > kMostOpenEdges ? Severity::warning : Severity::info,
             fmt::format("{} of the edges have one triangle only, so inside and outside can't be told everywhere; "
                         "close the meshes, or name inner points when placing probes.",
                         percent(report.openEdgeShare)));
    if (report.triangles > 0 && report.bounds.diagonal() < 0.05f)
        find("tiny", Severity::warning, "The scene is less than 5 cm across; glTF is in metres, check the export scale.");
    if (report.bounds.diagonal() > 5000.0f)
        find("huge", Severity::warning,
             "The scene is more than 5 km across; check the export scale, or cut far ground away, for it takes probes.");
    if (!report.bounds.empty() && glm::length(report.bounds.centre()) > 100.0f * report.bounds.diagonal())
        find("far-from-origin", Severity::warning,
             "The scene lies far from the origin for its size, which costs precision; move it there.");
    if (scene.cameras.empty()) find("no-camera", Severity::info, "The scene has no camera; give one with --eye and --target.");
    for (const std::string& warning : scene.warnings) find("import", Severity::info, warning);
}

void addEffects(const Scene& scene, float raysBelow, SceneReport& report)
{
    const auto materials = [](uint64_t n, const std::string& rest) { return count(n, "material has", "materials have") + rest; };
    char traced[64], read[64];
    std::snprintf(traced, sizeof traced, " a roughness from 0.02 to %.4g.", raysBelow + gpu::kRaysBlend);
    std::snprintf(read, sizeof read, " a roughness above %.4g.", raysBelow - gpu::kRaysBlend);
    const auto add = [&](const char* name, bool called, std::string yes, std::string no) {
        report.effects.push_back({name, called, called ? yes : no});
    };
    const uint64_t punctual = report.pointLights + report.spotLights;
    add("sun", report.directionalLights > 0, count(report.directionalLights, "directional light shines.", "directional lights shine."),
        "There is no directional light.");
    add("punctual", punctual > 0, count(punctual, "point or spot light shines.", "point and spot lights shine."),
        "There is no point or spot light.");
    add("emitters", report.emissiveTriangles > 0, count(report.emissiveTriangles, "triangle emits light.", "triangles emit light."),
        "No triangle emits light.");
    add("sky", scene.sky != vec3(0.0f), "The sky has radiance.", "The sky is black.");
    uint64_t diffuse = 0;
    for (const uint32_t material : scene.triangleMaterial)
        diffuse += scene.materials[material].metallic < 1.0f && vec3(scene.materials[material].baseColor) != vec3(0.0f);
    add("diffuse", diffuse > 0, fmt::format("{} diffusely.", count(diffuse, "triangle reflects", "triangles reflect")),
        "No triangle reflects diffusely.");
    add("rough", report.roughMaterials > 0, materials(report.roughMaterials, read), std::string("No material has") + read);
    add("glossy", report.glossyMaterials > 0, materials(report.glossyMaterials, traced), std::string("No material has") + traced);
    add("mirror", report.mirrorMaterials > 0, materials(report.mirrorMaterials, " a roughness below 0.02."),
        "No material has a roughness below 0.02.");
    add("masked", report.maskedMaterials > 0,
        fmt::format("{} cut out by alpha.", count(report.maskedMaterials, "material is", "materials are")),
        "No material is cut out by alpha.");
    add("thin-two-sided", report.openEdges > 0,
        fmt::format("{} on one triangle only: sheets seen from both sides.", count(report.openEdges, "edge borders", "edges border")),
        "Every edge has two triangles or more: all meshes are closed.");
}

} // namespace

SceneReport checkScene(const Scene& scene, float raysBelow)
{
    SceneReport report;
    report.triangles = scene.triangles.size();
    report.vertices = scene.positions.size();
    report.materials = scene.materials.size();
    report.textures = scene.images.size();
    report.cameras = scene.cameras.size();
    for (const Image& image : scene.images) report.textureBytes += image.rgba.size();
    for (const Light& light : scene.lights)
        ++(light.type == LightType::directional ? report.directionalLights
           : light.type == LightType::point     ? report.pointLights
                                                : report.spotLights);
    // What follows indexes materials and vertices without asking, so an invalid scene gets no further.
    if (std::string fault = validate(scene); !fault.empty())
    {
        report.findings.push_back({"invalid", Severity::error, std::move(fault)});
        return report;
    }
    report.bounds = scene.bounds();
    countMaterials(scene, raysBelow, report);
    measureTriangles(scene, report);
    checkTopology(scene, report);
    addFindings(scene, report);
    addEffects(scene, raysBelow, report);
    return report;
}

} // namespace sconce
