// What a trace costs as a scene gets more triangles: one scene cut finer and finer, baked for the same probes, traced by the same rays.
//   sconce_tessellation SCENE --probes FILE -o DIR [--triangles N...] [--resolution N] [--rays N] [--runs N]
// The finer scenes have the same surfaces, so that everything but the bake should stay as it is.
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/race/scene_rays.h"
#include "bench/race/tracer_race.h"
#include "placement/probe_set.h"
#include "runtime/bake/bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/named_scene.h"

namespace sconce
{
namespace
{

struct Options
{
    std::string scene, probes, folder;
    std::vector<size_t> triangles{10000, 100000, 1000000, 10000000};
    uint32_t resolution = 256, rays = 50000;
    RaceSettings race;
};

/// Cuts the longest edge of the largest triangles, until there are `count`: vertices at the middle of edges, attributes interpolated.
void cutTo(Scene& scene, size_t count)
{
    const auto longest2 = [&](const uvec3& t)
    {
        const vec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
        return std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    };
    std::vector<std::pair<float, uint32_t>> heap; // by length of the longest edge
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) heap.emplace_back(longest2(scene.triangles[i]), i);
    std::make_heap(heap.begin(), heap.end());
    while (scene.triangles.size() < count && !heap.empty())
    {
        std::pop_heap(heap.begin(), heap.end());
        const uint32_t index = heap.back().second;
        heap.pop_back();
        uvec3 t = scene.triangles[index];
        const auto edge2 = [&](uint32_t a, uint32_t b)
        { return glm::dot(scene.positions[a] - scene.positions[b], scene.positions[a] - scene.positions[b]); };
        while (edge2(t.x, t.y) < edge2(t.y, t.z) || edge2(t.x, t.y) < edge2(t.z, t.x)) t = uvec3(t.y, t.z, t.x);
        const auto middle = uint32_t(scene.positions.size());
        scene.positions.push_back(0.5f * (scene.positions[t.x] + scene.positions[t.y]));
        const vec3 normal = scene.normals[t.x] + scene.normals[t.y];
        scene.normals.push_back(glm::length(normal) > 0.0f ? glm::normalize(normal) : scene.normals[t.x]);
        scene.uvs.push_back(0.5f * (scene.uvs[t.x] + scene.uvs[t.y]));
        scene.triangles[index] = uvec3(t.x, middle, t.z);
        scene.triangles.emplace_back(middle, t.y, t.z);
        scene.triangleMaterial.push_back(scene.triangleMaterial[index]);
        for (const uint32_t cut : {index, uint32_t(scene.triangles.size() - 1)})
        {
            heap.emplace_back(longest2(scene.triangles[cut]), cut);
            std::push_heap(heap.begin(), heap.end());
        }
    }
}

Status run(Options& options)
{
    Result<Scene> scene = namedScene(options.scene);
    if (!scene) return scene.error();
    auto probes = loadProbes(options.probes);
    if (!probes) return probes.error();
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes->probes) positions.push_back(probe.position);
    auto device = OwnDevice::create();
    if (!device) return device.error();
    const auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    auto set = sceneRays(*scene, *truth, options.rays, options.race.seed);
    if (!set) return set.error();
    std::error_code failed;
    std::filesystem::create_directories(options.folder, failed);
    if (failed)
        return Error{ErrorCode::fileError, fmt::format("Cannot make the folder '{}': {}; give another.", options.folder, failed.message())};
    BakeSettings settings;
    settings.resolution = options.resolution;
    settings.bounces = 0;
    settings.surfaceTexels = 0; // rays are raced, not light
    std::cout << "triangles, bake s, Embree ms (same rays, faster of 1 and 8 a call)\n";
    for (const size_t count : options.triangles)
    {
        cutTo(*scene, count);
        BakeReport report;
        auto field = bakeLightField(**gpu, *scene, positions, settings, {}, report);
        if (!field) return field.error();
        const std::string file = fmt::format("{}/{}.sconce", options.folder, scene->triangles.size());
        if (auto status = saveField(*field, file); !status) return status;
        options.race.fields.push_back(file);
        auto finer = RayScene::create(*scene);
        if (!finer) return finer.error();
        std::cout << scene->triangles.size() << ", " << report.sceneSeconds + report.probeSeconds + report.octreeSeconds << ", "
                  << embreeMilliseconds(*finer, *set) << std::endl;
    }
    return raceOnOwnDevice(*set, options.race);
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"What a trace costs as a scene gets more triangles"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--probes", options.probes, "probes.json of sconce place")->required();
    app.add_option("-o,--output", options.folder, "folder for the light fields")->required();
    app.add_option("--triangles", options.triangles, "counts to cut the scene to, rising (default: 10000 100000 1000000 10000000)");
    app.add_option("--resolution", options.resolution, "of the bakes (default: 256)");
    app.add_option("--rays", options.rays, "rays (default: 50000; range: 1 to 262144)")->check(CLI::Range(1u, 262144u));
    app.add_option("--runs", options.race.runs, "timed runs; 0 takes no times (default: 0; range: 0 to 1000)")
        ->check(CLI::Range(0u, 1000u));
    CLI11_PARSE(app, argc, argv);
    return sconce::exitCodeOf(sconce::run(options));
}
