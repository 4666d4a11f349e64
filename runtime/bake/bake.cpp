#include "runtime/bake/bake.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/limits.h"
#include "base/numbers.h"
#include "base/parallel.h"
#include "runtime/bake/bake_key.h"
#include "runtime/bake/bake_parts.h"
#include "runtime/bake/counted_rays.h"
#include "runtime/bake/drawn_faces.h"
#include "runtime/bake/host_memory.h"
#include "runtime/bake/lamps.h"
#include "runtime/bake/patches.h"
#include "runtime/bake/prefilter.h"
#include "runtime/bake/probe_baker.h"
#include "runtime/bake/probe_clearance.h"
#include "runtime/bake/surface_baker.h"
#include "runtime/field/field_space.h"
#include "runtime/field/map_blocks.h"
#include "runtime/field/octree_builder.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/pure.h"

namespace sconce
{

namespace
{

class Stopwatch
{
public:
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last).count();
        last = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
};

static_assert(knobs::kCharts[gpu::kChartCube] == "cube" && knobs::kCharts[gpu::kChartOctahedral] == "octahedral");

std::string argumentFault(std::span<const vec3> probes, const BakeSettings& settings)
{
    if (settings.chart != gpu::kChartCube && settings.chart != gpu::kChartOctahedral)
        return fmt::format("chart is {}; give kChartCube or kChartOctahedral", settings.chart);
    const bool even = settings.resolution % (settings.chart == gpu::kChartCube ? 32 : 16) == 0; // whole cells of two levels of the chain
    if (const std::string fault = faultOf(knobs::resolution, settings.resolution); !fault.empty()) return fault;
    if (!even) return knob_words::fault(knobs::resolution.name, knobText(settings.resolution), rangeText(knobs::resolution));
    if (!settings.scene.light.areaShadows)
        return "scene.light.areaShadows is false; leave it true: the bake shadows emitters and sky by their maps";
    const std::string fault =
        firstFault({faultOf(knobs::bounces, settings.bounces), faultOf(knobs::converged, settings.converged),
                    faultOf(knobs::surfaceTexels, settings.surfaceTexels), faultOf(knobs::surfaceRays, settings.surfaceRays),
                    faultOf(knobs::surfaceRefined, settings.surfaceRefined), faultOf(knobs::lampTexels, settings.lampTexels),
                    faultOf(knobs::liveLinks, settings.liveLinks), faultOf(knobs::submissionMs, settings.submissionMs)});
    if (!fault.empty()) return fault;
    if (settings.faces && settings.journal)
        return "what a host draws is no part of a journal's key; bake without a journal, or let the bake draw the scene";
    if (settings.compact && settings.chart != gpu::kChartCube)
        return "compact maps are of cube faces, and these are octahedral; leave compact false";
    if (probes.empty() || probes.size() > kMostProbes)
        return fmt::format("there are {} probes; give between 1 and {}", probes.size(), kMostProbes);
    for (size_t i = 0; i < probes.size(); ++i)
        if (!std::isfinite(probes[i].x + probes[i].y + probes[i].z))
            return fmt::format("probe {} has a position that is not finite; mend the list of probes", i);
    if (settings.grid &&
        (glm::any(glm::lessThan(settings.grid->count, glm::ivec3(1))) ||
         size_t(settings.grid->count.x) * size_t(settings.grid->count.y) * size_t(settings.grid->count.z) != probes.size()))
        return fmt::format("the grid has {}x{}x{} probes but there are {}", settings.grid->count.x, settings.grid->count.y,
                           settings.grid->count.z, probes.size());
    return {};
}

std::string shardFault(const BakeSettings& settings, const BakeShard& shard)
{
    if (!settings.journal) return "a shard is kept in a journal, and there is none; give BakeSettings::journal";
    if (shard.count == 0 || shard.count > kMostShards || shard.index >= shard.count)
        return fmt::format("there is no shard {} of {}; give 1 to {} shards, and count from 0", shard.index, shard.count, kMostShards);
    if (shard.stage != BakeStage::maps && shard.stage != BakeStage::gather)
        return fmt::format("stage {} goes not probe by probe; give maps or gather", uint32_t(shard.stage));
    const bool gathers = surfaceSizeOf(settings.chart, chartSize(settings.chart, settings.resolution), settings.surfaceTexels) > 0;
    if (settings.light || (shard.stage == BakeStage::gather && !gathers))
        return "nothing is gathered where there is no surface light, or another field lends it; shard the maps alone, of cube faces";
    return {};
}

/// What surface light can't be made of: links (bake_passes.h) name no more texels than their bits, and rays of another scene would light
/// this one.
std::string surfaceFault(const gpu::LightFieldInfo& info, const Scene& scene, const BakeSettings& settings)
{
    const uint64_t texels = 6ull * info.surfaceSize * info.surfaceSize * info.probeCount, most = 1ull << gpu::kLinkTexelBits;
    if (texels > most)
        return fmt::format("surface light of {} probes has {} texels, and it may have {}; give fewer probes or fewer surface texels",
                           info.probeCount, texels, most);
    if (settings.rays && settings.rays->scene().triangles.size() != scene.triangles.size())
        return fmt::format("the rays are of a scene of {} triangles, and that which is baked has {}; give rays of the same scene",
                           settings.rays->scene().triangles.size(), scene.triangles.size());
    return {};
}

/// Why another field's light can't be lent to one in this space with these probes; empty where it can.
std::string lentFault(const FieldData& light, const gpu::LightFieldInfo& info, std::span<const gpu::ProbeHeader> probes)
{
    if (light.surfaceLight.empty() || !light.lamps.empty())
        return "the field that lends its light holds no surface light, or lamps beside it; bake it with surface texels and without lamps";
    const bool samePlaces = light.info.origin == info.origin && light.info.scale == info.scale &&
                            std::ranges::equal(light.probes, probes, {}, &gpu::ProbeHeader::centre, &gpu::ProbeHeader::centre);
    if (samePlaces) return {};
    return fmt::format("the field that lends its light has {} probes, not the {} at the same places that are baked; bake it of the same "
                       "scene and probes",
                       light.probes.size(), probes.size());
}

/// The cube faces' level 0 words at half their size, each from the plane of one of its four texels, with their chain: what summaries and
/// octree of an octahedral field are made from.
void halveFaces(std::span<const uint32_t> faces, uint32_t size, const gpu::LightFieldInfo& half, uint32_t* out)
{
    using Text = Pure<float>;
    for (uint32_t face = 0; face < 6; ++face)
    {
        uint32_t* words = out + size_t(face) * (half.wordsPerProbe / 6);
        for (uint32_t y = 0; y < half.faceSize; ++y)
            for (uint32_t x = 0; x < half.faceSize; ++x)
            {
                const uint32_t word = faces[(size_t(face) * size + 2 * y) * size + 2 * x];
                const float gx = Text::unpackGradient(word >> 16), gy = Text::unpackGradient(word >> 24);
                const float change = std::max(1.0f + 0.5f * gx + 0.5f * gy, 0.5f);
                words[y * half.faceSize + x] =
                    (word & 0xffffu) ? Text::packTexel(Text::halfToReal(word) * change, 2.0f * gx / change, 2.0f * gy / change) : 0;
            }
        buildChain(words, half.faceSize);
    }
}

void setChart(gpu::LightFieldInfo& info, uint32_t chart, uint32_t size)
{
    info.chart = chart;
    info.faceSize = size;
    info.topLevel = chart == gpu::kChartCube ? coarsestLevel(size) : 0;
    info.wordsPerProbe = distanceWordsPerProbe(chart, size);
}

/// Mean radiance over all probes and directions, luminance (Rec. 709 weights).
double meanRadiance(const FieldData& field)
{
    const uint32_t n = field.info.faceSize, faces = field.info.chart == gpu::kChartCube ? 6 : 1;
    std::vector<double> solidAngle(size_t(n) * n), sums(field.probes.size());
    double all = 0.0;
    for (uint32_t i = 0; i < n * n; ++i)
    {
        const glm::vec2 uv = (glm::vec2(i % n, i / n) + 0.5f) / float(n);
        const glm::vec3 d = faces == 6 ? glm::normalize(glm::vec3(2.0f * uv - 1.0f, 1.0f)) : Pure<float>::directionFromOctahedral(uv);
        const double off = faces == 6 ? d.z : std::abs(d.x) + std::abs(d.y) + std::abs(d.z); // 1 / distance of the chart's point
        solidAngle[i] = off * off * off;
        all += solidAngle[i] * faces;
    }
    parallelFor(field.probes.size(),
                [&](size_t probe)
                {
                    twin::LightFieldTwin<float> text(field, {});
                    const size_t first = probe * faces * n * n;
                    for (size_t i = 0; i < size_t(faces) * n * n; ++i)
                    {
                        const glm::vec3 light = text.unpackRadiance(field.radiance[first + i]);
                        sums[probe] += solidAngle[i % (size_t(n) * n)] * glm::dot(light, kLuminance);
                    }
                });
    return std::accumulate(sums.begin(), sums.end(), 0.0) / (all * double(field.probes.size()));
}

/// Refuses what would take more main memory than there is, while nothing is taken.
Status fitsTheHost(const FieldData& field, const BakeSettings& settings, bool emitters, bool deviceIsHost)
{
    const gpu::LightFieldInfo& info = field.info;
    const bool octahedral = info.chart == gpu::kChartOctahedral;
    const uint64_t distance = info.wordsPerProbe, cube = octahedral ? distanceWordsPerProbe(gpu::kChartCube, info.faceSize / 2) : 0;
    const uint64_t light = radianceWordsPerProbe(info.chart, info.faceSize); // radiance, surfaces, direct light, emission
    // The octree is built from a copy of all maps on the device, which for a software device is main memory again.
    const uint64_t texels = 6ull * info.surfaceSize * info.surfaceSize; // of surface light: links, what bounces need, the light itself
    const uint64_t tilts = info.surfaceDirections != 0 ? 6 : 0;         // words a texel
    const uint64_t cells = texels > 0 && settings.rays ? 6 * kCellsOfProbe : 0;       // facings; their links stay here
    const uint64_t onDevice = 11 + gpu::kSentKept + gpu::kReflectionsCounted + tilts; // words a texel
    const uint64_t surface =
        texels * (settings.surfaceRays + 4 + gpu::kReflectionsCounted + (deviceIsHost ? onDevice : 0)) + cells * settings.surfaceRays;
    // Beside it: the light of all groups, and live light's links, at texels and at places of cells and hidden surfaces.
    const uint64_t each = light + kIrradianceWordsPerProbe + gpu::kPrefilteredWords + texels;
    const uint64_t apart =
        settings.layout ? settings.layout->groups * each + settings.layout->liveLinks * (texels + 12 * kCellsOfProbe) : 0;
    const uint64_t words = apart + (deviceIsHost ? 2 : 1) * (distance + cube) + (settings.bounces > 0 || surface > 0 ? 3 : 2) * light +
                           (emitters ? light : 0) + surface;
    const uint64_t needed = 4 * words * field.probes.size(), allowed = settings.hostMemory > 0 ? settings.hostMemory : freeHostBytes();
    if (needed <= allowed) return success();
    return Error{ErrorCode::outOfMemory, fmt::format("A bake of {} probes with maps of {} texels takes about {} MiB of main memory, and it "
                                                     "may have {} MiB; give fewer probes or a lower resolution",
                                                     field.probes.size(), settings.resolution, needed >> 20, allowed >> 20)};
}

/// A bake in progress: the field and what the bounces need besides.
struct Bake
{
    PacedWork& work; // of the device
    FieldData field;
    FieldData cube;                                  // octahedral chart: the cube faces that octree and summaries are made from
    std::vector<uint32_t> surfaces, direct, emitted; // emitted is empty when the scene has no emitters
    std::vector<gpu::SurfaceTexel> texels;           // empty without surface light
    const Progress& progress;
    BakeParts parts;                  // of it, that are kept
    const BakeShard* shard = nullptr; // null: all of it

    bool octahedral() const { return field.info.chart == gpu::kChartOctahedral; }

    ProbeTarget target(size_t probe)
    {
        const size_t words = field.info.wordsPerProbe, light = radianceWordsPerProbe(field.info.chart, field.info.faceSize);
        const size_t irradiance = kIrradianceWordsPerProbe, points = texels.size() / field.probes.size();
        return {std::span(field.distance).subspan(probe * words, words),
                std::span(field.radiance).subspan(probe * light, light),
                std::span(surfaces).subspan(probe * light, light),
                emitted.empty() ? std::span<uint32_t>() : std::span(emitted).subspan(probe * light, light),
                std::span(field.irradiance).subspan(probe * irradiance, irradiance),
                {},
                std::span(texels).subspan(probe * points, points)};
    }

    /// The faces that octree and summaries are made from; empty where they are the probe's own.
    std::span<uint32_t> cubeOf(size_t probe)
    {
        const size_t words = octahedral() ? cube.info.wordsPerProbe : 0;
        return words == 0 ? std::span<uint32_t>() : std::span(cube.distance).subspan(probe * words, words);
    }

    Status cancelledIfAsked(std::string_view stage, size_t done, size_t count) const
    {
        if (report(progress, stage, double(done) / double(count))) return success();
        return Error{ErrorCode::cancelled, fmt::format("The bake was stopped at {}, {} of {}", stage, done, count)};
    }

    /// The field's space, its probes and what it will hold: before all else, for probes, scene and octree are on the device in its units.
    Status describe(const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings, BakeReport& spent);
    void takeRoom(bool emitters);
    Status finish(const BakeSettings& settings);
    bool does(BakeStage stage, size_t probe) const { return !shard || (shard->stage == stage && shard->has(probe)); }
    bool takeMaps(size_t probe);
    Status bakeMaps(ProbeBaker& baker, const BakeSettings& settings, size_t probe);
    Status directLight(ProbeBaker& baker, const BakeSettings& settings);
    Status index(Gpu& gpu, const OctreeSettings& settings, bool& onDevice);
    Result<LightField> asItIs(Gpu& gpu);
    Status reflect(const LightField& lit, ProbeBaker& baker, const std::string& stage);
    Status bounces(Gpu& gpu, ProbeBaker& baker, const BakeSettings& settings, BakeReport& spent);
    Status surfaceLight(Gpu& gpu, const DeviceScene& scene, ProbeBaker& baker, const BakeSettings& settings, BakeReport& spent);
    Status gather(SurfaceBaker& of);
    std::vector<uint32_t> coarserAlbedo() const;
    Status lentLight(Gpu& gpu, ProbeBaker& baker, const FieldData& light, BakeReport& spent);
};

bool Bake::takeMaps(size_t probe)
{
    const ProbeTarget to = target(probe);
    return parts.take(BakeStage::maps, uint32_t(probe),
                      {asWritableBytes(to.distance), asWritableBytes(to.radiance), asWritableBytes(to.surface), asWritableBytes(to.emitted),
                       asWritableBytes(to.irradiance), asWritableBytes(to.texels), asWritableBytes(cubeOf(probe))});
}

Status Bake::bakeMaps(ProbeBaker& baker, const BakeSettings& settings, size_t probe)
{
    std::vector<uint32_t> faces(octahedral() ? size_t(6) * field.info.faceSize * field.info.faceSize : 0);
    ProbeTarget to = target(probe);
    to.faces = faces;
    const vec3 centre = field.probes[probe].centre;
    if (auto status = baker.bakeDirect(uint32_t(probe), centre, to); !status) return status;
    if (settings.faces && settings.rays)
    {
        const uint32_t size = field.info.faceSize;
        const std::string fault =
            octahedral()
                ? faultOfDrawn(*settings.rays, field.info, centre, uint32_t(probe), faces, size, size_t(size) * size)
                : faultOfDrawn(*settings.rays, field.info, centre, uint32_t(probe), to.distance, size, field.info.wordsPerProbe / 6);
        if (!fault.empty()) return Error{ErrorCode::badInput, fmt::format("Bake: {}", fault)};
    }
    if (octahedral()) halveFaces(faces, field.info.faceSize, cube.info, cubeOf(probe).data());
    return parts.keep(BakeStage::maps, uint32_t(probe),
                      {asBytes(to.distance), asBytes(to.radiance), asBytes(to.surface), asBytes(to.emitted), asBytes(to.irradiance),
                       asBytes(to.texels), asBytes(cubeOf(probe))});
}

Status Bake::directLight(ProbeBaker& baker, const BakeSettings& settings)
{
    for (size_t i = 0; i < field.probes.size(); ++i)
    {
        if (shard && shard->stage == BakeStage::maps && !shard->has(i)) continue;
        if (auto status = cancelledIfAsked("probes", i, field.probes.size()); !status) return status;
        if (takeMaps(i)) continue;
        if (!does(BakeStage::maps, i))
            return Error{
                ErrorCode::badInput,
                fmt::format("The maps of probe {} of {} are in no part; give the parts of all shards of the maps", i, field.probes.size())};
        if (auto status = bakeMaps(baker, settings, i); !status) return status;
    }
    return success();
}

Status Bake::index(Gpu& gpu, const OctreeSettings& settings, bool& onDevice)
{
    FieldData& seen = octahedral() ? cube : field;
    std::optional<BakeParts::Index> kept = parts.takeIndex(seen.probes);
    if (!kept)
    {
        parallelFor(seen.probes.size(), [&](size_t i) { summariseProbe(seen, i); });
        const ProbeMaps maps{seen.info, seen.probes, seen.distance};
        auto octree = buildOctreeOnDevice(gpu, work, maps, settings, progress);
        const bool there = bool(octree);
        // All maps at once may be more than the device has beside the scene; the host gives the same bytes.
        if (!octree && octree.error().code == ErrorCode::outOfMemory) octree = buildOctree(maps, settings, progress);
        if (!octree) return octree.error();
        if (auto status = parts.keepIndex(*octree, there, seen.probes); !status) return status;
        kept = {std::move(*octree), there};
    }
    onDevice = kept->onDevice;
    if (octahedral()) field.probes = cube.probes;
    cube = FieldData();
    attachOctree(field, kept->octree);
    return success();
}

/// The whole field as it is now, on the device, so that the order of the probes doesn't matter. Without radiance: a bounce reads irradiance
/// and what weighs it, or surface light, and the device has only that to hold.
Result<LightField> Bake::asItIs(Gpu& gpu)
{
    FieldData lit;
    lit.info = field.info;
    lit.probes = field.probes;
    lit.octree = field.octree;
    lit.irradiance = field.irradiance;
    lit.surfaceLight = field.surfaceLight;
    lit.lamps = field.lamps;
    lit.lampMaps = field.lampMaps;
    lit.distance = std::move(field.distance); // tells which probes a wall hides; lent, since it is half of the field
    auto device = makeLightField(gpu, lit);
    field.distance = std::move(lit.distance);
    return device;
}

/// Every probe's radiance: its direct light and what its surfaces reflect of the field's.
Status Bake::reflect(const LightField& lit, ProbeBaker& baker, const std::string& stage)
{
    const size_t words = radianceWordsPerProbe(field.info.chart, field.info.faceSize);
    for (size_t i = 0; i < field.probes.size(); ++i)
    {
        if (auto status = cancelledIfAsked(stage, i, field.probes.size()); !status) return status;
        const std::span<const uint32_t> own = std::span(direct).subspan(i * words, words);
        auto status = baker.bakeBounce(uint32_t(i), field.probes[i].centre, lit, own, target(i));
        if (!status) return status;
    }
    return success();
}

/// Bounces by the probes' own irradiance. Their number is a bound: each costs a gather a texel, and one that adds next to nothing is the
/// last.
Status Bake::bounces(Gpu& gpu, ProbeBaker& baker, const BakeSettings& settings, BakeReport& spent)
{
    double energy = spent.energy.back();
    for (uint32_t b = 1; b <= settings.bounces; ++b)
    {
        auto lit = asItIs(gpu);
        if (!lit) return lit.error();
        if (auto status = reflect(*lit, baker, fmt::format("bounce {}", b)); !status) return status;
        const double with = meanRadiance(field);
        spent.energy.push_back(with - energy);
        field.bounces = b;
        energy = with;
        if (spent.energy.back() < double(settings.converged) * with) break;
    }
    return success();
}

Status Bake::gather(SurfaceBaker& of)
{
    for (size_t i = 0; i < field.probes.size(); ++i)
    {
        if (!does(BakeStage::gather, i)) continue;
        if (auto status = cancelledIfAsked("surface light", i, field.probes.size()); !status) return status;
        if (auto status = of.gather(uint32_t(i)); !status) return status;
    }
    if (!does(BakeStage::gather, 0)) return success();
    if (auto status = cancelledIfAsked("light in the open", 0, 1); !status) return status;
    return of.findCells();
}

/// Light at the surfaces that probes see, and the probes' radiance of it.
Status Bake::surfaceLight(Gpu& gpu, const DeviceScene& scene, ProbeBaker& baker, const BakeSettings& settings, BakeReport& spent)
{
    Stopwatch watch;
    auto dark = asItIs(gpu);
    if (!dark) return dark.error();
    const uint32_t shadowRays = std::min(settings.surfaceRays, gpu::kMostShadowRays);
    const bool live = settings.rays && settings.layout && settings.layout->liveLinks > 0 && settings.layout->live.links == 0;
    std::optional<TriangleGather> exact;
    std::optional<CountedRays> counted;
    if (settings.rays)
        exact.emplace(counted.emplace(*settings.rays), field, texels, scene.lights(),
                      TriangleGather::Desc{settings.surfaceRays, shadowRays});
    auto gatherer = SurfaceBaker::create(
        gpu, scene, *dark, texels,
        {settings.surfaceRays, shadowRays, knobs::normalOffset.value * field.info.diagonal, exact ? &*exact : nullptr, live, parts, &work});
    if (!gatherer) return gatherer.error();
    if (auto status = gather(*gatherer); !status) return status;
    spent.gatherSeconds = watch.lap();
    if (shard) return success();
    // What surfaces send of direct light is in the probes' radiance already; so the light without a bounce adds only what it sends besides.
    auto before = gatherer->meanSent();
    for (uint32_t b = 0; before && b <= settings.bounces; ++b)
    {
        if (auto status = cancelledIfAsked(fmt::format("bounce {}", b), 0, 1); !status) return status;
        if (auto status = gatherer->bounce(); !status) return status;
        const auto sent = gatherer->meanSent();
        if (!sent) return sent.error();
        const double added = *sent - *before;
        before = sent;
        if (b == 0)
        {
            spent.energy.back() += added;
            continue;
        }
        spent.energy.push_back(added);
        field.bounces = b;
        if (added < double(settings.converged) * *sent) break;
    }
    if (!before) return before.error();
    field.surfaceLight.resize(surfaceTexelWords(field.info) + cellWords(field.info));
    if (auto status = gatherer->read(field.surfaceLight); !status) return status;
    auto lit = asItIs(gpu);
    if (!lit) return lit.error();
    if (auto status = reflect(*lit, baker, "radiance"); !status) return status;
    // What arrives at a surface has been scattered once less than what it sends: once more, so that frames show as many bounces by either.
    if (auto status = gatherer->bounce(); !status) return status;
    if (auto status = gatherer->read(field.surfaceLight); !status) return status;
    if (auto status = cancelledIfAsked("refined texels", 0, 1); !status) return status;
    if (auto status = gatherer->refine(field, settings.surfaceRefined, settings.layout); !status) return status;
    if (counted) spent.gatherRays = counted->count();
    if (!live) return success();
    settings.layout->live = gatherer->transport(field, settings.layout->liveLinks, *settings.layout->hidden);
    settings.layout->live.albedo = coarserAlbedo();
    return success();
}

/// LiveTransport::albedo: the mean of four texels, sky left out.
std::vector<uint32_t> Bake::coarserAlbedo() const
{
    const size_t side = field.info.faceSize / 2, fine = field.info.faceSize, rows = 6 * side * field.probes.size();
    std::vector<uint32_t> words((rows * side + 1) / 2);
    parallelFor(rows / 2, // so that no two write to one word
                [&](size_t pair)
                {
                    for (size_t texel = 2 * pair * side; texel < 2 * (pair + 1) * side; ++texel)
                    {
                        const size_t x = texel % side, row = texel / side;
                        vec3 sum(0.0f);
                        float count = 0.0f;
                        for (const size_t at : {2 * row * fine + 2 * x, 2 * row * fine + 2 * x + 1, (2 * row + 1) * fine + 2 * x,
                                                (2 * row + 1) * fine + 2 * x + 1})
                        {
                            const uint32_t bits = surfaces[at];
                            if (bits == 0) continue;
                            sum += vec3(bits & 31u, bits >> 5 & 63u, bits >> 11 & 31u);
                            count += 1.0f;
                        }
                        const glm::uvec3 mean(sum / std::max(count, 1.0f) + 0.5f);
                        words[texel / 2] |= (mean.x | mean.y << 5 | mean.z << 11) << (16 * (texel & 1));
                    }
                });
    return words;
}

/// The probes' radiance of what their surfaces reflect of light that another field holds.
Status Bake::lentLight(Gpu& gpu, ProbeBaker& baker, const FieldData& light, BakeReport& spent)
{
    auto lit = makeLightField(gpu, light);
    if (!lit) return lit.error();
    if (auto status = reflect(*lit, baker, "radiance"); !status) return status;
    spent.energy.push_back(meanRadiance(field) - spent.energy.back());
    field.bounces = light.bounces;
    return success();
}

Status Bake::describe(const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings, BakeReport& spent)
{
    const auto refused = [](const std::string& fault) { return Error{ErrorCode::badArgument, fmt::format("Bake: {}", fault)}; };
    if (const std::string fault = argumentFault(probes, settings); !fault.empty()) return refused(fault);
    if (scene.triangles.empty())
        return Error{ErrorCode::badInput, fmt::format("The scene '{}' has no triangles; there is nothing to bake", scene.name)};
    if (const std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, fault};
    gpu::LightFieldInfo& info = field.info;
    info = fieldSpace(scene.bounds());
    info.sky = scene.sky;
    info.probeCount = uint32_t(probes.size());
    setChart(info, settings.chart, chartSize(settings.chart, settings.resolution));
    info.surfaceSize = settings.light ? 0 : surfaceSizeOf(info.chart, info.faceSize, settings.surfaceTexels);
    info.surfaceDirections = info.surfaceSize > 0 && hasNormalTextures(scene) ? 1 : 0;
    if (const std::string fault = surfaceFault(info, scene, settings); !fault.empty()) return refused(fault);
    if (settings.grid)
    {
        info.gridX = uint32_t(settings.grid->count.x);
        info.gridY = uint32_t(settings.grid->count.y);
        info.gridZ = uint32_t(settings.grid->count.z);
        info.gridOrigin = (settings.grid->origin - info.origin) / info.scale;
        info.gridStep = settings.grid->step / info.scale;
    }
    field.resolution = settings.resolution;
    field.sceneName = scene.name;
    field.effects = settings.effects;
    field.probes.resize(probes.size());
    // A grid is looked up by its formula: its probes stay.
    // Others stand two near planes off: what is nearer than that plane isn't drawn, and its corners are 1.73 times as far away as its
    // middle.
    const ClearedProbes cleared = clearedOfSurfaces(scene, probes, settings.grid ? 0.0f : 2.0f * kProbeNear * info.diagonal * info.scale);
    spent.moved = cleared.moved;
    spent.tight = cleared.tight;
    for (size_t i = 0; i < probes.size(); ++i) field.probes[i].centre = (cleared.positions[i] - info.origin) / info.scale;
    if (settings.light)
        if (const std::string fault = lentFault(*settings.light, info, field.probes); !fault.empty()) return refused(fault);
    return success();
}

void Bake::takeRoom(bool emitters)
{
    const gpu::LightFieldInfo& info = field.info;
    const size_t count = field.probes.size(), light = count * radianceWordsPerProbe(info.chart, info.faceSize);
    field.distance.resize(count * info.wordsPerProbe);
    field.radiance.resize(light);
    surfaces.resize(light);
    if (emitters) emitted.resize(light);
    field.irradiance.resize(count * kIrradianceWordsPerProbe);
    texels.resize(size_t(6) * info.surfaceSize * info.surfaceSize * count);
    if (!octahedral()) return;
    // Octree and summaries are made from cube faces, of which an octahedral field keeps none.
    cube.info = info;
    setChart(cube.info, gpu::kChartCube, info.faceSize / 2);
    cube.probes = field.probes;
    cube.distance.resize(count * cube.info.wordsPerProbe);
}

void dropSurfaceLight(FieldData& field)
{
    field.surfaceLight = {};
    field.info.surfaceSize = field.info.surfaceDirections = field.info.refinedTexels = field.info.hidden = 0;
    field.info.cellShift = 0;
}

/// What is made from the light of the last bounce; only then may the radiance go that it is made from.
Status Bake::finish(const BakeSettings& settings)
{
    if (field.info.surfaceSize == 0) makePatches(field, surfaces, emitted);
    if (settings.prefiltered) prefilterRadiance(field);
    if (!settings.radiance) field.radiance = {};
    if (settings.compact)
    {
        // Not asked for any more, and more than blocks take: what was counted to fit is enough.
        for (std::vector<uint32_t>* words : {&surfaces, &direct, &emitted}) std::vector<uint32_t>().swap(*words);
        if (auto status = putInBlocks(field); !status) return status;
    }
    // Where no frame reads it, it was made for what surfaces send to mirrors alone.
    if (!settings.readsSurfaces && !settings.layout && field.lamps.empty()) dropSurfaceLight(field);
    return success();
}

} // namespace

void BakeSettings::take(const EffectPlan& plan, bool tracedDiffuse)
{
    radiance = plan.needsRadiance() || (tracedDiffuse && plan.on("diffuse"));
    prefiltered = plan.needsPrefiltered() || !radiance; // a traced ray's colour, when someone asks for one
    readsSurfaces = plan.on("diffuse") || plan.on("rough");
    for (const PlannedEffect& effect : plan.effects)
        if (effect.on) effects.push_back(effect.name);
}

BakeSettings lendingBake(BakeSettings settings)
{
    settings.chart = gpu::kChartCube;
    settings.resolution = (settings.resolution + 31) / 32 * 32; // of cube faces
    settings.lampTexels = 0;
    settings.bounces = std::max(settings.bounces, 1u) - 1; // frames see its light scattered once more than its own maps do
    settings.radiance = settings.prefiltered = settings.compact = false;
    return settings;
}

namespace
{

/// @param shard  that is baked; null: all of it
/// @return  of a shard, a field that lacks what the others do
Result<FieldData> bakeAll(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings, const BakeShard* shard,
                          const Progress& progress, BakeReport& bakeReport)
{
    PacedWork work(gpu, 1e-3 * double(settings.submissionMs));
    Bake bake{work, {}, {}, {}, {}, {}, {}, progress, {}, shard};
    BakeReport spent;
    Stopwatch watch;
    if (auto status = bake.describe(scene, probes, settings, spent); !status) return status.error();
    gpu::LightFieldInfo& info = bake.field.info;
    const bool surfaceLight = info.surfaceSize > 0 || settings.light;
    const auto finished = [&](const BakeReport& done)
    {
        bakeReport = done;
        return Result<FieldData>(std::move(bake.field));
    };

    const uint64_t heldBefore = gpu.memory().restartPeak();
    gpu.restartLongest();
    {
        Lamps lamps; // which needs no device
        if (info.surfaceSize > 0 && settings.rays && settings.lampTexels > 0)
            lamps = lampsIn(scene, settings.layout && settings.layout->lamps // the rays' scene may shine more
                                       ? *settings.layout->lamps
                                       : findLamps(*settings.rays, info, bake.field.probes, settings.lampTexels));
        if (settings.layout && !settings.layout->lamps) settings.layout->lamps = lamps;
        bake.field.lamps = std::move(lamps.lamps);
        bake.field.lampMaps = std::move(lamps.maps);
        DeviceSceneDesc sceneDesc = settings.scene;
        if (surfaceLight) // emitters are shadowed by rays, and rays find the sky
            sceneDesc.light = {
                .emitterSamples = kTracedLightSamples, .skySamples = 0, .areaShadows = false, .lamps = std::move(lamps.triangles)};
        auto deviceScene = DeviceScene::create(gpu, scene, info, sceneDesc, progress);
        if (!deviceScene) return deviceScene.error();
        // By the layout as this bake found it, with its lamps: for each it is another key, and for each next one the same.
        if (settings.journal) bake.parts = {settings.journal, bakeKey(scene, probes, settings)};
        auto baker = ProbeBaker::create(gpu, *deviceScene, info, surfaceLight, surfaceLight && (settings.rays || settings.light),
                                        settings.faces, work);
        if (!baker) return baker.error();
        spent.lights = uint32_t(deviceScene->lights().lights.size());
        spent.sceneSeconds = watch.lap();

        // Not before the scene is on the device: only its list of lights tells whether maps of emission are needed, which count.
        const bool emitters = deviceScene->lights().shines;
        const bool deviceIsHost = gpu.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        if (auto status = fitsTheHost(bake.field, settings, emitters, deviceIsHost); !status) return status.error();
        bake.takeRoom(emitters);
        if (auto status = bake.directLight(**baker, settings); !status) return status.error();
        spent.probeSeconds = watch.lap();
        if (shard && shard->stage == BakeStage::maps) return finished(spent);
        // The bounces find their probes by the octree, so it comes before them.
        if (auto status = bake.index(gpu, settings.octree, spent.octreeOnDevice); !status) return status.error();
        if (info.surfaceSize > 0) info.cellShift = cellShiftOf(info);
        spent.octreeSeconds = watch.lap();
        // A bounce writes the radiance anew, as direct light plus what the surfaces reflect: direct light must be kept for that.
        if (settings.bounces > 0 || surfaceLight) bake.direct = bake.field.radiance;
        spent.energy.push_back(meanRadiance(bake.field));
        const Status bounced = settings.light         ? bake.lentLight(gpu, **baker, *settings.light, spent)
                               : info.surfaceSize > 0 ? bake.surfaceLight(gpu, *deviceScene, **baker, settings, spent)
                                                      : bake.bounces(gpu, **baker, settings, spent);
        if (!bounced) return bounced.error();
        if (shard) return finished(spent);
        spent.bounceSeconds = watch.lap() - spent.gatherSeconds;
        if (auto status = bake.finish(settings); !status) return status.error();
        spent.prefilterSeconds = watch.lap();
        spent.longestSubmission = gpu.longest();
        spent.peakDeviceBytes = std::max(gpu.memory().peak(), heldBefore) - heldBefore;
    }
    // Patches and prefiltering don't ask; who wanted to stop meanwhile is heard here.
    if (!report(progress, "done", 1.0)) return Error{ErrorCode::cancelled, "The bake was stopped at its end"};
    return finished(spent);
}

} // namespace

Result<FieldData> bakeLightField(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                                 const Progress& progress, BakeReport& report)
{
    return bakeAll(gpu, scene, probes, settings, nullptr, progress, report);
}

Status bakeShard(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings, const BakeShard& shard,
                 const Progress& progress, BakeReport& report)
{
    if (const std::string fault = shardFault(settings, shard); !fault.empty())
        return Error{ErrorCode::badArgument, fmt::format("Bake: {}", fault)};
    auto done = bakeAll(gpu, scene, probes, settings, &shard, progress, report);
    return done ? success() : Status(done.error());
}

} // namespace sconce
