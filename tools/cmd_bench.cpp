// sconce bench: what accuracy costs in time and memory, measured.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include "base/safe_file.h"
#include "bench/report/report_page.h"
#include "bench/sweep/analysis.h"
#include "bench/sweep/guard.h"
#include "bench/sweep/keys.h"
#include "bench/sweep/point_json.h"
#include "bench/sweep/results.h"
#include "bench/sweep/sweep.h"
#include "runtime/vulkan/host_vulkan.h"
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
    std::string check, baseline; // files of a guard
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

/// A device, and what every scene is measured with.
struct BenchRun
{
    const BenchOptions& options;
    const Context& context;
    Gpu& gpu;
    std::string device, build;
    Progress progress;
};

using Publish = std::function<Status(Json scene)>;

/// One scene's points, as results.json has the scene; `publish` gets it whenever something is added.
Result<Json> benchScene(const BenchRun& run, const std::string& source, PlanSettings plan, const BenchSettings& settings,
                        const std::filesystem::path& folder, const Publish& publish)
{
    SceneOptions chosen = run.options.scene;
    chosen.name = source;
    Result<Scene> scene = chosen.load(run.context);
    if (!scene) return scene.error();
    if (plan.probes == 0) plan.probes = defaultProbes(nameOf(source));
    const Result<std::vector<PlannedPoint>> points = planPoints(plan);
    if (!points) return points.error();
    SceneBench::Desc desc;
    desc.name = nameOf(source);
    desc.source = std::filesystem::path(source).filename().string();
    if (run.options.camera.eye || !run.options.camera.name.empty())
    {
        const Result<Camera> camera = run.options.camera.choose(*scene);
        if (!camera) return camera.error();
        desc.camera = *camera;
    }
    desc.scene = std::move(*scene);
    desc.settings = settings;
    desc.folder = folder;
    desc.build = run.build;
    auto bench = SceneBench::create(run.gpu, run.device, std::move(desc), points->front().settings, run.progress);
    if (!bench) return bench.error();
    Json described;
    const auto publishPoints = [&](const std::vector<Json>& measured)
    {
        described = (*bench)->describe(*points);
        const std::vector<Json> scaled = scaledPoints(measured);
        described["points"] = scaled;
        described["analysis"] = analyseScene(scaled);
        return publish(described);
    };
    const auto say = [&run](const std::string& text) { note(run.context, text); };
    if (Status status = sweepScene(**bench, *points, publishPoints, say, run.progress); !status) return status.error();
    return described;
}

int runSweep(const BenchRun& run)
{
    const Stopwatch watch;
    const std::filesystem::path folder(run.options.output);
    Json results = resultsHead(SCONCE_VERSION, run.build, run.context.commandLine, run.device);
    for (const std::string& source : run.options.scenes)
    {
        results["scenes"].push_back(Json::object());
        const auto publish = [&](Json scene)
        {
            results["scenes"].back() = std::move(scene);
            results["answers"] = answersOf(results);
            results["seconds"] = watch.seconds();
            return writeResults(results, folder);
        };
        const Result<Json> scene = benchScene(run, source, run.options.plan, run.options.settings, folder, publish);
        if (!scene) return fail(scene.error());
    }
    if (Status status = writeReportPage(results, folder); !status) return fail(status.error());
    run.progress("bench", 1.0);
    if (run.context.json)
    {
        Json json{{"results", (folder / "results.json").string()}, {"report", (folder / "report/index.html").string()}};
        json["scenes"] = results["scenes"].size();
        addCost(json, watch);
        print(json);
    }
    else
        std::cout << (folder / "results.json").string() << ", results.csv, report/index.html" << std::endl;
    return exitOk;
}

/// A folder for the measurements of a guard, gone at its end: nothing that another program measured may stand in for this one's.
class Scratch
{
public:
    Scratch()
    {
        std::string name = (std::filesystem::temp_directory_path() / "sconce-bench-XXXXXX").string();
        if (mkdtemp(name.data())) path = name;
    }
    ~Scratch()
    {
        std::error_code ignored; // nothing depends on it
        if (!path.empty()) std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path; // empty: it could not be made
};

/// What the points of a guard are measured with, and back.
Json guardOptions(const BenchSettings& settings, const PlanSettings& plan)
{
    return {{"size", {settings.width, settings.height}},
            {"rays", settings.rays},
            {"spp", settings.referencePaths},
            {"frames", settings.frames},
            {"probes", plan.probes},
            {"resolution", plan.ours.resolution},
            {"bounces", plan.ours.bounces},
            {"knobs", plan.knobs}};
}

void setGuardOptions(const Json& options, BenchSettings& settings, PlanSettings& plan)
{
    settings.width = options["size"][0];
    settings.height = options["size"][1];
    settings.rays = options["rays"];
    settings.referencePaths = options["spp"];
    settings.frames = options["frames"];
    plan.probes = options["probes"];
    plan.ours.resolution = options["resolution"];
    plan.ours.bounces = options["bounces"];
    plan.knobs = options["knobs"].get<std::vector<std::string>>();
}

/// The points of a guarded scene, measured anew: ours alone, without pictures.
Result<std::vector<Json>> guardedPoints(const BenchRun& run, const std::string& source, BenchSettings settings, PlanSettings plan)
{
    const Scratch scratch;
    if (scratch.path.empty())
        return Error{ErrorCode::fileError, "No temporary folder can be made; set TMPDIR to one that can be written to."};
    settings.pictures = false;
    plan.methods = {"ours"};
    const Result<Json> scene = benchScene(run, source, plan, settings, scratch.path, [](const Json&) { return success(); });
    if (!scene) return scene.error();
    return (*scene)["points"].get<std::vector<Json>>();
}

int writeGuard(const BenchRun& run)
{
    Json guard = emptyGuard();
    for (const std::string& source : run.options.scenes)
    {
        PlanSettings plan = run.options.plan;
        if (plan.probes == 0) plan.probes = defaultProbes(nameOf(source));
        const Result<std::vector<Json>> points = guardedPoints(run, source, run.options.settings, plan);
        if (!points) return fail(points.error());
        guard["scenes"].push_back(guardedScene(nameOf(source), source, guardOptions(run.options.settings, plan), *points));
    }
    if (Status status = writeText(run.options.baseline, guard.dump(1) + "\n"); !status) return fail(status.error());
    return exitOk;
}

int checkGuard(const BenchRun& run)
{
    const Stopwatch watch;
    const Result<Json> guard = readGuard(run.options.check);
    if (!guard) return fail(guard.error());
    Json json = {{"worse", Json::array()}, {"points", Json::array()}};
    for (const Json& scene : (*guard)["scenes"])
    {
        BenchSettings settings = run.options.settings;
        PlanSettings plan;
        setGuardOptions(scene["options"], settings, plan);
        const Result<std::vector<Json>> points = guardedPoints(run, scene["source"], settings, plan);
        if (!points) return fail(points.error());
        for (const std::string& sentence : worsened(*guard, scene, *points)) json["worse"].push_back(sentence);
        for (const Json& point : *points)
            json["points"].push_back({{"scene", scene["name"]},
                                      {"id", point["id"]},
                                      {"trace_ms", numberOrNull(figureOf(point, "trace_ms").value_or(NAN))},
                                      {"reads", *figureOf(point, "reads")},
                                      {"wrong_rays", *figureOf(point, "wrong_rays")}});
    }
    addCost(json, watch);
    if (run.context.json)
        print(json);
    else
        for (const Json& point : json["points"])
            std::cout << point["scene"].get<std::string>() << " " << point["id"].get<std::string>() << ": " << point["reads"]
                      << " reads a ray, wrong rays " << point["wrong_rays"] << ", trace " << point["trace_ms"] << " ms" << std::endl;
    for (const Json& sentence : json["worse"]) std::cerr << "sconce: " << sentence.get<std::string>() << std::endl;
    return json["worse"].empty() ? exitOk : exitThreshold;
}

int runBench(const BenchOptions& options, const Context& context)
{
    const Result<OwnDevice> device = OwnDevice::create({.device = options.device});
    if (!device) return fail(device.error());
    Result<std::shared_ptr<Gpu>> gpu = Gpu::create(device->host());
    if (!gpu) return fail(gpu.error());
    const Result<std::string> build = keyOfThisBuild();
    if (!build) return fail(build.error());
    const BenchRun run{options, context, **gpu, device->name(), *build, consoleProgress(context)};
    if (!options.check.empty()) return checkGuard(run);
    return options.baseline.empty() ? runSweep(run) : writeGuard(run);
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
    bench
        ->add_option_function<uint32_t>(
            "--group-memory", [&settings](uint32_t mebibytes) { settings.groupBytes = uint64_t(mebibytes) << 20; },
            "Light fields timed in turns stand on the device together, up to so many MiB (default: 2048; range: 1 to 1048576)")
        ->check(unlisted(CLI::Range(1u, 1048576u)))
        ->type_name("MIB");
    bench
        ->add_option("--check", options->check,
                     "Measure what this baseline holds, and exit 1 when reads, wrong rays, errors or bytes are worse by more than its "
                     "margins (default: none)")
        ->type_name("FILE");
    bench
        ->add_option("--baseline", options->baseline, "Write such a baseline of the scenes, ours alone, instead of results (default: none)")
        ->type_name("FILE");
    bench->add_option("--spp", settings.referencePaths, "Paths a pixel of the reference (default: 256; range: 2 to 1048576)")
        ->check(unlisted(CLI::Range(2u, 1048576u)))
        ->type_name("N");
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
