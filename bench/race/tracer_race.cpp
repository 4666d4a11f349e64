#include "bench/race/tracer_race.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

#include "bench/race/traced_method.h"

namespace sconce
{
namespace
{

struct Speed // of one row, over the runs
{
    std::vector<double> ordered, shuffled; // milliseconds
};

struct Row
{
    std::string name, file;               // file: or what a person is told of an outside runner
    const TracedMethod* method = nullptr; // null: the outside runner
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
    row.score = scoreTraces(set, tracedRays(hits), method.startsFarther());
    if (!cpu) return row;
    std::vector<gpu::RayHit> again(rays.size());
    method.traceOnCpu(rays, again);
    row.cpuDiffers = 0;
    for (size_t i = 0; i < hits.size(); ++i) *row.cpuDiffers += !same(hits[i], again[i]);
    return row;
}

/// The rays that are timed: `count` evenly taken of all, or all again and again.
RaySet timedRays(const RaySet& set, size_t count)
{
    RaySet some;
    some.diagonal = set.diagonal;
    for (size_t k = 0; k < count; ++k)
    {
        const size_t i = count < set.size() ? k * set.size() / count : k % set.size();
        some.origins.push_back(set.origins[i]);
        some.directions.push_back(set.directions[i]);
        some.normals.push_back(set.normals[i]);
    }
    return some;
}

/// Fills the rows' speeds and appends the outside runner's.
Status timeAll(std::vector<Row>& rows, std::span<const std::unique_ptr<TracedMethod>> methods, const RaySet& set,
               const RaceSettings& settings, const std::optional<OutsideRunner>& outside)
{
    // All tracers and the outside runner get the same rays in the same two orders.
    const RaySet rays = timedRays(set, settings.timed);
    const std::vector<uint32_t> order = shuffledOrder(rays.size(), settings.seed);
    RaySet shuffled;
    for (uint32_t i : order)
    {
        shuffled.origins.push_back(rays.origins[i]);
        shuffled.directions.push_back(rays.directions[i]);
    }
    for (const auto& method : methods)
    {
        if (auto status = method->prepare(method->raysOf(rays), order); !status) return status;
        if (auto status = method->writeBetween(uint64_t(settings.cold) << 20); !status) return status;
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto warm = [&] { return std::chrono::duration<float>(std::chrono::steady_clock::now() - begin).count() >= settings.warmUp; };
    do
    {
        for (const auto& method : methods)
            for (bool ordered : {true, false})
                if (const auto milliseconds = method->time(ordered); !milliseconds) return milliseconds.error();
    } while (!warm());
    Row last;
    for (uint32_t run = 0; run < settings.runs; ++run)
    {
        for (size_t m = 0; m < methods.size(); ++m)
            for (bool ordered : {true, false})
            {
                const auto milliseconds = methods[m]->time(ordered);
                if (!milliseconds) return milliseconds.error();
                (ordered ? rows[m].speed.ordered : rows[m].speed.shuffled).push_back(*milliseconds);
            }
        if (!outside) continue;
        const double ordered = outside->milliseconds(rays), mixed = outside->milliseconds(shuffled);
        last.speed.ordered.push_back(ordered);
        last.speed.shuffled.push_back(mixed);
    }
    if (!outside) return success();
    last.name = outside->name;
    last.file = outside->note;
    rows.push_back(std::move(last));
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
                     {"right_1_unsure", s.right1Unsure},
                     {"right_02_unsure", s.right02Unsure},
                     {"false", s.falseHit},
                     {"leak", s.leak},
                     {"unresolved", s.unresolved},
                     {"assumed_right_1", s.assumed1},
                     {"assumed_right_02", s.assumed02},
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
    std::printf("%zu rays, %s; per cent right within 1 %% and 0.2 %% of the diagonal, both with their standard errors by viewpoint, false, "
                "leak, unresolved; right if what is unresolved were a "
                "hit where sight was lost, within both; reads a ray mean, p95, max; "
                "MiB a probe that the trace reads, with radiance\n"
                "tracer           probes     1 %%   +-   0.2 %%   +-   false  leak unres    1 %%  0.2 %%    mean   p95    max  index  "
                "hands   MiB  +rad  "
                "field\n",
                rays, device.c_str());
    for (const Row& row : rows)
    {
        if (!row.method) continue;
        const TraceScore& s = row.score;
        std::printf("%-16s %6u  %6.2f %4.2f  %6.2f %4.2f  %5.2f %5.2f %5.2f  %5.2f  %5.2f  %6.1f %5u %6u  %5.1f  %5.2f  %4.2f  %4.2f  %s\n",
                    row.name.c_str(), row.method->data().info.probeCount, 100 * s.right1, 100 * s.right1Unsure, 100 * s.right02,
                    100 * s.right02Unsure, 100 * s.falseHit, 100 * s.leak, 100 * s.unresolved, 100 * s.assumed1, 100 * s.assumed02,
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
            std::printf("  %8.3f (%8.3f to %8.3f)  %8.3f", times.median, times.p5, times.p95, double(rays) / times.median / 1e3);
            if (yardstick)
                std::printf("  %5.2f", times.median / timesOf(yardstick->speed.*part).median);
            else
                std::printf("      -");
        }
        std::printf("  %s\n", row.file.c_str());
    }
}

} // namespace

Status raceTracers(Gpu& gpu, const std::string& device, const RaySet& set, const RaceSettings& settings,
                   const std::optional<OutsideRunner>& outside)
{
    std::vector<std::unique_ptr<TracedMethod>> methods;
    std::vector<Row> rows;
    for (const std::string& field : settings.fields)
    {
        auto method = TracedMethod::create(gpu, field);
        if (!method) return method.error();
        methods.push_back(std::move(*method));
        auto row = score(*methods.back(), set, settings.cpu);
        if (!row) return row.error();
        rows.push_back(std::move(*row));
    }
    if (!settings.json) printScores(rows, set.size(), device);
    const size_t timed = settings.timed;
    if (settings.runs > 0)
    {
        if (auto status = timeAll(rows, methods, set, settings, outside); !status) return status;
        if (!settings.json) printTimes(rows, timed, settings.runs);
    }
    if (settings.json)
    {
        nlohmann::ordered_json json = nlohmann::ordered_json::array();
        for (const Row& row : rows) json.push_back(toJson(row, timed));
        std::cout << json.dump(2) << std::endl;
    }
    return success();
}

Status raceOnOwnDevice(const RaySet& set, const RaceSettings& settings, const std::optional<OutsideRunner>& outside)
{
    auto device = OwnDevice::create({.memoryBudget = settings.memory << 20});
    if (!device) return device.error();
    auto gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    return raceTracers(**gpu, device->name(), set, settings, outside);
}

int exitCodeOf(const Status& status)
{
    if (status) return 0;
    std::fprintf(stderr, "%s\n", status.error().message.c_str());
    switch (status.error().code)
    {
    case ErrorCode::badArgument:
        return 2;
    case ErrorCode::badInput:
        return 3;
    case ErrorCode::fileError:
        return 5;
    default:
        return 4;
    }
}

} // namespace sconce
