// sconce trace: rays through a light field, on the CPU with the shaders' own text.
#include <algorithm>
#include <cmath>
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

using Twin = twin::LightFieldTwin<float>;

bool finite(vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// What shading uses where a ray ended unresolved: the last surfel it met, else the light that the nearest leaf's best probe saw that way.
vec3 fallbackRadiance(Twin& text, const Twin::TraceResult& result, vec3 direction, vec3 point, int& reads)
{
    if (result.face >= 0) return text.surfelRadiance(result);
    return text.probeIrradiance(text.rankedProbesAt(point, reads).x, direction);
}

RayHit traceOne(Twin& text, const Ray& ray, bool baseline)
{
    const gpu::LightFieldInfo& info = text.field;
    RayHit out;
    out.radiance = info.sky;
    // Scaled first, so that neither a tiny nor a huge direction is lost on the way to unit length.
    const float largest = std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
    if (!finite(ray.origin) || !finite(ray.direction) || !(largest > 0.0f))
    {
        out.position = finite(ray.origin) ? ray.origin : vec3(0.0f);
        return out;
    }
    const vec3 direction = glm::normalize(ray.direction / largest);
    const vec3 origin = (ray.origin - vec3(info.origin)) / info.scale;
    const Twin::TraceResult result = baseline ? text.b0TraceRay(origin, direction) : text.traceRay(origin, direction);
    out.status = HitStatus(result.status); // kMiss, kHit, kUnknown are numbered alike
    out.t = result.t * info.scale;
    out.position = ray.origin + out.t * direction;
    out.probe = result.probe == gpu::kNoProbe ? -1 : int(result.probe);
    out.handoffs = result.handoffs;
    out.distanceFetches = result.distanceReads;
    out.indexFetches = result.indexReads;
    if (out.status == HitStatus::hit)
    {
        out.normal = baseline ? text.unpackNormal8(result.word >> 16) : text.texelNormal(result.face, result.pixel, result.word);
        out.radiance = baseline ? text.b0Radiance(result) : text.surfelRadiance(result);
    }
    else if (out.status == HitStatus::unknown && !baseline)
        out.radiance = fallbackRadiance(text, result, direction, origin + result.t * direction, out.indexFetches);
    if (!finite(out.position)) out.position = ray.origin;
    return out;
}

int runTrace(const TraceOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<FieldData> field = loadField(options.field);
    if (!field) return fail(field.error());
    const Result<std::vector<Ray>> rays = readRays(options.rays);
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

    std::vector<RayHit> hits(rays->size());
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
                        for (size_t i = begin; i < end; ++i) hits[i] = traceOne(text, (*rays)[i], baseline);
                    });
    }
    const double traceSeconds = tracing.seconds();
    progress("trace", 1.0);
    if (Status status = writeHits(hits, options.output); !status) return fail(status.error());

    size_t counts[3] = {};
    double fetches = 0.0, handoffs = 0.0;
    for (const RayHit& hit : hits)
    {
        ++counts[uint32_t(hit.status)];
        fetches += hit.distanceFetches;
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
        ->check(CLI::IsMember({"ours", "b0plus"}))
        ->type_name("ours|b0plus");
    command->add_flag("--cpu", options->cpu, "Trace on the CPU; it runs the same text as the device (default: on)");
    onChosen(command, context, options, runTrace);
}

} // namespace sconce::tools
