// sconce reference and compare: the path-traced truth, and how far a picture is from it.
#include <cmath>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "bench/reference/metrics.h"
#include "bench/reference/reference.h"
#include "bench/sweep/kept_reference.h"
#include "bench/sweep/keys.h"
#include "runtime/scene/shape_meshes.h"
#include "tools/light_group_options.h"
#include "tools/moving_shape_options.h"
#include "tools/pictures.h"

namespace sconce::tools
{

namespace
{

const std::vector<std::string> kReferenceLayers = {
    "beauty", "direct", "diffuse_indirect", "glossy_indirect", "depth", "normal", "albedo", "roughness",
};

struct ReferenceOptions
{
    SceneOptions scene;
    CameraOptions camera;
    PictureOptions pictures;
    ReferenceSettings settings;
    double until = knobs::pathsUntil.value;
    std::string keep;
    MovingShapeOptions shapes;
    std::vector<std::string> groups, dims;
};

/// Traced in batches until its noise is small enough, each kept, or at once.
Result<KeptReference> traced(const Scene& scene, const ReferenceSettings& settings, const ReferenceOptions& options,
                             const Progress& progress)
{
    if (options.keep.empty())
    {
        auto once = renderReference(scene, settings, progress);
        if (!once) return once.error();
        return KeptReference{std::move(*once), settings.samples};
    }
    if (std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, std::move(fault)};
    const Result<RayScene> rays = RayScene::create(scene);
    if (!rays) return rays.error();
    return keptReference(*rays, keyOf(scene), settings, {options.keep, options.until}, progress);
}

int runReference(const ReferenceOptions& options, const Context& context)
{
    const Stopwatch watch;
    if (const std::string problem = options.pictures.problem(kReferenceLayers); !problem.empty())
        return fail(ErrorCode::badArgument, problem);
    if (Status status = options.pictures.writable(); !status) return fail(status.error());
    const Result<std::vector<LightGroupDesc>> groups = groupsOf(options.groups);
    if (!groups) return fail(groups.error());
    const Result<std::vector<MovingShape>> shapes = options.shapes.read();
    if (!shapes) return fail(shapes.error());
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return fail(scene.error());
    addShapes(*scene, *shapes);
    if (!groups->empty() || !options.dims.empty())
        if (const auto dimmed = dimScene(*scene, *groups, options.dims); !dimmed) return fail(dimmed.error());
    const Result<Camera> camera = options.camera.choose(*scene);
    if (!camera) return fail(camera.error());
    ReferenceSettings settings = options.settings;
    settings.camera = *camera;
    if (options.until > 0.0 && options.keep.empty())
        return fail(ErrorCode::badArgument, "--until adds batches of paths, which are kept; give the folder with --keep.");
    const Result<KeptReference> kept = traced(*scene, settings, options, consoleProgress(context));
    if (!kept) return fail(kept.error());
    const Reference* const reference = &kept->reference;
    const uint64_t paths = kept->paths;
    if (reference->nonFinitePaths > 0)
        note(context, fmt::format("Note: {} paths were not finite and were left out.", reference->nonFinitePaths));
    Json json;
    json["spp"] = paths;
    json["bounces"] = settings.bounces;
    json["estimated_relmse"] = reference->estimatedRelMse;
    json["non_finite_paths"] = reference->nonFinitePaths;
    if (Status status = options.pictures.write(std::move(reference->images), json); !status) return fail(status.error());
    addCost(json, watch);
    if (context.json)
        print(json);
    else
        std::cout << options.pictures.output << ": " << settings.width << "x" << settings.height << ", " << paths
                  << " paths a pixel, estimated relMSE " << json["estimated_relmse"] << ", " << json["seconds"] << " s, "
                  << json["peak_rss_mb"] << " MB" << std::endl;
    return exitOk;
}

struct CompareOptions
{
    std::string picture, reference, metrics = "mse,relmse,psnr,flip,mean", diff, sideBySide, layer = "beauty";
    std::vector<std::string> limits;
    std::optional<float> exposure;
    bool sameSurface = false, newSurface = false;
    std::string before;
};

int runCompare(const CompareOptions& options, const Context& context)
{
    CompareSettings settings;
    settings.layer = options.layer;
    settings.exposure = options.exposure;
    settings.sameSurface = options.sameSurface;
    std::map<std::string, bool*> wanted{
        {"mse", &settings.mse}, {"relmse", &settings.relMse}, {"psnr", &settings.psnr}, {"flip", &settings.flip}, {"mean", &settings.mean}};
    // All metrics are on by default, but a list means no others.
    for (auto& [name, flag] : wanted) *flag = false;
    for (const std::string& name : split(options.metrics, ','))
    {
        if (!wanted.contains(name))
            return fail(ErrorCode::badArgument,
                        fmt::format("--metric: there is no metric '{}'; there are mse, relmse, psnr, flip, mean.", name));
        *wanted[name] = true;
    }
    std::vector<std::pair<std::string, float>> limits;
    for (const std::string& limit : options.limits)
    {
        const std::vector<std::string> parts = split(limit, '=');
        const Result<std::vector<float>> value = parseNumbers(parts.back(), {1});
        if (parts.size() != 2 || !wanted.contains(parts[0]) || !value)
            return fail(
                ErrorCode::badArgument,
                fmt::format("--fail-above: '{}' is not METRIC=X with a metric of mse, relmse, psnr, flip, mean and a number.", limit));
        // A limit asks for its metric as well: without a number there would be nothing to compare with it.
        *wanted[parts[0]] = true;
        limits.emplace_back(parts[0], value->front());
    }

    // Read last: a wrong metric or limit costs no waiting.
    const Result<ImageSet> picture = readExr(options.picture);
    if (!picture) return fail(picture.error());
    const Result<ImageSet> reference = readExr(options.reference);
    if (!reference) return fail(reference.error());
    std::optional<ImageSet> before;
    if (!options.before.empty())
    {
        Result<ImageSet> read = readExr(options.before);
        if (!read) return fail(read.error());
        before = std::move(*read);
        settings.before = &*before;
        settings.newSurface = options.newSurface;
    }
    const Result<CompareResult> result = compareImages(*picture, *reference, settings);
    if (!result) return fail(result.error());
    if (!options.diff.empty())
        if (Status status = writeErrorMap(*result, options.diff); !status) return fail(status.error());
    if (!options.sideBySide.empty())
        if (Status status = writeSideBySide(*picture, *reference, settings, *result, options.sideBySide); !status)
            return fail(status.error());

    const std::pair<const char*, std::optional<double>> values[] = {
        {"mse", result->mse}, {"relmse", result->relMse}, {"psnr", result->psnr}, {"flip", result->flip}, {"mean", result->mean}};
    Json json;
    json["width"] = result->width;
    json["height"] = result->height;
    json["layer"] = options.layer;
    json["non_finite_pixels"] = result->nonFinitePixels;
    json["other_surface_pixels"] = result->otherSurfacePixels;
    for (const auto& [name, value] : values)
        if (value) json[name] = *value; // psnr of equal pictures is infinite: null
    if (result->relMseUnsure) json["relmse_unsure"] = *result->relMseUnsure;
    json["missed"] = Json::array();
    bool missed = false;
    // PSNR alone is better where it is higher.
    for (const auto& [name, limit] : limits)
        for (const auto& [metric, value] : values)
            if (metric == name && !(name == "psnr" ? *value >= limit : *value <= limit)) // not a number misses, too
            {
                missed = true;
                json["missed"].push_back(name);
                if (!context.quiet) std::cerr << "sconce: " << name << " is " << *value << ", the limit is " << limit << "." << std::endl;
            }
    if (context.json)
        print(json);
    else
        for (const auto& [name, value] : values)
            if (value) std::cout << name << " " << *value << (std::string(name) == "psnr" ? " dB" : "") << std::endl;
    return missed ? exitThreshold : exitOk;
}

} // namespace

void addReferenceCommands(CLI::App& app, Context& context)
{
    CLI::App* reference = addCommand(app, context, "reference", "Path traces a picture: the truth that others are compared with");
    auto options = std::make_shared<ReferenceOptions>();
    ReferenceSettings& settings = options->settings;
    options->scene.add(reference);
    options->camera.add(reference);
    addSize(reference, settings.width, settings.height);
    addKnob(reference, "--spp", settings.samples, knobs::paths);
    addKnob(reference, "--until", options->until, knobs::pathsUntil, "RELMSE");
    reference
        ->add_option(
            "--keep", options->keep,
            described("Folder in which pictures are kept, by all that they depend on: the same is not traced twice, and --until goes on "
                      "where it was interrupted",
                      words("none")))
        ->type_name("FOLDER");
    addKnob(reference, "--bounces", settings.bounces, knobs::pathBounces);
    addKnob(reference, "--roughness", settings.roughness, knobs::roughness, "R");
    addKnob(reference, "--seed", settings.seed, knobs::pathSeed);
    addSwitch(reference, "--pixel-centre", settings.pixelCentre, knobs::pixelCentre);
    addSwitch(reference, "--parts", settings.parts, knobs::parts);
    options->shapes.add(reference);
    addGroups(reference, options->groups, "Lights for --dim");
    addDims(reference, options->dims);
    options->pictures.add(reference, kReferenceLayers);
    onChosen(reference, context, options, runReference);

    CLI::App* compare =
        addCommand(app, context, "compare", "Measures how far a picture is from a reference; exit 1 when a limit is missed");
    auto compareOptions = std::make_shared<CompareOptions>();
    compare->add_option("PICTURE", compareOptions->picture, "EXR that is judged")->required()->type_name("");
    compare->add_option("REFERENCE", compareOptions->reference, "EXR that is the truth")->required()->type_name("");
    compare
        ->add_option(
            "--metric", compareOptions->metrics,
            described(
                "Of mse, relmse (error^2 / (reference^2 + 0.01)), psnr (dB), flip (0..1), mean (over the reference's), separated by commas",
                words("all")))
        ->type_name("LIST");
    compare
        ->add_option("--fail-above", compareOptions->limits,
                     described("Exit 1 when the metric is above X (psnr: below X); may be given again", words("no limit")))
        ->expected(1)
        ->take_all()
        ->type_name("METRIC=X");
    compare->add_option("--layer", compareOptions->layer, described("Layer that is compared", compareOptions->layer))->type_name("NAME");
    compare
        ->add_option("--exposure", compareOptions->exposure,
                     described("For psnr, flip and --side-by-side",
                               words("from the reference's log-average, flip over a sweep of exposures"), rangeText(knobs::exposure)))
        ->check(checkOf(knobs::exposure))
        ->type_name("FACTOR");
    compare->add_flag("--same-surface", compareOptions->sameSurface,
                      described(fmt::format("Leave out pixels where the layer depth of both differs by over {:g} %: where they see another "
                                            "surface, light can't be compared",
                                            100.0f * kOtherSurface),
                                words("all pixels count")));
    CLI::Option* before =
        compare
            ->add_option("--changed-from", compareOptions->before,
                         described(fmt::format("Another reference, before something came: of surfaces that stayed only pixels count whose "
                                               "light has changed by over {:g} %",
                                               100.0f * kChanged),
                                   words("all pixels count")))
            ->type_name("EXR");
    compare
        ->add_flag("--new-surface", compareOptions->newSurface,
                   described("With --changed-from: the pixels that show another surface, in their place", words("off")))
        ->needs(before);
    compare
        ->add_option("-o,--output", compareOptions->diff,
                     described("PNG of the error in false colours: flip, or relative error without flip", words("none")))
        ->type_name("FILE");
    compare
        ->add_option("--side-by-side", compareOptions->sideBySide,
                     described("PNG of the layer of both, tone-mapped alike, and the error in false colours", words("none")))
        ->type_name("FILE");
    onChosen(compare, context, compareOptions, runCompare);
}

} // namespace sconce::tools
