// sconce bake and capture: the light field of a scene at given probes, lit or not.
#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "placement/probe_set.h"
#include "runtime/bake/bake_key.h"
#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/scene/content_key.h"
#include "runtime/vulkan/gpu.h"
#include "scene/scene_check.h"
#include "scene/triangle_rays.h"
#include "tools/bake_command.h"
#include "tools/field_report.h"
#include "tools/light_group_options.h"

namespace sconce::tools
{

namespace
{

/// What is baked, from what the command line says. Its parts refer to each other: it stays where it is.
struct Asked
{
    ProbeSet set;
    Scene scene;
    std::optional<OwnDevice> device;
    std::shared_ptr<Gpu> gpu; // of it
    std::vector<LightGroupDesc> groups;
    std::vector<vec3> positions;
    std::optional<TriangleRays> rays;
    BakeSettings settings;
    bool apart = false; // light is kept by groups
    bool lends = false; // a bake of cube faces before this one finds its light
};

/// Probes, scene, the device, and groups.
Status load(const BakeOptions& options, const Context& context, Asked& asked)
{
    Result<std::vector<LightGroupDesc>> groups = groupsOf(options.groups);
    if (!groups) return groups.error();
    Result<ProbeSet> set = loadProbes(options.probes);
    if (!set) return set.error();
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return scene.error();
    if (!options.dims.empty())
        if (const auto dimmed = dimScene(*scene, *groups, options.dims); !dimmed) return dimmed.error();
    // After the files, the likeliest to be wrong.
    Result<OwnDevice> device = OwnDevice::create({.device = options.device, .memoryBudget = options.memoryMb << 20});
    if (!device) return device.error();
    asked.set = std::move(*set);
    asked.scene = std::move(*scene);
    asked.device.emplace(std::move(*device));
    auto gpu = Gpu::create(asked.device->host());
    if (!gpu) return gpu.error();
    asked.gpu = std::move(*gpu);
    asked.apart = (!groups->empty() && options.dims.empty()) || options.settings.liveLinks > 0 || !options.settings.lit;
    if (options.dims.empty()) asked.groups = std::move(*groups);
    // The bake knows positions alone: how a probe came to be where it is makes no difference to its light.
    for (const PlacedProbe& probe : asked.set.probes) asked.positions.push_back(probe.position);
    return success();
}

/// The settings, by what was loaded.
Status settle(const BakeOptions& options, const Context& context, Asked& asked)
{
    BakeSettings& settings = asked.settings = options.settings;
    std::string gather = options.gather;
    const Result<std::optional<PointSettings>> quality = options.quality.load();
    if (!quality) return quality.error();
    if (*quality)
    {
        options.quality.take("--resolution", settings.resolution, (*quality)->resolution);
        options.quality.take("--bounces", settings.bounces, (*quality)->bounces);
        options.quality.take("--surface-texels", settings.surfaceTexels, (*quality)->bakedSurfaceTexels());
        options.quality.take("--surface-rays", settings.surfaceRays, (*quality)->surfaceRays);
        options.quality.take("--surface-refined", settings.surfaceRefined, (*quality)->surfaceRefined);
        // Blocks give way to what the line asks for, which they can't hold.
        if (settings.chart == gpu::kChartCube && settings.liveLinks == 0 && options.groups.empty())
            options.quality.take("--compact", settings.compact, (*quality)->compact);
        else if ((*quality)->compact)
            note(context, "Note: the maps are not put in blocks, as --quality says: octahedral maps and light that may change can't be.");
        options.quality.take("--gather", gather, std::string(knobs::kGathers[(*quality)->fieldGather ? 1 : 0]));
        settings.octree.voxels = (*quality)->octreeVoxels;
    }
    // The field must say that it is a grid: its probes are then found by a formula, and the bake moves none of them.
    settings.grid = asked.set.grid;
    const RenderSettings frame = *quality ? (*quality)->frame : RenderSettings(); // that the field is for
    // By the frames that the field is for: from which roughness on they trace no rays says what the field must keep.
    const Result<EffectPlan> plan = planEffects(checkScene(asked.scene, frame.raysBelow), options.effects);
    if (!plan) return plan.error();
    noteGivenUp(context, *plan);
    // After the plan, which asks what the whole scene calls for; what it gives up must leave no light in the field.
    capScene(asked.scene, *plan);
    settings.take(*plan, frame.effects.tracedDiffuse);
    if (settings.compact && settings.chart != gpu::kChartCube) // before another bake that lends its light
        return Error{ErrorCode::badArgument, "--compact puts cube faces in blocks; leave it out with --chart octahedral."};
    asked.lends = settings.chart == gpu::kChartOctahedral && settings.surfaceTexels > 0;
    if (gather != knobs::kGathers[0] || settings.surfaceTexels == 0) return success();
    auto built = TriangleRays::build(asked.scene);
    if (!built) return built.error();
    settings.rays = &asked.rays.emplace(std::move(*built));
    return success();
}

/// What tells this command's bake from others, on this device.
uint64_t contentOf(const Asked& asked)
{
    ContentHash hash;
    hash.add(bakeKey(asked.scene, asked.positions, asked.settings));
    hash.add(deviceKey(asked.device->host()));
    hash.add(asked.lends), hash.add(asked.apart), hash.add(asked.groups.size());
    for (const LightGroupDesc& group : asked.groups)
    {
        hash.addText(group.name);
        hash.add(group.members.size());
        for (const std::string& member : group.members) hash.addText(member);
    }
    return hash.value();
}

Result<FieldData> bakeField(Asked& asked, const Context& context, BakeReport& report)
{
    Gpu& gpu = *asked.gpu;
    const Progress progress = consoleProgress(context);
    if (asked.apart) return bakeLightGroups(gpu, asked.scene, asked.positions, asked.settings, asked.groups, progress, report);
    if (!asked.lends) return bakeLightField(gpu, asked.scene, asked.positions, asked.settings, progress, report);
    const Result<FieldData> light = bakeLightField(gpu, asked.scene, asked.positions, lendingBake(asked.settings), progress, report);
    if (!light) return light;
    asked.settings.light = &*light;
    auto field = bakeLightField(gpu, asked.scene, asked.positions, asked.settings, progress, report);
    asked.settings.light = nullptr;
    return field;
}

int runShard(const Asked& asked, const BakeShard& shard, const std::string& output, BakeJob& job, const Context& context,
             const Stopwatch& watch)
{
    Gpu& gpu = *asked.gpu;
    const Progress progress = consoleProgress(context);
    BakeReport report;
    Status done = asked.apart ? bakeGroupShard(gpu, asked.scene, asked.positions, asked.settings, asked.groups, shard, progress, report)
                              : bakeShard(gpu, asked.scene, asked.positions, asked.settings, shard, progress, report);
    if (done) done = job.commitAs(output);
    if (!done) return fail(job.withRemedy(done.error()));
    size_t probes = 0;
    for (size_t i = 0; i < asked.positions.size(); ++i) probes += shard.has(i);
    const char* const stage = shard.stage == BakeStage::gather ? "gather" : "maps";
    if (context.json)
    {
        Json json = {{"file", output},   {"stage", stage},       {"shard", shard.index},           {"shards", shard.count},
                     {"probes", probes}, {"bytes", job.bytes()}, {"resumed_parts", job.resumed()}, {"device", asked.device->name()}};
        addCost(json, watch);
        print(json);
        return exitOk;
    }
    std::cout << fmt::format("shard {}/{}, {} of {} probes: {}, {} bytes\n", shard.index, shard.count, stage, probes, output, job.bytes())
              << watch.seconds() << " s, on " << asked.device->name() << std::endl;
    return exitOk;
}

void tellBake(const FieldData& field, const std::string& output, const Asked& asked, const BakeReport& report, const BakeJob* job,
              const Context& context, const Stopwatch& watch)
{
    const double lightMs = 1e3 * (report.gatherSeconds + report.bounceSeconds) / double(asked.positions.size());
    if (context.json)
    {
        Json json = fieldJson(field);
        json["device"] = asked.device->name();
        json["lights"] = report.lights;
        json["probes_moved"] = report.moved;
        json["probes_tight"] = report.tight;
        json["energy"] = report.energy;
        json["peak_device_bytes"] = report.peakDeviceBytes;
        json["longest_submission_ms"] = 1e3 * report.longestSubmission;
        json["stage_seconds"] = {{"scene", report.sceneSeconds},    {"probes", report.probeSeconds},
                                 {"octree", report.octreeSeconds},  {"gather", report.gatherSeconds},
                                 {"bounces", report.bounceSeconds}, {"prefilter", report.prefilterSeconds}};
        json["gather_rays"] = report.gatherRays;
        json["light_ms_a_probe"] = lightMs;
        json["octree_on_device"] = report.octreeOnDevice;
        json["resumed_parts"] = job ? job->resumed() : 0;
        json["journal_bytes"] = job ? job->bytes() : 0;
        addCost(json, watch);
        print(json);
        return;
    }
    printField(field, output);
    std::cout << "light at the probes, W/(m^2 sr): direct " << report.energy.front();
    for (size_t b = 1; b < report.energy.size(); ++b) std::cout << ", bounce " << b << " adds " << report.energy[b];
    std::cout << fmt::format("\nlight: {:.1f} ms a probe", lightMs);
    if (report.gatherRays > 0) std::cout << fmt::format(", {:.1f} million rays to triangles", double(report.gatherRays) / 1e6);
    std::cout << "\n";
    std::cout << watch.seconds() << " s, " << peakRssMb() << " MB of host memory, on " << asked.device->name() << std::endl;
}

/// The whole bake, into its file. @param job  null: without a journal
int runWhole(Asked& asked, const std::string& output, BakeJob* job, const Context& context, const Stopwatch& watch)
{
    BakeReport report;
    Result<FieldData> field = bakeField(asked, context, report);
    if (!field) return fail(job ? job->withRemedy(field.error()) : field.error());
    if (report.moved > 0 && !context.quiet)
        std::cerr << "note: " << report.moved << " of " << asked.positions.size()
                  << " probes stood on a surface, or closer than a probe sees, and were moved off it"
                  << (report.tight > 0 ? fmt::format("; {} of them found no place between two surfaces: forbid or move them", report.tight)
                                       : "")
                  << "\n";
    if (std::ranges::any_of(asked.set.probes, [](const PlacedProbe& probe) { return !probe.why.empty(); }))
        for (const PlacedProbe& probe : asked.set.probes) field->why.push_back(probe.why);
    if (Status status = saveField(*field, output); !status) return fail(job ? job->withRemedy(status.error()) : status.error());
    // Not before the output is on the disk: until then the same command goes on from the journal.
    if (job)
        if (Status status = job->remove(); !status) return fail(status.error());
    tellBake(*field, output, asked, report, job, context, watch);
    return exitOk;
}

} // namespace

int runBake(const BakeOptions& options, std::vector<JournalFile> parts, const Context& context)
{
    const Stopwatch watch;
    const Result<std::optional<BakeShard>> shard = options.job.wanted();
    if (!shard) return fail(shard.error());
    if (*shard && !options.job.after.empty())
    {
        auto maps = readParts(options.job.after);
        if (!maps) return fail(maps.error());
        parts = std::move(*maps);
    }
    Asked asked;
    if (auto status = load(options, context, asked); !status) return fail(status.error());
    if (auto status = settle(options, context, asked); !status) return fail(status.error());
    if (*shard && asked.lends)
        return fail(ErrorCode::badArgument,
                    "--shard: octahedral maps take their light from another bake; shard a bake of cube faces, or give "
                    "--surface-texels 0");
    std::optional<BakeJob> job;
    if (!options.job.none)
    {
        auto opened =
            BakeJob::open(options.job, {options.output, contentOf(asked), uint32_t(asked.positions.size()), *shard, context.arguments},
                          std::move(parts), context);
        if (!opened) return fail(opened.error());
        asked.settings.journal = &job.emplace(std::move(*opened));
    }
    if (*shard) return runShard(asked, **shard, options.output, *job, context, watch);
    return runWhole(asked, options.output, job ? &*job : nullptr, context, watch);
}

namespace
{

/// What bake and capture have in common.
void addOptions(CLI::App* bake, BakeOptions& options)
{
    BakeSettings& settings = options.settings;
    options.scene.add(bake);
    bake->add_option("--probes", options.probes, "probes.json of `sconce place` (required)")->required()->type_name("FILE");
    bake->add_option("-o,--output", options.output, ".sconce file to write (required)")->required()->type_name("FILE");
    addKnob(bake, "--resolution", settings.resolution, knobs::resolution, "TEXELS");
    addKnob(bake, "--bounces", settings.bounces, knobs::bounces);
    addKnob(bake, "--converged", settings.converged, knobs::converged, "SHARE");
    addKnob(bake, "--surface-texels", settings.surfaceTexels, knobs::surfaceTexels, "TEXELS");
    addKnob(bake, "--surface-refined", settings.surfaceRefined, knobs::surfaceRefined, "SHARE");
    addKnob(bake, "--lamp-texels", settings.lampTexels, knobs::lampTexels, "TEXELS");
    addKnob(bake, "--surface-rays", settings.surfaceRays, knobs::surfaceRays);
    addKnob(bake, "--gather", options.gather, knobs::gather);
    addChoice(bake, "--chart", settings.chart, knobs::chart);
    addGroups(
        bake, options.groups,
        "Lights that can be switched, dimmed and coloured later (`render --dim`, `relight`, LightGroups), each for a bake more and all "
        "light of the file again");
    addKnob(bake, "--memory", options.memoryMb, knobs::deviceMebibytes, "MIB");
    addKnob(bake, "--submission", settings.submissionMs, knobs::submissionMs, "MS");
    bake->add_option(
            "--effects", options.effects,
            described("auto: what the scene calls for; all; none; or a list of effects, as `sconce check` names them; -NAME takes one "
                      "away: auto,-sun bakes no sunlight. Without glossy and mirror the file holds no radiance for traced rays: "
                      "half of its size",
                      options.effects))
        ->type_name("auto|all|none|LIST");
    addDevice(bake, options.device);
    options.quality.add(bake);
    options.job.add(bake);
    options.job.addShard(bake);
}

int runAlone(const BakeOptions& options, const Context& context)
{
    return runBake(options, {}, context);
}

} // namespace

BakeCommands addBakeCommands(CLI::App& app, Context& context)
{
    CLI::App* bake = addCommand(app, context, "bake", "Bakes the light field of a scene at given probes");
    BakeCommands commands{std::make_shared<BakeOptions>(), std::make_shared<BakeOptions>()};
    addOptions(bake, *commands.bake);
    addKnob(bake, "--live-links", commands.bake->settings.liveLinks, knobs::liveLinks);
    addSwitch(bake, "--compact", commands.bake->settings.compact, knobs::compact);
    addDims(bake, commands.bake->dims, "; the scene is baked in that light, without groups");
    onChosen(bake, context, commands.bake, runAlone);
    CLI::App* capture = addCommand(app, context, "capture",
                                   "A scene's geometry and material at given probes, without light: `relight` and `render` light it");
    addOptions(capture, *commands.capture);
    commands.capture->settings.lit = false;
    commands.capture->settings.liveLinks = knobs::kCapturedLinks;
    addKnob(capture, "--live-links", commands.capture->settings.liveLinks, knobs::liveLinks)
        ->description(described(wordsOf(knobs::liveLinks), knobText(knobs::kCapturedLinks), rangeText(knobs::liveLinks)));
    onChosen(capture, context, commands.capture, runAlone);
    return commands;
}

void addBakeCommand(CLI::App& app, Context& context)
{
    addBakeCommands(app, context);
}

} // namespace sconce::tools
