// sconce trace: rays through a light field, on the device or on the CPU with the shaders' own text.
#include <algorithm>
#include <iostream>
#include <span>

#include "base/parallel.h"
#include "bench/opponents/baselines.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "runtime/vulkan/host_vulkan.h"
#include "tools/field_report.h"
#include "tools/ray_files.h"

namespace sconce::tools
{

namespace
{

struct TraceOptions
{
    std::string field, rays, output, tracer = "ours", device;
    bool cpu = false;
};

using Rays = std::span<const gpu::Ray>;
using Hits = std::span<gpu::RayHit>;

constexpr size_t kPiece = 1u << 16; // rays between two looks at the progress

/// Calls trace(first, count) piece by piece.
template <class Trace> Status inPieces(size_t rays, const Progress& progress, const Trace& trace)
{
    for (size_t first = 0; first < rays; first += kPiece)
    {
        if (!progress("trace", double(first) / double(rays))) return Error{ErrorCode::cancelled, "Interrupted; nothing was written."};
        if (Status status = trace(first, std::min(kPiece, rays - first)); !status) return status;
    }
    progress("trace", 1.0);
    return success();
}

Status traceOnCpu(const FieldData& field, std::optional<Baseline> baseline, Rays rays, Hits hits, const Progress& progress, Json& json)
{
    constexpr size_t kBatch = 256;
    const Stopwatch watch;
    Status status = inPieces(rays.size(), progress,
                             [&](size_t first, size_t count)
                             {
                                 if (baseline)
                                 {
                                     traceBaselineOnCpu(field, *baseline, rays.subspan(first, count), hits.subspan(first, count));
                                     return success();
                                 }
                                 parallelFor((count + kBatch - 1) / kBatch,
                                             [&](size_t batch)
                                             {
                                                 twin::LightFieldTwin<float> text(field, Quality{}.trace);
                                                 const size_t begin = first + batch * kBatch, end = std::min(begin + kBatch, first + count);
                                                 for (size_t i = begin; i < end; ++i)
                                                     hits[i] = text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
                                             });
                                 return success();
                             });
    json["device"] = "cpu";
    json["trace_seconds"] = watch.seconds();
    return status;
}

Status traceOnDevice(const FieldData& field, std::optional<Baseline> baseline, const std::string& name, Rays rays, Hits hits,
                     const Progress& progress, Json& json)
{
    const Result<OwnDevice> device = OwnDevice::create({.device = name});
    if (!device) return device.error();
    Result<std::shared_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return gpu.error();
    Result<LightField> lightField = makeLightField(**gpu, field);
    if (!lightField) return lightField.error();
    Result<RayTracer> tracer = makeRayTracer(**gpu, *lightField, baseline ? traceRaysPass(*baseline) : RayShaders{});
    if (!tracer) return tracer.error();
    double milliseconds = 0.0;
    Status status = inPieces(rays.size(), progress,
                             [&](size_t first, size_t count)
                             {
                                 double piece = 0.0;
                                 Status traced = tracer->trace(rays.subspan(first, count), hits.subspan(first, count), &piece);
                                 milliseconds += piece;
                                 return traced;
                             });
    json["device"] = device->name();
    json["trace_seconds"] = milliseconds / 1000.0; // by the device's clock
    return status;
}

int runTrace(const TraceOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<FieldData> field = loadFieldFor(options.field, options.tracer);
    if (!field) return fail(field.error());
    const Result<std::vector<gpu::Ray>> rays = readRays(options.rays);
    if (!rays) return fail(rays.error());
    const std::optional<Baseline> baseline = baselineNamed(options.tracer);

    std::vector<gpu::RayHit> hits(rays->size());
    const Progress progress = consoleProgress(context);
    Json json;
    const Status traced = options.cpu ? traceOnCpu(*field, baseline, *rays, hits, progress, json)
                                      : traceOnDevice(*field, baseline, options.device, *rays, hits, progress, json);
    if (!traced) return fail(traced.error());
    if (Status status = writeHits(hits, options.output); !status) return fail(status.error());

    size_t counts[3] = {};
    double fetches = 0.0, handoffs = 0.0;
    for (const gpu::RayHit& hit : hits)
    {
        ++counts[hit.status];
        fetches += hit.distanceReads;
        handoffs += hit.handoffs;
    }
    const double n = std::max<double>(1.0, double(hits.size()));
    json["rays"] = hits.size();
    json["tracer"] = options.tracer;
    json["hit"] = counts[1], json["miss"] = counts[0], json["unknown"] = counts[2];
    json["distance_fetches_mean"] = fetches / n;
    json["handoffs_mean"] = handoffs / n;
    addCost(json, watch);
    if (context.json)
        print(json);
    else
        std::cout << hits.size() << " rays: " << counts[1] << " hit, " << counts[0] << " miss, " << counts[2] << " unknown; " << fetches / n
                  << " distance fetches and " << handoffs / n << " hand-offs a ray" << std::endl;
    return exitOk;
}

} // namespace

void addTraceCommand(CLI::App& app, Context& context)
{
    CLI::App* command = addCommand(app, context, "trace", "Traces the rays of a CSV file through a light field");
    auto options = std::make_shared<TraceOptions>();
    command->add_option("FIELD", options->field, ".sconce file")->required()->type_name("");
    command->add_option("--rays", options->rays, "CSV with the header ox,oy,oz,dx,dy,dz and a ray a line, metres, world space (required)")
        ->required()
        ->type_name("FILE");
    command->add_option("-o,--output", options->output, "CSV to write: a line a ray, in order (required)")->required()->type_name("FILE");
    addTracer(command, options->tracer);
    command->add_flag("--cpu", options->cpu, described("Trace on the CPU, with the text that the device runs", words("off")));
    addDevice(command, options->device);
    onChosen(command, context, options, runTrace);
}

} // namespace sconce::tools
