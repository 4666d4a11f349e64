// How right a tracer is: the same glossy rays through one or more baked light fields, against Embree.
//   sconce_ray_accuracy SCENE --field ours.sconce --field grid.sconce [--rays N] [--seed N] [--cpu] [--json]
// A field of the octahedral chart on a grid is traced by baseline B0+, whose rays start a further centimetre off their surface; every
// other one by our tracer. Rays leave surfaces that the scene's cameras and points of the reachable space see, GGX alpha 0.1 to 0.3.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <numeric>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/baselines.h"
#include "bench/ray_sets.h"
#include "placement/free_space.h"
#include "placement/random.h"
#include "placement/visibility.h"
#include "runtime/light_field.h"
#include "runtime/light_field_file.h"
#include "runtime/quality.h"
#include "runtime/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"
#include "svo/parallel.h"

namespace sconce
{
namespace
{

constexpr size_t kLeastViewpoints = 8; // cameras and interior points the rays' surfaces are seen from

struct Options
{
    std::string scene;
    std::vector<std::string> fields;
    uint32_t rays = 100000;
    uint64_t seed = 1;
    bool cpu = false;
    bool json = false;
};

struct Row
{
    std::string field, tracer;
    uint32_t probes = 0;
    TraceScore score;
    double milliseconds = 0.0;
    std::optional<size_t> cpuDiffers; // rays that the CPU's run of the same text answers otherwise
};

Result<RaySet> makeRays(const Scene& scene, const RayScene& truth, const Options& options)
{
    auto visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    auto space = findFreeSpace(scene, *visibility, {});
    if (!space) return space.error();
    RandomStream random(options.seed, 77);
    std::vector<vec3> points;
    while (points.size() + scene.cameras.size() < kLeastViewpoints) points.push_back(space->randomPoint(random));
    return glossyRays(truth, scene.cameras, points, {.count = options.rays, .alphaLow = 0.1f, .alphaHigh = 0.3f, .seed = options.seed});
}

/// Whether two answers are one: the same status, probe and counts, and t within 2e-5.
bool same(const gpu::RayHit& a, const gpu::RayHit& b)
{
    return a.status == b.status && a.probe == b.probe && a.handoffs == b.handoffs && a.distanceReads == b.distanceReads &&
           a.indexReads == b.indexReads && std::abs(a.t - b.t) <= 2e-5f * std::abs(b.t);
}

size_t countDifferences(const FieldData& field, bool baseline, std::span<const gpu::Ray> rays, std::span<const gpu::RayHit> hits)
{
    constexpr size_t kBatch = 1024;
    std::vector<size_t> differ((rays.size() + kBatch - 1) / kBatch);
    parallelFor(differ.size(),
                [&](size_t batch)
                {
                    twin::LightFieldTwin<float> text(field, Quality{}.trace);
                    for (size_t i = batch * kBatch; i < std::min(rays.size(), (batch + 1) * kBatch); ++i)
                    {
                        const gpu::RayHit cpu = baseline ? text.b0QueryRay(rays[i].origin, rays[i].direction)
                                                         : text.queryRay(rays[i].origin, rays[i].direction);
                        differ[batch] += !same(hits[i], cpu);
                    }
                });
    return std::accumulate(differ.begin(), differ.end(), size_t(0));
}

Result<Row> measure(Gpu& gpu, const RaySet& set, const std::string& file, bool cpu)
{
    auto data = loadField(file);
    if (!data) return data.error();
    const bool baseline = data->info.chart == gpu::kChartOctahedral;
    auto field = LightField::create(gpu, *data);
    if (!field) return field.error();
    auto tracer = RayTracer::create(gpu, *field, baseline ? traceRaysB0Plus() : Spirv());
    if (!tracer) return tracer.error();
    std::vector<gpu::Ray> rays(set.size());
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i] = {set.origins[i] + (baseline ? kB0PlusOffset * set.normals[i] : vec3(0.0f)), set.directions[i]};
    std::vector<gpu::RayHit> hits(rays.size());
    Row row{file, baseline ? "b0plus" : "ours", data->info.probeCount, {}, 0.0, {}};
    if (auto status = tracer->trace(rays, hits); !status) return status.error(); // the first run compiles the pass
    if (auto status = tracer->trace(rays, hits, &row.milliseconds); !status) return status.error();
    std::vector<TracedRay> traced(hits.size());
    for (size_t i = 0; i < hits.size(); ++i)
        traced[i] = {TraceStatus(hits[i].status), hits[i].t, uint32_t(hits[i].handoffs), uint32_t(hits[i].distanceReads),
                     uint32_t(hits[i].indexReads)};
    row.score = scoreTraces(set, traced);
    if (cpu) row.cpuDiffers = countDifferences(*data, baseline, rays, hits);
    return row;
}

nlohmann::ordered_json toJson(const Row& row)
{
    const TraceScore& s = row.score;
    nlohmann::ordered_json json = {
        {"field", row.field},
        {"tracer", row.tracer},
        {"probes", row.probes},
        {"rays", s.rays},
        {"right_1", s.right1},
        {"right_02", s.right02},
        {"false", s.falseHit},
        {"leak", s.leak},
        {"unresolved", s.unresolved},
        {"distance_reads", {{"mean", s.distanceReads.mean}, {"p95", s.distanceReads.p95}, {"max", s.distanceReads.max}}},
        {"index_reads_mean", s.indexReads.mean},
        {"handoffs_mean", s.handoffs.mean},
        {"trace_ms", row.milliseconds}};
    if (row.cpuDiffers) json["cpu_differs"] = *row.cpuDiffers;
    return json;
}

void print(const Row& row)
{
    const TraceScore& s = row.score;
    std::printf("%-7s %6u  %6.2f %6.2f  %5.2f %5.2f %5.2f  %6.1f %5u %6u  %5.1f  %5.2f  %9.0f  %s\n", row.tracer.c_str(), row.probes,
                100 * s.right1, 100 * s.right02, 100 * s.falseHit, 100 * s.leak, 100 * s.unresolved, s.distanceReads.mean,
                s.distanceReads.p95, s.distanceReads.max, s.indexReads.mean, s.handoffs.mean, row.milliseconds,
                std::filesystem::path(row.field).filename().c_str());
    if (row.cpuDiffers) std::printf("        the CPU answers %zu of these %zu rays otherwise\n", *row.cpuDiffers, s.rays);
}

Status run(const Options& options)
{
    Result<Scene> scene = options.scene.find('.') == std::string::npos ? makeBuiltinScene(options.scene) : loadGltf(options.scene);
    if (!scene) return scene.error();
    auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    auto set = makeRays(*scene, *truth, options);
    if (!set) return set.error();
    auto device = OwnDevice::create();
    if (!device) return device.error();
    auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    if (!options.json)
        std::printf(
            "%zu rays, %s; per cent right within 1 %% and 0.2 %% of the diagonal, false, leak, unresolved; reads a ray mean, p95, max\n"
            "tracer  probes     1 %%  0.2 %%  false  leak unres    mean   p95    max  index  hands   trace ms  field\n",
            set->size(), device->name().c_str());
    for (const std::string& file : options.fields)
    {
        auto row = measure(**gpu, *set, file, options.cpu);
        if (!row) return row.error();
        if (options.json)
            json.push_back(toJson(*row));
        else
            print(*row);
    }
    if (options.json) std::cout << json.dump(2) << std::endl;
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Accuracy of light field tracers on glossy rays, against Embree"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option("--field", options.fields, "baked light field; repeatable")->required();
    app.add_option("--rays", options.rays, "rays (default: 100000; range: 1 to 10000000)")->check(CLI::Range(1u, 10000000u));
    app.add_option("--seed", options.seed, "seed of the rays (default: 1)");
    app.add_flag("--cpu", options.cpu, "trace the same rays on the CPU, too, and count the answers that differ");
    app.add_flag("--json", options.json, "machine-readable results");
    CLI11_PARSE(app, argc, argv);
    const sconce::Status status = sconce::run(options);
    if (status) return 0;
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    return status.error().code == sconce::ErrorCode::badInput ? 3 : (status.error().code == sconce::ErrorCode::fileError ? 5 : 4);
}
