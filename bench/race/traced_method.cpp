#include "bench/race/traced_method.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <functional>
#include <numeric>
#include <sstream>
#include <variant>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/random.h"
#include "bench/opponents/octahedral_field.h"
#include "bench/race/distance_format.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

constexpr double kMebibyte = 1024.0 * 1024.0;

struct Spelled
{
    std::string tracer, file; // tracer is empty when the field is to tell
    std::string knobs;        // of ours, after the slash
    uint32_t lowFactor = 0;
};

/// Sets knobs from NAME:VALUE,...; the field's creation checks their ranges.
Status setKnobs(Tracer& how, const std::string& knobs)
{
    gpu::TraceQuality& quality = how.quality.trace;
    int octahedral = 0;
    const std::pair<std::string_view, std::variant<int*, float*>> known[] = {
        {"ranked", &quality.ranked},         {"maxHandoffs", &quality.maxHandoffs},
        {"startLevel", &quality.startLevel}, {"coarsestLevel", &quality.coarsestLevel},
        {"tolerance", &quality.tolerance},   {"epsilon", &quality.epsilon},
        {"opinion", &quality.opinion},       {"farBounds", &quality.farBounds},
        {"order", &quality.order},           {"octahedral", &octahedral},
        {"distanceBits", &how.distanceBits}};
    std::istringstream list(knobs);
    for (std::string knob; std::getline(list, knob, ',');)
    {
        const size_t colon = std::min(knob.find(':'), knob.size());
        const std::string_view name = std::string_view(knob).substr(0, colon);
        const auto found = std::ranges::find(known, name, [](const auto& entry) { return entry.first; });
        if (found == std::end(known))
            return Error{ErrorCode::badArgument,
                         fmt::format("'{}' is no knob of the tracer; give ranked, maxHandoffs, startLevel, coarsestLevel, tolerance, "
                                     "epsilon, opinion, farBounds, order, octahedral or distanceBits",
                                     name)};
        const char* begin = knob.data() + std::min(colon + 1, knob.size());
        const char* end = knob.data() + knob.size();
        const auto read = std::visit([&](auto* value) { return std::from_chars(begin, end, *value); }, found->second);
        if (begin == end || read.ec != std::errc() || read.ptr != end)
            return Error{ErrorCode::badArgument, fmt::format("'{}' has no number after its colon; write NAME:VALUE", knob)};
    }
    how.octahedral = uint32_t(octahedral);
    return success();
}

Result<Spelled> parse(const std::string& what)
{
    Spelled out{{}, what, {}, 0};
    const size_t equals = what.find('=');
    if (equals == std::string::npos) return out;
    out.tracer = what.substr(0, equals);
    out.file = what.substr(equals + 1);
    if (const size_t slash = out.tracer.find('/'); slash != std::string::npos)
    {
        const std::string factor = out.tracer.substr(slash + 1);
        if (out.tracer.compare(0, slash, "ours") == 0)
        {
            out.tracer.resize(slash);
            out.knobs = factor;
            return out;
        }
        const char* end = factor.data() + factor.size();
        if (std::from_chars(factor.data(), end, out.lowFactor).ptr != end || out.lowFactor == 0)
            return Error{ErrorCode::badArgument, fmt::format("'{}' in '{}' is no low factor; give 8, 16 or 32", factor, what)};
        out.tracer.resize(slash);
    }
    if (out.tracer != "ours" && !baselineNamed(out.tracer))
        return Error{ErrorCode::badArgument, fmt::format("'{}' in '{}' is not ours, b0, b0plus, b0plus-octree or wang", out.tracer, what)};
    return out;
}

} // namespace

Times timesOf(std::vector<double> milliseconds)
{
    assert(!milliseconds.empty());
    std::ranges::sort(milliseconds);
    const auto rank = [&](double share) { return milliseconds[size_t(std::ceil(share * double(milliseconds.size()))) - 1]; };
    return {rank(0.05), rank(0.5), rank(0.95)};
}

std::vector<TracedRay> tracedRays(std::span<const gpu::RayHit> hits)
{
    std::vector<TracedRay> traced;
    traced.reserve(hits.size());
    for (const gpu::RayHit& hit : hits)
        traced.push_back({TraceStatus(hit.status), hit.t, uint32_t(hit.handoffs), uint32_t(hit.distanceReads), uint32_t(hit.indexReads)});
    return traced;
}

std::vector<uint32_t> shuffledOrder(size_t count, uint64_t seed)
{
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    Random random(seed, 0, 0);
    for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(uint32_t(i))]);
    return order;
}

Result<std::unique_ptr<TracedMethod>> TracedMethod::create(Gpu& gpu, FieldData field, const Tracer& how, std::string label)
{
    if (!how.opponent && field.info.chart != gpu::kChartCube)
        return Error{ErrorCode::badInput, "Tracer ours needs cube probes, these are octahedral. Bake with --chart cube."};
    if (how.octahedral != 0 && how.distanceBits != Tracer().distanceBits)
        return Error{ErrorCode::badArgument, "distanceBits is of the texels of cube faces; leave octahedral out, or distanceBits."};
    std::unique_ptr<TracedMethod> made(new TracedMethod(gpu));
    made->label = std::move(label);
    made->how = how;
    Result<FieldData> data = std::move(field);
    if (how.opponent)
        data = baselineField(std::move(*data), *how.opponent, how.lowFactor);
    else if (how.octahedral != 0)
        data = octahedralField(*data, how.octahedral);
    else
        data = narrowedField(std::move(*data), how.distanceBits);
    if (!data) return data.error();
    made->field = std::move(*data);
    auto onDevice = makeLightField(gpu, made->field, how.quality);
    if (!onDevice) return onDevice.error();
    made->onDevice.emplace(std::move(*onDevice));
    auto tracer = makeRayTracer(gpu, *made->onDevice, how.opponent ? traceRaysPass(*how.opponent) : RayShaders());
    if (!tracer) return tracer.error();
    made->tracer.emplace(std::move(*tracer));
    auto timer = GpuTimer::create(gpu, kMostPasses);
    if (!timer) return timer.error();
    made->timer.emplace(std::move(*timer));
    return made;
}

Result<std::unique_ptr<TracedMethod>> TracedMethod::create(Gpu& gpu, const std::string& what)
{
    auto spelled = parse(what);
    if (!spelled) return spelled.error();
    Tracer how;
    how.lowFactor = spelled->lowFactor;
    if (auto status = setKnobs(how, spelled->knobs); !status) return status.error();
    auto data = loadField(spelled->file);
    if (!data) return data.error();
    // Without a name, the tracer that the field was made for.
    if (!spelled->tracer.empty())
        how.opponent = baselineNamed(spelled->tracer);
    else if (data->info.chart == gpu::kChartOctahedral)
        how.opponent = data->info.gridX != 0 ? Baseline::b0Plus : Baseline::b0PlusOctree;
    std::string label = how.opponent ? std::string(baselineName(*how.opponent)) : "ours";
    if (!spelled->knobs.empty()) label.append("/").append(spelled->knobs);
    if (spelled->lowFactor) label += fmt::format("/{}", spelled->lowFactor);
    auto made = create(gpu, std::move(*data), how, std::move(label));
    if (!made) return Error{made.error().code, fmt::format("'{}': {}", spelled->file, made.error().message)};
    (*made)->path = spelled->file;
    return made;
}

double TracedMethod::traceMebibytes() const
{
    uint32_t words = field.info.wordsPerProbe;
    if (!how.opponent && how.quality.trace.farBounds == 0) // they are there, and not read
        words = (how.octahedral != 0 ? 1 : 6) * Pure<float>::chainNearWords(field.info.faceSize, int(field.info.topLevel)) -
                (inBlocks(field.info) ? 6 * Pure<float>::wordsOfBlocksSaved(field.info.faceSize) : 0);
    const double saved = how.opponent ? 0.0 : double(bytesSaved(field, how.distanceBits)) / double(field.info.probeCount);
    return (double(words) * sizeof(uint32_t) - saved) / kMebibyte;
}

FieldBytes TracedMethod::bytes() const
{
    FieldBytes bytes = bytesByPart(field);
    if (!how.opponent) bytes.distance -= bytesSaved(field, how.distanceBits);
    return bytes;
}

double TracedMethod::radianceMebibytes() const
{
    return double(field.radiance.size()) * sizeof(uint32_t) / double(field.info.probeCount) / kMebibyte;
}

bool TracedMethod::startsFarther() const
{
    return how.opponent && baselineOffset(*how.opponent) > 0.0f;
}

std::vector<gpu::Ray> TracedMethod::raysOf(const RaySet& set) const
{
    // Opponents' rays start farther off their surface; ours need no more than the set's own distance.
    const float offset = how.opponent ? baselineOffset(*how.opponent) : 0.0f;
    std::vector<gpu::Ray> rays(set.size());
    for (size_t i = 0; i < rays.size(); ++i) rays[i] = {set.origins[i] + offset * set.normals[i], set.directions[i], set.normals[i]};
    return rays;
}

Result<TraceScore> TracedMethod::score(const RaySet& set)
{
    std::vector<gpu::RayHit> hits(set.size());
    if (auto status = trace(raysOf(set), hits); !status) return status.error();
    return scoreTraces(set, tracedRays(hits), startsFarther());
}

void TracedMethod::traceOnCpu(std::span<const gpu::Ray> rays, std::span<gpu::RayHit> hits) const
{
    if (how.opponent)
    {
        traceBaselineOnCpu(field, *how.opponent, rays, hits);
        return;
    }
    constexpr size_t kBatch = 1024;
    parallelFor((rays.size() + kBatch - 1) / kBatch,
                [&](size_t batch)
                {
                    twin::LightFieldTwin<float> text(field, how.quality.trace);
                    for (size_t i = batch * kBatch; i < std::min(rays.size(), (batch + 1) * kBatch); ++i)
                        hits[i] = text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
                });
}

Status TracedMethod::prepare(std::span<const gpu::Ray> rays, std::span<const uint32_t> order)
{
    assert(rays.size() == order.size() && rays.size() <= (size_t(1) << 18));
    timedRays = uint32_t(rays.size());
    // Both orders stand on the device before any time is taken: uploads are no part of a run.
    std::vector<gpu::Ray> shuffled(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) shuffled[i] = rays[order[i]];
    auto first = gpu.makeBufferWith<gpu::Ray>(rays, 0, "rays");
    if (!first) return first.error();
    orderedRays = std::move(*first);
    auto second = gpu.makeBufferWith<gpu::Ray>(shuffled, 0, "shuffled rays");
    if (!second) return second.error();
    shuffledRays = std::move(*second);
    auto answers = gpu.makeBuffer(rays.size() * sizeof(gpu::RayHit), 0, MemoryUse::device, "ray hits");
    if (!answers) return answers.error();
    hitBuffer = std::move(*answers);
    return success();
}

Result<double> TracedMethod::time(bool inOrder)
{
    uint32_t& passes = inOrder ? orderedPasses : shuffledPasses;
    for (;;)
    {
        const auto all = timePasses(inOrder ? orderedRays : shuffledRays, passes);
        if (!all) return all.error();
        if (*all >= kLeastTimed || passes >= kMostPasses) return *all / passes;
        // A fifth more than it seems to take, so that a second try is enough.
        const double wanted = *all > 0.0 ? std::ceil(1.2 * kLeastTimed / *all * passes) : double(kMostPasses);
        passes = uint32_t(std::clamp(wanted, passes + 1.0, double(kMostPasses)));
    }
}

Status TracedMethod::writeBetween(uint64_t bytes)
{
    between = Buffer();
    orderedPasses = shuffledPasses = 1;
    if (bytes == 0) return success();
    auto made = gpu.makeBuffer(bytes, 0, MemoryUse::device, "memory written between passes");
    if (!made) return made.error();
    between = std::move(*made);
    return success();
}

void TracedMethod::recordPasses(VkCommandBuffer cmd, const Buffer& rays, uint32_t passes)
{
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, fill = VK_PIPELINE_STAGE_2_CLEAR_BIT;
    timer->reset(cmd);
    if (!between) timer->begin(cmd, "trace");
    for (uint32_t pass = 0; pass < passes; ++pass)
    {
        if (pass > 0)
            memoryBarrier(gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, compute | fill,
                          VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
        if (between)
        {
            gpu.vk.CmdFillBuffer(cmd, between.handle(), 0, VK_WHOLE_SIZE, pass);
            memoryBarrier(gpu, cmd, fill, VK_ACCESS_2_TRANSFER_WRITE_BIT, compute | fill,
                          VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
            timer->begin(cmd, "trace");
        }
        recordTrace(*tracer, cmd, rays, hitBuffer, timedRays);
        if (between) timer->end(cmd);
    }
    if (!between) timer->end(cmd);
}

Result<double> TracedMethod::timePasses(const Buffer& rays, uint32_t passes)
{
    auto status = gpu.submit([&](VkCommandBuffer cmd) { recordPasses(cmd, rays, passes); });
    if (!status) return status.error();
    const std::vector<GpuTimer::Scope> scopes = timer->read();
    if (scopes.empty()) return Error{ErrorCode::missingFeature, "this device's queue has no timestamps; times need them"};
    return std::transform_reduce(scopes.begin(), scopes.end(), 0.0, std::plus<>(), [](const GpuTimer::Scope& s) { return s.milliseconds; });
}

} // namespace sconce
