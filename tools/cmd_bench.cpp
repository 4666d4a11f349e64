// sconce bench: what accuracy costs in time and memory, measured.
#include <algorithm>
#include <iostream>
#include <map>

#include "bench/analysis.h"
#include "bench/report_page.h"
#include "bench/results.h"
#include "bench/sweep.h"
#include "runtime/host_vulkan.h"
#include "tools/common.h"

namespace sconce::tools
{

namespace
{

struct BenchOptions
{
    SceneOptions scene; // its light; the scenes' names are below
    CameraOptions camera;
    std::vector<std::string> scenes;
    std::string output = "out/bench", device;
    BenchSettings settings;
    PlanSettings plan;
    uint32_t groupMb = 2048;
};

/// Probes of the default points, where --probes isn't given: those of the papers' tables for their scenes.
uint32_t defaultProbes(const std::string& scene)
{
    static const std::map<std::string, uint32_t> known{{"cornell", 8},      {"cornell-glossy", 8}, {"temple", 16}, {"hall", 50},
                                                       {"modern_hall", 50}, {"Sponza", 54},        {"town", 128}};
    const auto found = known.find(scene);
    return found == known.end() ? 54 : found->second;
}

std::string nameOf(const std::string& source)
{
    const std::filesystem::path path(source);
    const std::string stem = path.stem().string();
    return stem == "scene" && path.has_parent_path() ? path.parent_path().filename().string() : stem;
}

std::string commandLine(const BenchOptions& options)
{
    std::string command = "sconce bench";
    for (const std::string& scene : options.scenes) command += " " + scene;
    return command + " --size " + std::to_string(options.settings.width) + "x" + std::to_string(options.settings.height) + " --frames " +
           std::to_string(options.settings.frames) + " --rays " + std::to_string(options.settings.rays) + " --spp " +
           std::to_string(options.settings.referencePaths) +
           (options.plan.probes ? " --probes " + std::to_string(options.plan.probes) : std::string()) +
           (options.plan.roughness ? " --roughness " + std::to_string(*options.plan.roughness) : std::string());
}

int runBench(const BenchOptions& options, const Context& context)
{
    const Stopwatch watch;
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device});
    if (!device) return fail(device.error());
    Result<std::unique_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return fail(gpu.error());
    Json results = resultsHead(SCONCE_VERSION, commandLine(options), device->name());
    const std::filesystem::path folder(options.output);
    const auto say = [&context](const std::string& text) { note(context, text); };
    const Progress progress = consoleProgress(context);

    for (const std::string& source : options.scenes)
    {
        SceneOptions chosen = options.scene;
        chosen.name = source;
        Result<Scene> scene = chosen.load(context);
        if (!scene) return fail(scene.error());
        PlanSettings plan = options.plan;
        if (plan.probes == 0) plan.probes = defaultProbes(nameOf(source));
        const Result<std::vector<PlannedPoint>> points = planPoints(plan);
        if (!points) return fail(points.error());
        SceneBench::Desc desc;
        desc.name = nameOf(source);
        desc.source = std::filesystem::path(source).filename().string();
        if (options.camera.eye || !options.camera.name.empty())
        {
            const Result<Camera> camera = options.camera.choose(*scene);
            if (!camera) return fail(camera.error());
            desc.camera = *camera;
        }
        desc.scene = std::move(*scene);
        desc.settings = options.settings;
        desc.settings.groupBytes = uint64_t(options.groupMb) << 20;
        desc.folder = folder;
        desc.version = SCONCE_VERSION;
        auto bench = SceneBench::create(**gpu, device->name(), std::move(desc), points->front().settings, progress);
        if (!bench) return fail(bench.error());

        results["scenes"].push_back(Json::object());
        const auto publish = [&](const std::vector<Json>& measured)
        {
            Json& described = results["scenes"].back();
            described = (*bench)->describe(*points);
            const std::vector<Json> scaled = scaledPoints(measured);
            described["points"] = scaled;
            described["analysis"] = analyseScene(scaled);
            results["answers"] = answersOf(results);
            results["seconds"] = watch.seconds();
            return writeResults(results, folder);
        };
        if (Status status = sweepScene(**bench, *points, publish, say, progress); !status) return fail(status.error());
    }
    if (Status status = writeReportPage(nlohmann::json(results), folder); !status) return fail(status.error());
    progress("bench", 1.0);
    if (context.json)
    {
        Json json{{"results", (folder / "results.json").string()}, {"report", (folder / "report/index.html").string()}, {"scenes", results["scenes"].size()}};
        addCost(json, watch);
        print(json);
    }
    else
        std::cout << (folder / "results.json").string() << ", results.csv, report/index.html" << std::endl;
    return exitOk;
}

} // namespace

void addBenchCommand(CLI::App& app, Context& context)
{
    CLI::App* bench =
        addCommand(app, context, "bench", "Measures what accuracy costs in time and memory: ours with every knob, opponents, path tracer");
    auto options = std::make_shared<BenchOptions>();
    BenchSettings& settings = options->settings;
    bench->add_option("SCENE", options->scenes, "Files or built-in names (default: cornell-glossy)")->type_name("...");
    bench
        ->add_option(
            "-o,--output", options->output,
            "Folder of results.json, results.csv, images/ and cache/; what it holds already is not measured again (default: out/bench)")
        ->type_name("DIR");
    options->scene.addLight(bench);
    options->camera.add(bench);
    addSize(bench, settings.width, settings.height);
    bench->add_option("--probes", options->plan.probes, "Of the default points (default: by scene, 54 for others; range: 1 to 65535)")
        ->check(unlisted(CLI::Range(1u, kMostProbes)))
        ->type_name("N");
    bench
        ->add_option("--resolution", options->plan.ours.resolution,
                     "Of our default points; the opponents' is the next power of two (default: 416; range: 64 to 1024, multiple of 32)")
        ->check(unlisted(CLI::Range(64u, 1024u)))
        ->type_name("TEXELS");
    bench
        ->add_option("--bounces", options->plan.ours.bounces,
                     "Of the default points and of the path tracer; the reference has 8 (default: 2; range: 0 to 8)")
        ->check(unlisted(CLI::Range(0u, 8u)))
        ->type_name("N");
    bench->add_option("--knobs", options->plan.knobs, "Sweep only these, separated by commas (default: all)")
        ->delimiter(',')
        ->type_name("LIST");
    bench->add_flag("--methods-only", options->plan.methodsOnly, "Measure every method's default point alone (default: with its knobs)");
    bench->add_option("--roughness", options->plan.roughness, "Roughness of every surface (default: the materials' own; range: 0 to 1)")
        ->check(unlisted(CLI::Range(0.0f, 1.0f)))
        ->type_name("R");
    bench->add_option("--rays", settings.rays, "Glossy rays that are judged against Embree (default: 50000; range: 100 to 10000000)")
        ->check(unlisted(CLI::Range(100u, 10000000u)))
        ->type_name("N");
    bench->add_option("--frames", settings.frames, "Timed frames of every point, in turns (default: 20; range: 1 to 1000)")
        ->check(unlisted(CLI::Range(1u, 1000u)))
        ->type_name("N");
    bench->add_option("--spp", settings.referencePaths, "Paths a pixel of the reference (default: 256; range: 2 to 1048576)")
        ->check(unlisted(CLI::Range(2u, 1048576u)))
        ->type_name("N");
    bench
        ->add_option("--group-memory", options->groupMb,
                     "Light fields timed in turns stand on the device together, up to so many MiB (default: 2048; range: 1 to 1048576)")
        ->check(unlisted(CLI::Range(1u, 1048576u)))
        ->type_name("MIB");
    bench->add_option("--seed", settings.seed, "Of rays and paths (default: 1; range: 0 to 2^64-1)")->type_name("N");
    addDevice(bench, options->device);
    onChosen(bench, context, options,
             [](BenchOptions& chosen, const Context& given)
             {
                 if (chosen.scenes.empty()) chosen.scenes = {"cornell-glossy"};
                 return runBench(chosen, given);
             });
}

} // namespace sconce::tools
