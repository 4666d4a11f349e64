// sconce trace: rays through a light field, on the CPU with the shaders' own text.
#include <algorithm>
#include <iostream>

#include "runtime/light_field_file.h"
#include "runtime/quality.h"
#include "runtime/tracer_cpu.h"
#include "svo/parallel.h"
#include "tools/common.h"
#include "tools/ray_files.h"

namespace sconce::tools
{

namespace
{

struct TraceOptions
{
    std::string field, rays, output, tracer = "ours";
    bool cpu = false;
};

int runTrace(const TraceOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<FieldData> field = loadField(options.field);
    if (!field) return fail(field.error());
    const Result<std::vector<gpu::Ray>> rays = readRays(options.rays);
    if (!rays) return fail(rays.error());
    const bool baseline = options.tracer == "b0plus";
    const gpu::LightFieldInfo& info = field->info;
    if (info.probeCount == 0)
        return fail(ErrorCode::badInput, "Light field '" + options.field + "' has no probes; place some and bake it again.");
    if (baseline && (info.chart != gpu::kChartOctahedral || info.gridX == 0))
        return fail(ErrorCode::badInput, "Tracer b0plus needs a grid of octahedral probes; '" + options.field +
                                             "' has none. Place with --method grid and bake with --chart octahedral.");
    if (!baseline && info.chart != gpu::kChartCube)
        return fail(ErrorCode::badInput, "Tracer ours needs cube probes; '" + options.field +
                                             "' has octahedral ones. Bake with --chart cube, or give --tracer b0plus.");

    std::vector<gpu::RayHit> hits(rays->size());
    constexpr size_t kBatch = 1024;
    const Progress progress = consoleProgress(context);
    const Stopwatch tracing;
    for (size_t first = 0; first < hits.size(); first += 64 * kBatch)
    {
        if (!progress("trace", double(first) / double(hits.size()))) return fail(ErrorCode::cancelled, "Interrupted; nothing was written.");
        const size_t count = std::min(64 * kBatch, hits.size() - first);
        parallelFor((count + kBatch - 1) / kBatch,
                    [&](size_t batch)
                    {
                        const size_t begin = first + batch * kBatch, end = std::min(begin + kBatch, first + count);
                        twin::LightFieldTwin<float> text(*field, Quality{}.trace);
                        for (size_t i = begin; i < end; ++i)
                        {
                            const gpu::Ray& ray = (*rays)[i];
                            hits[i] = baseline ? text.b0QueryRay(ray.origin, ray.direction) : text.queryRay(ray.origin, ray.direction);
                        }
                    });
    }
    const double traceSeconds = tracing.seconds();
    progress("trace", 1.0);
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
    Json json;
    json["rays"] = hits.size();
    json["tracer"] = options.tracer;
    json["hit"] = counts[1], json["miss"] = counts[0], json["unknown"] = counts[2];
    json["distance_fetches_mean"] = fetches / n;
    json["handoffs_mean"] = handoffs / n;
    json["trace_seconds"] = traceSeconds;
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
    command
        ->add_option("--tracer", options->tracer,
                     "ours, or b0plus: the uniform-grid baseline, which needs a grid of octahedral probes (default: ours)")
        ->check(unlisted(CLI::IsMember({"ours", "b0plus"})))
        ->type_name("ours|b0plus");
    command->add_flag("--cpu", options->cpu, "Trace on the CPU; it runs the same text as the device (default: on)");
    onChosen(command, context, options, runTrace);
}

} // namespace sconce::tools
