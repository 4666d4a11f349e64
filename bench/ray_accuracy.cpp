// How right and how fast tracers are: the same glossy rays through baked light fields, against Embree.
//   sconce_ray_accuracy SCENE --field [TRACER=]FILE... [--rays N] [--seed N] [--runs N] [--timed N] [--cpu] [--json]
// TRACER: ours, b0, b0plus, b0plus-octree, wang (bench/baselines.h); left out, the field tells. Rays leave surfaces that the scene's
// cameras and points of the reachable space see, GGX alpha 0.1 to 0.3. With --runs, times: the tracers take turns, so that whatever else
// the machine does falls on all of them, and every turn traces the rays once in the order of the pictures and once shuffled.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/scene_rays.h"
#include "bench/traced_method.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_gltf.h"

namespace sconce
{
namespace
{

struct Options
{
    std::string scene;
    std::vector<std::string> fields;
    uint32_t rays = 100000;
    uint32_t runs = 0;
    uint32_t timed = 50000;
    uint64_t seed = 1;
    bool cpu = false;
    bool json = false;
};

struct Speed // of one row, over the runs
{
    std::vector<double> ordered, shuffled; // milliseconds
};

struct Row
{
    std::string name, file;
    const TracedMethod* method = nullptr; // null: Embree
    TraceScore score;
    std::optional<size_t> cpuDiffers; // rays that the CPU's run of the same text answers otherwise
    Speed speed;
};

/// Whether two answers are one: the same status, probe and counts, and t within 2e-5.
bool same(const gpu::RayHit& a, const gpu::RayHit& b)
{
    return a.status == b.status && a.probe == b.probe && a.handoffs == b.handoffs && a.distanceReads == b.distanceReads &&
           a.indexReads == b.indexReads && std::abs(a.t - b.t) <= 2e-5f * std::abs(b.t);
}

Result<Row> score(TracedMethod& method, const RaySet& set, bool cpu)
{
    Row row;
    row.name = method.name();
    row.file = std::filesystem::path(method.file()).filename();
    row.method = &method;
    const std::vector<gpu::Ray> rays = method.raysOf(set);
    std::vector<gpu::RayHit> hits(rays.size());
    if (auto status = method.trace(rays, hits); !status) return status.error();
    row.score = scoreTraces(set, tracedRays(hits));
    if (!cpu) return row;
    std::vector<gpu::RayHit> again(rays.size());
    method.traceOnCpu(rays, again);
    row.cpuDiffers = 0;
    for (size_t i = 0; i < hits.size(); ++i) *row.cpuDiffers += !same(hits[i], again[i]);
    return row;
}

/// The rays that are timed: `count` evenly taken of all.
RaySet timedRays(const RaySet& set, size_t count)
{
    RaySet some;
    some.diagonal = set.diagonal;
    for (size_t k = 0; k < count; ++k)
    {
        const size_t i = k * set.size() / count;
        some.origins.push_back(set.origins[i]);
        some.directions.push_back(set.directions[i]);
        some.normals.push_back(set.normals[i]);
    }
    return some;
}

/// Embree's milliseconds over the same rays, the faster of one and eight rays a call.
double timeEmbree(const RayScene& truth, const RaySet& rays, std::span<float> t)
{
    double best = std::numeric_limits<double>::infinity();
    for (int width : {1, 8})
    {
        const auto begin = std::chrono::steady_clock::now();
        truth.distances(rays.origins, rays.directions, width, t);
        best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
}

/// Fills the rows' speeds and appends Embree's.
Status timeAll(std::vector<Row>& rows, std::span<const std::unique_ptr<TracedMethod>> methods, const RayScene& truth, const RaySet& set,
               const Options& options)
{
    const RaySet rays = timedRays(set, std::min<size_t>(set.size(), options.timed));
    const std::vector<uint32_t> order = shuffledOrder(rays.size(), options.seed);
    RaySet shuffled;
    for (uint32_t i : order)
    {
        shuffled.origins.push_back(rays.origins[i]);
        shuffled.directions.push_back(rays.directions[i]);
    }
    for (const auto& method : methods)
        if (auto status = method->prepare(method->raysOf(rays), order); !status) return status;
    Row embree;
    embree.name = "embree";
    std::vector<float> t(rays.size());
    for (uint32_t run = 0; run <= options.runs; ++run) // the first one warms up
    {
        for (size_t m = 0; m < methods.size(); ++m)
            for (bool ordered : {true, false})
            {
                const auto milliseconds = methods[m]->time(ordered);
                if (!milliseconds) return milliseconds.error();
                if (run > 0) (ordered ? rows[m].speed.ordered : rows[m].speed.shuffled).push_back(*milliseconds);
            }
        const double ordered = timeEmbree(truth, rays, t), mixed = timeEmbree(truth, shuffled, t);
        if (run == 0) continue;
        embree.speed.ordered.push_back(ordered);
        embree.speed.shuffled.push_back(mixed);
    }
    embree.score.rays = rays.size();
    rows.push_back(std::move(embree));
    return success();
}

nlohmann::ordered_json toJson(const Row& row, size_t timed)
{
    const TraceScore& s = row.score;
    nlohmann::ordered_json json = {{"tracer", row.name}};
    if (row.method)
    {
        json.update({{"field", row.file},
                     {"probes", row.method->data().info.probeCount},
                     {"chart", row.method->data().info.chart == gpu::kChartCube ? "cube" : "octahedral"},
                     {"face_size", row.method->data().info.faceSize},
                     {"trace_mib", row.method->traceMebibytes()},
                     {"radiance_mib", row.method->radianceMebibytes()},
                     {"rays", s.rays},
                     {"right_1", s.right1},
                     {"right_02", s.right02},
                     {"false", s.falseHit},
                     {"leak", s.leak},
                     {"unresolved", s.unresolved},
                     {"distance_reads", {{"mean", s.distanceReads.mean}, {"p95", s.distanceReads.p95}, {"max", s.distanceReads.max}}},
                     {"index_reads_mean", s.indexReads.mean},
                     {"handoffs_mean", s.handoffs.mean}});
        if (row.cpuDiffers) json["cpu_differs"] = *row.cpuDiffers;
    }
    const auto add = [&](const char* name, const std::vector<double>& runs)
    {
        if (runs.empty()) return;
        const Times times = timesOf(runs);
        json[name] = {{"median", times.median}, {"p5", times.p5}, {"p95", times.p95}, {"mrays_per_s", double(timed) / times.median / 1e3}};
    };
    add("coherent_ms", row.speed.ordered);
    add("incoherent_ms", row.speed.shuffled);
    return json;
}

void printScores(std::span<const Row> rows, size_t rays, const std::string& device)
{
    std::printf("%zu rays, %s; per cent right within 1 %% and 0.2 %% of the diagonal, false, leak, unresolved; reads a ray mean, p95, max; "
                "MiB a probe that the trace reads, with radiance\n"
                "tracer           probes     1 %%  0.2 %%  false  leak unres    mean   p95    max  index  hands   MiB  +rad  field\n",
                rays, device.c_str());
    for (const Row& row : rows)
    {
        if (!row.method) continue;
        const TraceScore& s = row.score;
        std::printf("%-16s %6u  %6.2f %6.2f  %5.2f %5.2f %5.2f  %6.1f %5u %6u  %5.1f  %5.2f  %4.2f  %4.2f  %s\n", row.name.c_str(),
                    row.method->data().info.probeCount, 100 * s.right1, 100 * s.right02, 100 * s.falseHit, 100 * s.leak, 100 * s.unresolved,
                    s.distanceReads.mean, s.distanceReads.p95, s.distanceReads.max, s.indexReads.mean, s.handoffs.mean,
                    row.method->traceMebibytes(), row.method->traceMebibytes() + row.method->radianceMebibytes(), row.file.c_str());
        if (row.cpuDiffers) std::printf("        the CPU answers %zu of these %zu rays otherwise\n", *row.cpuDiffers, s.rays);
    }
}

void printTimes(std::span<const Row> rows, size_t rays, uint32_t runs)
{
    const Row* yardstick = nullptr; // B0+ with its probes from the octree: the tracer whose time ours is measured against
    for (const Row& row : rows)
        if (!yardstick && row.method && row.method->baseline() == Baseline::b0PlusOctree) yardstick = &row;
    std::printf("\n%zu rays, %u runs that take turns: milliseconds median (5th to 95th percentile), million rays a second%s\n"
                "tracer                         coherent  Mrays/s  ratio                    shuffled  Mrays/s  ratio  field\n",
                rays, runs, yardstick ? ", ratio of the medians to b0plus-octree" : "");
    for (const Row& row : rows)
    {
        std::printf("%-16s", row.name.c_str());
        for (const auto part : {&Speed::ordered, &Speed::shuffled})
        {
            const Times times = timesOf(row.speed.*part);
            std::printf("  %6.0f (%5.0f to %5.0f)  %7.3f", times.median, times.p5, times.p95, double(rays) / times.median / 1e3);
            if (yardstick)
                std::printf("  %5.2f", times.median / timesOf(yardstick->speed.*part).median);
            else
                std::printf("      -");
        }
        std::printf("  %s\n", row.method ? row.file.c_str() : "all cores, robust, the faster of 1 and 8 rays a call");
    }
}

Status run(const Options& options)
{
    Result<Scene> scene = options.scene.find('.') == std::string::npos ? makeBuiltinScene(options.scene) : loadGltf(options.scene);
    if (!scene) return scene.error();
    auto truth = RayScene::create(*scene);
    if (!truth) return truth.error();
    auto set = sceneRays(*scene, *truth, options.rays, options.seed);
    if (!set) return set.error();
    auto device = OwnDevice::create();
    if (!device) return device.error();
    auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    std::vector<std::unique_ptr<TracedMethod>> methods;
    std::vector<Row> rows;
    for (const std::string& field : options.fields)
    {
        auto method = TracedMethod::create(**gpu, field);
        if (!method) return method.error();
        methods.push_back(std::move(*method));
        auto row = score(*methods.back(), *set, options.cpu);
        if (!row) return row.error();
        rows.push_back(std::move(*row));
    }
    if (!options.json) printScores(rows, set->size(), device->name());
    const size_t timed = std::min<size_t>(set->size(), options.timed);
    if (options.runs > 0)
    {
        if (auto status = timeAll(rows, methods, *truth, *set, options); !status) return status;
        if (!options.json) printTimes(rows, timed, options.runs);
    }
    if (options.json)
    {
        nlohmann::ordered_json json = nlohmann::ordered_json::array();
        for (const Row& row : rows) json.push_back(toJson(row, timed));
        std::cout << json.dump(2) << std::endl;
    }
    return success();
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    CLI::App app{"Accuracy and speed of light field tracers on glossy rays, against Embree"};
    sconce::Options options;
    app.add_option("SCENE", options.scene, ".gltf, .glb or built-in name")->required();
    app.add_option(
           "--field", options.fields,
           "[TRACER=]FILE, a baked light field and what traces it: ours, b0, b0plus, b0plus-octree or wang; ours/ranked:2,opinion:0 "
           "sets knobs, b0plus/8 the low factor (default: b0plus for octahedral maps on a grid, b0plus-octree for others, else ours); "
           "repeatable")
        ->required();
    app.add_option("--rays", options.rays, "rays (default: 100000; range: 1 to 10000000)")->check(CLI::Range(1u, 10000000u));
    app.add_option("--runs", options.runs, "timed runs; 0 takes no times (default: 0; range: 0 to 1000)")->check(CLI::Range(0u, 1000u));
    app.add_option("--timed", options.timed, "rays of a timed run, evenly taken of all (default: 50000; range: 1 to 262144)")
        ->check(CLI::Range(1u, 262144u));
    app.add_option("--seed", options.seed, "seed of the rays and of their shuffling (default: 1)");
    app.add_flag("--cpu", options.cpu, "trace the same rays on the CPU, too, and count the answers that differ");
    app.add_flag("--json", options.json, "machine-readable results");
    CLI11_PARSE(app, argc, argv);
    const sconce::Status status = sconce::run(options);
    if (status) return 0;
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    switch (status.error().code)
    {
    case sconce::ErrorCode::badArgument:
        return 2;
    case sconce::ErrorCode::badInput:
        return 3;
    case sconce::ErrorCode::fileError:
        return 5;
    default:
        return 4;
    }
}
