// sconce place: where the probes of a scene go.
#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "base/safe_file.h"
#include "bench/reference/image_io.h"
#include "bench/sweep/probe_sets.h"
#include "placement/place.h"
#include "runtime/field/field_data.h"
#include "scene/scene_gltf.h"
#include "tools/quality_option.h"

namespace sconce::tools
{

namespace
{

struct PlaceOptions
{
    SceneOptions scene;
    PlaceSettings settings;
    std::string walk; // file of settings.open.walk
    std::string output;
    std::string explain;
    std::string pins;
    uint64_t memory = knobs::mapBytes.value;       // bytes; 0: no budget
    uint32_t resolution = knobs::resolution.value; // what the budget is counted for
    bool compact = knobs::compact.value;           // and that
    QualityOption quality;
};

/// As many probes as the budget holds. Errors: badArgument with the bytes that one needs.
Result<uint32_t> countFor(uint64_t memory, const PointSettings& baked)
{
    // The scene is read later: as if it had normal textures, which take a few bytes more.
    const uint64_t each =
        bytesPerProbe(gpu::kChartCube, baked.resolution, baked.bakedSurfaceTexels(), true, baked.surfaceRefined, baked.compact);
    if (memory < each)
        return Error{ErrorCode::badArgument,
                     fmt::format("--memory is {} bytes, but one probe takes {} at --resolution {}; raise the one or lower the other.",
                                 memory, each, baked.resolution)};
    return uint32_t(std::min<uint64_t>(memory / each, kMostProbes));
}

/// Throws what CLI11 ends as a usage error.
/// @param walk  out: file of the mesh to walk on, empty without
void readSpace(const std::string& text, OpenSpace& open, std::string& walk)
{
    open = {};
    walk.clear();
    if (text == "auto") return;
    if (text == "enclosed") open.ground = 0.0f;
    if (text == "enclosed") return;
    const auto numbers = [](const std::string& of, size_t count)
    {
        Result<std::vector<float>> n = parseNumbers(of, {count});
        if (!n) throw CLI::ValidationError("--space", n.error().message);
        return std::move(*n);
    };
    constexpr std::string_view kGround = "ground:", kWalk = "walk:";
    if (text.starts_with(kGround))
        open.ground = numbers(text.substr(kGround.size()), 1)[0];
    else if (text.starts_with(kWalk))
    {
        const size_t end = std::min(text.find(':', kWalk.size()), text.size());
        open.ground = numbers(text.substr(kWalk.size(), end - kWalk.size()), 1)[0];
        walk = text.substr(std::min(end + 1, text.size()));
        if (!(*open.ground > 0.0f)) throw CLI::ValidationError("--space", "walk needs a height above 0, as in walk:2.5:mesh.glb");
        if (walk.empty()) throw CLI::ValidationError("--space", "walk needs a height and a mesh, as in walk:2.5:mesh.glb");
    }
    else if (text.find(',') == std::string::npos)
        throw CLI::ValidationError(
            "--space", fmt::format("it can't be '{}'; give auto, enclosed, ground:METRES, walk:METRES:FILE or a box X,Y,Z,X,Y,Z", text));
    else
    {
        const std::vector<float> n = numbers(text, 6);
        open.box = Bounds{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    }
}

/// As --space takes it.
/// @param ground  metres above open ground that counted
std::string nameOf(const OpenSpace& open, const std::string& walk, float ground)
{
    if (!walk.empty()) return fmt::format("walk:{}:{}", ground, walk);
    if (ground > 0.0f) return fmt::format("ground:{}", ground);
    if (!open.box) return "enclosed";
    const vec3 low = open.box->low, high = open.box->high;
    return fmt::format("{},{},{},{},{},{}", low.x, low.y, low.z, high.x, high.y, high.z);
}

/// The settings with what a file of them, a budget and pins say. Errors: badArgument, fileError, badInput.
Result<PlaceSettings> settingsOf(const PlaceOptions& options)
{
    PlaceSettings settings = options.settings;
    PointSettings baked; // that the budget is counted for
    const Result<std::optional<PointSettings>> quality = options.quality.load();
    if (!quality) return quality.error();
    if (*quality)
    {
        baked = **quality;
        if (options.quality.command->count("--method") == 0 && settings.method != PlaceSettings::Method::grid)
            if (const auto status = applyPlacement(settings, (*quality)->placement); !status) return status.error();
        // A budget or a grid decides the number of probes by itself.
        if ((*quality)->probes > 0 && options.memory == 0 && settings.method != PlaceSettings::Method::grid)
            options.quality.take("--count", settings.count, (*quality)->probes);
    }
    if (options.memory > 0)
    {
        if (!*quality || options.quality.command->count("--resolution") > 0) baked.resolution = options.resolution;
        if (!*quality || options.quality.command->count("--compact") > 0) baked.compact = options.compact;
        const Result<uint32_t> count = countFor(options.memory, baked);
        if (!count) return count.error();
        settings.count = *count;
    }
    if (options.pins.empty()) return settings;
    Result<std::vector<Pin>> pins = loadPins(options.pins);
    if (!pins) return pins.error();
    settings.pins = std::move(*pins);
    if (options.memory == 0) return settings;
    // Added probes stand beside the count, so the budget's count must leave room for them. It may not fall to 0, which would ask for as
    // many as the coverage takes.
    const auto added = uint64_t(std::ranges::count_if(settings.pins, [](const Pin& pin) { return pin.kind == Pin::Kind::add; }));
    if (added >= settings.count)
        return Error{ErrorCode::badArgument,
                     fmt::format("--memory holds {} probes but --pin adds {}; raise the budget or add fewer.", settings.count, added)};
    settings.count -= uint32_t(added);
    return settings;
}

/// What a script judges the placement by; the lines for people are the part of it that tells whether to place anew.
Json reportOf(const PlaceOptions& options, const ProbeSet& set, const PlaceReport& report)
{
    Json json;
    json["probes"] = set.probes.size();
    json["method"] = set.method;
    if (set.grid) json["grid"] = {set.grid->count.x, set.grid->count.y, set.grid->count.z};
    json["seed"] = set.seed;
    json["coverage"] = {{"rays", report.coverageRays}, {"area", report.coverageArea}, {"best_possible", report.bestPossible}};
    json["median_cosine"] = report.medianCosine;
    json["median_distance"] = report.medianDistance;
    json["reachable"] = {
        {"volume", report.reachableVolume}, {"low", toJson(report.reachable.low)}, {"high", toJson(report.reachable.high)}};
    json["space"] = nameOf(options.settings.open, options.walk, report.ground);
    json["surface_left_out"] = report.surfaceLeftOut;
    json["voxel"] = report.voxel;
    json["clearance"] = report.clearance;
    json["candidates"] = report.candidates;
    json["grid_outside"] = report.gridOutside;
    json["warnings"] = report.warnings;
    return json;
}

int runPlace(const PlaceOptions& options, const Context& context)
{
    const Stopwatch watch;
    for (const std::string& name : {options.output, options.explain})
        if (!name.empty())
            if (Status fine = writable(name); !fine) return fail(fine.error());
    // With the pins before the scene, which takes longer to read than they take to be refused.
    Result<PlaceSettings> settings = settingsOf(options);
    if (!settings) return fail(settings.error());
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    std::optional<Scene> walk;
    std::optional<Visibility> onWalk;
    if (!options.walk.empty())
    {
        Result<Scene> mesh = loadGltf(options.walk);
        if (!mesh) return fail(mesh.error());
        walk = std::move(*mesh);
        Result<Visibility> seen = Visibility::build(*walk);
        if (!seen) return fail(seen.error());
        onWalk.emplace(std::move(*seen));
        settings->open.walk = &*onWalk;
    }
    PlaceReport report;
    Result<ProbeSet> set = placeProbes(*scene, *settings, report, consoleProgress(context));
    if (!set) return fail(set.error());
    for (const std::string& warning : report.warnings) note(context, fmt::format("Note: {}", warning));
    if (set->scene.empty()) set->scene = scene->name;
    if (Status status = saveProbes(*set, options.output); !status) return fail(status.error());

    // After the probes, which are then safe whatever becomes of the picture.
    if (!options.explain.empty())
        if (Status status = writePng(report.picture.rgb, report.picture.width, report.picture.height, options.explain); !status)
            return fail(status.error());

    Json json = reportOf(options, *set, report);
    addCost(json, watch);
    if (context.json)
        print(json);
    else
        std::cout << set->probes.size() << " probes (" << set->method << ") in " << options.output << "\n"
                  << "surface that rays hit and some probe sees: " << 100.0f * report.coverageRays << " %; by area "
                  << 100.0f * report.coverageArea << " %\n"
                  << "reachable space (" << nameOf(options.settings.open, options.walk, report.ground) << "): " << report.reachableVolume
                  << " m^3, cells of " << report.voxel << " m; it leaves out " << 100.0f * report.surfaceLeftOut
                  << " % of the scene's surface\n"
                  << json["seconds"] << " s, " << json["peak_rss_mb"] << " MB" << std::endl;
    return exitOk;
}

} // namespace

void addPlaceCommand(CLI::App& app, Context& context)
{
    CLI::App* command = addCommand(app, context, "place", "Decides where the probes of a scene go and writes probes.json");
    // Shared: the line is parsed after this returns, and onChosen() keeps the options alive for the functions below.
    auto options = std::make_shared<PlaceOptions>();
    PlaceSettings& settings = options->settings;
    options->scene.add(command);
    command->add_option("-o,--output", options->output, "probes.json to write (required)")->required()->type_name("FILE");
    addChoice(command, "--method", settings.method, knobs::method);
    command
        ->add_option_function<std::string>(
            "--grid",
            [&settings](const std::string& text)
            {
                const Result<std::vector<uint32_t>> n = parseSize(text, 3);
                // As CLI11's own error, so that it ends as a usage error like those of all other options.
                if (!n) throw CLI::ValidationError("--grid", n.error().message);
                settings.grid = {int((*n)[0]), int((*n)[1]), int((*n)[2])};
                settings.method = PlaceSettings::Method::grid;
            },
            described("Probes along each axis of the grid; implies --method grid", words("chosen from --count"),
                      fmt::format("in all {}", rangeText(knobs::count))))
        ->type_name("NxNxN");
    CLI::Option* count = addKnob(command, "--count", settings.count, knobs::count);
    // A budget is a count said in bytes: given both, one would have to be ignored.
    addKnob(command, "--memory", options->memory, knobs::mapBytes, "BYTES")->excludes(count);
    addKnob(command, "--resolution", options->resolution, knobs::resolution, "TEXELS",
            "That the field will be baked with; only --memory asks");
    command->add_flag("--compact", options->compact,
                      described("That the field will be baked so; only --memory asks", defaultText(knobs::compact)));
    command
        ->add_option(
            "--pin", options->pins,
            described("Positions you decide, in the form of probes.json: \"pin\": \"keep\" stays (as does a probe that says nothing), "
                      "\"add\" stays beside --count, \"forbid\" with \"radius\" in metres allows no probe there; not with a grid",
                      words("none")))
        ->type_name("FILE");
    addSwitch(command, "--fit-grid", settings.fitGrid, knobs::fitGrid);
    addKnob(command, "--coverage", settings.coverage, knobs::coverage, "F", knobs::coverage.what);
    command
        ->add_option_function<std::vector<std::string>>(
            "--inside",
            [&settings](const std::vector<std::string>& texts)
            {
                for (const std::string& text : texts)
                {
                    const Result<std::vector<float>> n = parseNumbers(text, {3});
                    if (!n) throw CLI::ValidationError("--inside", n.error().message);
                    settings.inside.emplace_back((*n)[0], (*n)[1], (*n)[2]);
                }
            },
            described("A point in the space that counts, metres; may be given again",
                      words("the cameras, else the largest enclosed region")))
        // One value each time, or the option would take the arguments that follow it for more points.
        ->expected(1)
        ->take_all()
        ->type_name("X,Y,Z");
    command
        ->add_option_function<std::string>(
            "--space", [options = options.get()](const std::string& text) { readSpace(text, options->settings.open, options->walk); },
            described(fmt::format(
                          "The space that counts: enclosed is rooms, courts and streets; ground:METRES also what lies no higher than that "
                          "above any ground one can stand on, out to the scene's box; walk:METRES:FILE above the triangles of a glTF "
                          "instead, as a navigation mesh has them; X,Y,Z,X,Y,Z all free space in that box and nothing else; auto is "
                          "enclosed, or ground:{} where a camera, or a point given with --inside, is on open ground and hardly any of it "
                          "is enclosed",
                          kStanding),
                      words("auto")))
        ->type_name("auto|enclosed|ground:METRES|walk:METRES:FILE|BOX");
    command
        ->add_option_function<std::string>(
            "--explain", [options = options.get()](const std::string& file) { options->explain = file, options->settings.explain = true; },
            described("Also writes a picture: plan and section, probes white, surface seen well green, badly yellow, not at all red",
                      words("none")))
        ->type_name("FILE.png");
    addKnob(command, "--seed", settings.seed, knobs::placeSeed);
    addKnob(command, "--clearance", settings.clearance, knobs::clearance, "METRES");
    options->quality.add(command);
    onChosen(command, context, options, runPlace);
}

} // namespace sconce::tools
