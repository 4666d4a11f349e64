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

constexpr const char* kDefaultScene = "cornell-glossy";

struct BenchOptions
{
    SceneOptions scene; // its light; the scenes' names are below
    CameraOptions camera;
    std::vector<std::string> scenes;
    std::string output = "out/bench", device;
    BenchSettings settings;
    PlanSettings plan;
    uint32_t groupMebibytes = knobs::groupMebibytes.value; // settings.groupBytes
    std::string check, baseline;                           // files of a guard
    std::string gpu;                                       // file of bench/gpu/run.sh
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
    if (!run.options.gpu.empty())
    {
        Result<Json> gpu = readGpuRun(run.options.gpu);
        if (!gpu) return fail(gpu.error());
        results["gpu"] = std::move(*gpu);
    }
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
            {"until", settings.referenceUntil},
            {"frames", settings.frames},
            {"probes", plan.probes},
            {"resolution", plan.ours.resolution},
            {"bounces", plan.ours.bounces},
            {"knobs", plan.knobs},
            {"surface_rays", plan.ours.surfaceRays},
            {"seed", settings.seed},
            {"roughness", plan.roughness ? Json(*plan.roughness) : Json()}};
}

/// Throws what Json does where one isn't there or of another kind.
void setGuardOptions(const Json& options, BenchSettings& settings, PlanSettings& plan)
{
    settings.width = options.at("size").at(0);
    settings.height = options.at("size").at(1);
    settings.rays = options.at("rays");
    settings.referencePaths = options.at("spp");
    settings.referenceUntil = options.value("until", knobs::referenceUntil.value); // older guards have none
    settings.frames = options.at("frames");
    plan.probes = options.at("probes");
    plan.ours.resolution = options.at("resolution");
    plan.ours.bounces = options.at("bounces");
    plan.ours.surfaceRays = options.value("surface_rays", knobs::surfaceRays.value); // older guards have none
    plan.knobs = options.at("knobs").get<std::vector<std::string>>();
    settings.seed = options.value("seed", settings.seed); // older guards have neither
    if (const Json roughness = options.value("roughness", Json()); !roughness.is_null()) plan.roughness = roughness.get<float>();
}

/// The points of a guarded scene, measured anew: ours and B0+, without pictures.
Result<std::vector<Json>> guardedPoints(const BenchRun& run, const std::string& source, BenchSettings settings, PlanSettings plan)
{
    const Scratch scratch;
    if (scratch.path.empty())
        return Error{ErrorCode::fileError, "No temporary folder can be made; set TMPDIR to one that can be written to."};
    settings.pictures = settings.judgeGrids = false; // a guard compares with itself
    plan.methods = {"ours", "b0plus"};               // an opponent that gets worse is no better bench
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
        try
        {
            setGuardOptions(scene["options"], settings, plan);
        }
        catch (const Json::exception& problem)
        {
            return fail(
                ErrorCode::badInput,
                fmt::format("File '{}': the options of scene '{}' aren't whole ({}); write it again with `sconce bench --baseline`.",
                            run.options.check, scene["name"].get<std::string>(), problem.what()));
        }
        const Result<std::vector<Json>> points = guardedPoints(run, scene["source"], settings, plan);
        if (!points) return fail(points.error());
        for (const std::string& sentence : worsened(*guard, scene, *points)) json["worse"].push_back(sentence);
        for (const Json& point : *points)
            json["points"].push_back({{"scene", scene["name"]},
                                      {"id", point["id"]},
                                      {"trace_ms", numberOrNull(figureOf(point, "trace_ms").value_or(NAN))},
                                      {"reads", numberOrNull(figureOf(point, "reads").value_or(NAN))},
                                      {"wrong_rays", numberOrNull(figureOf(point, "wrong_rays").value_or(NAN))},
                                      {"wrong_rays_02", numberOrNull(figureOf(point, "wrong_rays_02").value_or(NAN))}});
    }
    addCost(json, watch);
    if (run.context.json)
        print(json);
    else
        for (const Json& point : json["points"])
            std::cout << point["scene"].get<std::string>() << " " << point["id"].get<std::string>() << ": " << point["reads"]
                      << " reads a ray, wrong rays within 1 % " << point["wrong_rays"] << ", within 0.2 % " << point["wrong_rays_02"]
                      << ", trace " << point["trace_ms"] << " ms" << std::endl;
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
    bench->add_option("SCENE", options->scenes, described("Files or built-in names", std::string(kDefaultScene)))->type_name("...");
    bench
        ->add_option("-o,--output", options->output,
                     described("Folder of results.json, results.csv, images/ and cache/; what it holds already is not measured again",
                               options->output))
        ->type_name("DIR");
    options->scene.addLight(bench);
    options->camera.add(bench);
    addSize(bench, settings.width, settings.height);
    addKnob(bench, "--probes", options->plan.probes, knobs::benchProbes);
    addKnob(bench, "--resolution", options->plan.ours.resolution, knobs::benchResolution, "TEXELS");
    addKnob(bench, "--bounces", options->plan.ours.bounces, knobs::benchBounces);
    addKnob(bench, "--surface-rays", options->plan.ours.surfaceRays, knobs::surfaceRays);
    bench->add_option("--knobs", options->plan.knobs, described("Sweep only these, separated by commas", words("all")))
        ->delimiter(',')
        ->type_name("LIST");
    bench->add_option("--methods", options->plan.methods, described("Measure only these, separated by commas", words("all")))
        ->delimiter(',')
        ->type_name("LIST");
    bench->add_flag("--methods-only", options->plan.methodsOnly,
                    described("Measure every method's default point alone", words("with its knobs")));
    bench->add_flag("!--quick-grids", settings.judgeGrids,
                    described("Give each method the grid whose cells' corners see best",
                              words("that on which its own answers are best, for minutes more in large scenes")));
    addKnob(bench, "--roughness", options->plan.roughness, knobs::roughness, "R");
    addKnob(bench, "--rays", settings.rays, knobs::judgedRays);
    addKnob(bench, "--frames", settings.frames, knobs::timedFrames);
    addKnob(bench, "--group-memory", options->groupMebibytes, knobs::groupMebibytes, "MIB");
    bench
        ->add_option(
            "--check", options->check,
            described("Measure what this baseline holds, and exit 1 when reads, wrong rays, errors or bytes are worse by more than "
                      "its margins",
                      words("none")))
        ->type_name("FILE");
    bench
        ->add_option("--baseline", options->baseline,
                     described("Write such a baseline of the scenes, ours and b0plus, instead of results", words("none")))
        ->type_name("FILE");
    bench
        ->add_option(
            "--gpu", options->gpu,
            described("What bench/gpu/run.sh wrote on a machine with a graphics card, for the report to show beside", words("none")))
        ->type_name("FILE");
    addKnob(bench, "--spp", settings.referencePaths, knobs::referencePaths);
    addKnob(bench, "--until", settings.referenceUntil, knobs::referenceUntil, "RELMSE");
    addKnob(bench, "--seed", settings.seed, knobs::benchSeed);
    addDevice(bench, options->device);
    onChosen(bench, context, options,
             [](BenchOptions& chosen, const Context& given)
             {
                 if (chosen.scenes.empty()) chosen.scenes = {kDefaultScene};
                 chosen.settings.groupBytes = uint64_t(chosen.groupMebibytes) << 20;
                 return runBench(chosen, given);
             });
}

} // namespace sconce::tools
