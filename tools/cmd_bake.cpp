// sconce bake: the light field of a scene at given probes.
#include <iostream>

#include "placement/probe_set.h"
#include "runtime/bake/bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/scene_check.h"
#include "tools/field_report.h"
#include "tools/quality_option.h"

namespace sconce::tools
{

namespace
{

struct BakeOptions
{
    SceneOptions scene;
    BakeSettings settings;
    std::string probes, output, device, effects = "auto";
    uint64_t memoryMb = 0;
    QualityOption quality;
};

int runBake(const BakeOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<ProbeSet> set = loadProbes(options.probes);
    if (!set) return fail(set.error());
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
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
    settings.grid = set->grid;
    const RenderSettings frame = *quality ? (*quality)->frame : RenderSettings(); // that the field is for
    const Result<EffectPlan> plan = planEffects(checkScene(*scene, frame.raysBelow), options.effects);
    if (!plan) return fail(plan.error());
    noteGivenUp(context, *plan);
    capScene(*scene, *plan);
    settings.take(*plan, frame.effects.tracedDiffuse);
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
    BakeReport report;
    Result<FieldData> field = bakeLightField(device->host(), *scene, positions, settings, consoleProgress(context), report);
    if (!field) return fail(field.error());
    if (report.moved > 0 && !context.quiet)
        std::cerr << "note: " << report.moved << " of " << positions.size()
                  << " probes stood on a surface, or closer than a probe sees, and were moved off it"
                  << (report.tight > 0
                          ? "; " + std::to_string(report.tight) + " of them found no place between two surfaces: forbid or move them"
                          : "")
                  << "\n";
    if (Status status = saveField(*field, options.output); !status) return fail(status.error());
    if (context.json)
    {
        Json json = fieldJson(*field);
        json["device"] = device->name();
        json["lights"] = report.lights;
        json["probes_moved"] = report.moved;
        json["probes_tight"] = report.tight;
        json["energy"] = report.energy;
        json["peak_device_bytes"] = report.peakDeviceBytes;
        json["stage_seconds"] = {{"scene", report.sceneSeconds},
                                 {"probes", report.probeSeconds},
                                 {"octree", report.octreeSeconds},
                                 {"bounces", report.bounceSeconds},
                                 {"prefilter", report.prefilterSeconds}};
        json["octree_on_device"] = report.octreeOnDevice;
        addCost(json, watch);
        print(json);
    }
    else
    {
        printField(*field, options.output);
        std::cout << "light at the probes, W/(m^2 sr): direct " << report.energy.front();
        for (size_t b = 1; b < report.energy.size(); ++b) std::cout << ", bounce " << b << " adds " << report.energy[b];
        std::cout << "\n";
        std::cout << watch.seconds() << " s, " << peakRssMb() << " MB of host memory, on " << device->name() << std::endl;
    }
    return exitOk;
}

} // namespace

void addBakeCommand(CLI::App& app, Context& context)
{
    CLI::App* bake = addCommand(app, context, "bake", "Bakes the light field of a scene at given probes");
    auto options = std::make_shared<BakeOptions>();
    BakeSettings& settings = options->settings;
    options->scene.add(bake);
    bake->add_option("--probes", options->probes, "probes.json of `sconce place` (required)")->required()->type_name("FILE");
    bake->add_option("-o,--output", options->output, ".sconce file to write (required)")->required()->type_name("FILE");
    bake->add_option(
            "--resolution", settings.resolution,
            "Side of an octahedral map in texels; the cube chart's faces have half of it (416: the memory of an octahedral map of "
            "512); memory grows with its square (default: 512; range: 64 to 2048, power of two, or multiple of 32 with cube faces)")
        ->check(unlisted(CLI::Range(64u, 2048u)))
        ->type_name("TEXELS");
    bake->add_option("--bounces", settings.bounces,
                     "Times the baked light is re-injected; each costs one more pass over every probe (default: 2; range: 0 to 64)")
        ->check(unlisted(CLI::Range(0u, 64u)))
        ->type_name("N");
    bake->add_option("--converged", settings.converged,
                     "Stops before --bounces when one adds less than this share of all light (default: 0, never; range: 0 to 1)")
        ->check(unlisted(CLI::Range(0.0f, 1.0f)))
        ->type_name("SHARE");
    const std::map<std::string, uint32_t> charts{{"cube", gpu::kChartCube}, {"octahedral", gpu::kChartOctahedral}};
    bake->add_option("--chart", settings.chart,
                     "cube: six faces a probe; octahedral: one map a probe, for the tracers b0, b0plus and b0plus-octree (default: cube)")
        ->transform(unlisted(CLI::CheckedTransformer(charts)))
        ->type_name("cube|octahedral");
    bake->add_option("--memory", options->memoryMb,
                     "Budget of device memory, MiB; too little is refused with the number needed (default: 80 % of the device's; range: 1 "
                     "to 1048576)")
        ->check(unlisted(CLI::Range(uint64_t(1), uint64_t(1) << 20)))
        ->type_name("MIB");
    bake->add_option("--effects", options->effects,
                     "auto: what the scene calls for; all; none; or a list of effects, as `sconce check` names them; -NAME takes one away: "
                     "auto,-sun bakes no sunlight. Without glossy and mirror the file holds no radiance for traced rays: half of its size "
                     "(default: auto)")
        ->type_name("auto|all|none|LIST");
    addDevice(bake, options->device);
    options->quality.add(bake);
    onChosen(bake, context, options, runBake);
}

} // namespace sconce::tools
