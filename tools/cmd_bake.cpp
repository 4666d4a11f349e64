// sconce bake and capture: the light field of a scene at given probes, lit or not.
#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "placement/probe_set.h"
#include "runtime/bake/bake.h"
#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/scene_check.h"
#include "scene/triangle_rays.h"
#include "tools/field_report.h"
#include "tools/light_group_options.h"
#include "tools/quality_option.h"

namespace sconce::tools
{

namespace
{

struct BakeOptions
{
    SceneOptions scene;
    BakeSettings settings;
    std::string probes, output, device, effects = "auto", gather{knobs::gather.value};
    std::vector<std::string> groups, dims;
    uint64_t memoryMb = knobs::deviceMebibytes.value;
    QualityOption quality;
};

int runBake(const BakeOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<std::vector<LightGroupDesc>> groups = groupsOf(options.groups);
    if (!groups) return fail(groups.error());
    const Result<ProbeSet> set = loadProbes(options.probes);
    if (!set) return fail(set.error());
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    if (!options.dims.empty())
        if (const auto dimmed = dimScene(*scene, *groups, options.dims); !dimmed) return fail(dimmed.error());
    // After the files, the likeliest to be wrong.
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device, .memoryBudget = options.memoryMb << 20});
    if (!device) return fail(device.error());
    BakeSettings settings = options.settings;
    const Result<std::optional<PointSettings>> quality = options.quality.load();
    if (!quality) return fail(quality.error());
    if (*quality)
    {
        options.quality.take("--resolution", settings.resolution, (*quality)->resolution);
        options.quality.take("--bounces", settings.bounces, (*quality)->bounces);
        settings.octree.voxels = (*quality)->octreeVoxels;
    }
    // The field must say that it is a grid: its probes are then found by a formula, and the bake moves none of them.
    settings.grid = set->grid;
    const RenderSettings frame = *quality ? (*quality)->frame : RenderSettings(); // that the field is for
    // By the frames that the field is for: from which roughness on they trace no rays says what the field must keep.
    const Result<EffectPlan> plan = planEffects(checkScene(*scene, frame.raysBelow), options.effects);
    if (!plan) return fail(plan.error());
    noteGivenUp(context, *plan);
    // After the plan, which asks what the whole scene calls for; what it gives up must leave no light in the field.
    capScene(*scene, *plan);
    settings.take(*plan, frame.effects.tracedDiffuse);
    // The bake knows positions alone: how a probe came to be where it is makes no difference to its light.
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
    BakeReport report;
    std::optional<TriangleRays> rays;
    if (options.gather == knobs::kGathers[0] && settings.surfaceTexels > 0)
    {
        auto built = TriangleRays::build(*scene);
        if (!built) return fail(built.error());
        settings.rays = &rays.emplace(std::move(*built));
    }
    std::optional<FieldData> light;
    if (settings.chart == gpu::kChartOctahedral && settings.surfaceTexels > 0)
    {
        Result<FieldData> found =
            bakeLightField(device->host(), *scene, positions, lendingBake(settings), consoleProgress(context), report);
        if (!found) return fail(found.error());
        settings.light = &light.emplace(std::move(*found));
    }
    const bool apart = (!groups->empty() && options.dims.empty()) || settings.liveLinks > 0 || !settings.lit;
    Result<FieldData> field =
        !apart ? bakeLightField(device->host(), *scene, positions, settings, consoleProgress(context), report)
               : bakeLightGroups(device->host(), *scene, positions, settings,
                                 options.dims.empty() ? *groups : std::vector<LightGroupDesc>(), consoleProgress(context), report);
    if (!field) return fail(field.error());
    if (report.moved > 0 && !context.quiet)
        std::cerr << "note: " << report.moved << " of " << positions.size()
                  << " probes stood on a surface, or closer than a probe sees, and were moved off it"
                  << (report.tight > 0 ? fmt::format("; {} of them found no place between two surfaces: forbid or move them", report.tight)
                                       : "")
                  << "\n";
    if (std::ranges::any_of(set->probes, [](const PlacedProbe& probe) { return !probe.why.empty(); }))
        for (const PlacedProbe& probe : set->probes) field->why.push_back(probe.why);
    if (Status status = saveField(*field, options.output); !status) return fail(status.error());
    const double lightMs = 1e3 * (report.gatherSeconds + report.bounceSeconds) / double(positions.size());
    if (context.json)
    {
        Json json = fieldJson(*field);
        json["device"] = device->name();
        json["lights"] = report.lights;
        json["probes_moved"] = report.moved;
        json["probes_tight"] = report.tight;
        json["energy"] = report.energy;
        json["peak_device_bytes"] = report.peakDeviceBytes;
        json["stage_seconds"] = {{"scene", report.sceneSeconds},    {"probes", report.probeSeconds},
                                 {"octree", report.octreeSeconds},  {"gather", report.gatherSeconds},
                                 {"bounces", report.bounceSeconds}, {"prefilter", report.prefilterSeconds}};
        json["gather_rays"] = report.gatherRays;
        json["light_ms_a_probe"] = lightMs;
        json["octree_on_device"] = report.octreeOnDevice;
        addCost(json, watch);
        print(json);
    }
    else
    {
        printField(*field, options.output);
        std::cout << "light at the probes, W/(m^2 sr): direct " << report.energy.front();
        for (size_t b = 1; b < report.energy.size(); ++b) std::cout << ", bounce " << b << " adds " << report.energy[b];
        std::cout << fmt::format("\nlight: {:.1f} ms a probe", lightMs);
        if (report.gatherRays > 0) std::cout << fmt::format(", {:.1f} million rays to triangles", double(report.gatherRays) / 1e6);
        std::cout << "\n";
        std::cout << watch.seconds() << " s, " << peakRssMb() << " MB of host memory, on " << device->name() << std::endl;
    }
    return exitOk;
}

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
    bake->add_option(
            "--effects", options.effects,
            described("auto: what the scene calls for; all; none; or a list of effects, as `sconce check` names them; -NAME takes one "
                      "away: auto,-sun bakes no sunlight. Without glossy and mirror the file holds no radiance for traced rays: "
                      "half of its size",
                      options.effects))
        ->type_name("auto|all|none|LIST");
    addDevice(bake, options.device);
    options.quality.add(bake);
}

} // namespace

void addBakeCommand(CLI::App& app, Context& context)
{
    CLI::App* bake = addCommand(app, context, "bake", "Bakes the light field of a scene at given probes");
    auto options = std::make_shared<BakeOptions>();
    addOptions(bake, *options);
    addKnob(bake, "--live-links", options->settings.liveLinks, knobs::liveLinks);
    addDims(bake, options->dims, "; the scene is baked in that light, without groups");
    onChosen(bake, context, options, runBake);
    CLI::App* capture = addCommand(app, context, "capture",
                                   "A scene's geometry and material at given probes, without light: `relight` and `render` light it");
    options = std::make_shared<BakeOptions>();
    addOptions(capture, *options);
    options->settings.lit = false;
    options->settings.liveLinks = knobs::kCapturedLinks;
    addKnob(capture, "--live-links", options->settings.liveLinks, knobs::liveLinks)
        ->description(described(wordsOf(knobs::liveLinks), knobText(knobs::kCapturedLinks), rangeText(knobs::liveLinks)));
    onChosen(capture, context, options, runBake);
}

} // namespace sconce::tools
