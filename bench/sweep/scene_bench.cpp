#include "bench/sweep/scene_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <sys/resource.h>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "base/safe_file.h"
#include "bench/opponents/traced_picture.h"
#include "bench/race/ray_file.h"
#include "bench/race/scene_rays.h"
#include "bench/reference/metrics.h"
#include "bench/sweep/kept_reference.h"
#include "bench/sweep/keys.h"
#include "bench/sweep/picture_files.h"
#include "bench/sweep/point_json.h"
#include "runtime/bake/bake.h"
#include "runtime/field/field_space.h"
#include "scene/scene_check.h"

namespace sconce
{
namespace
{

constexpr uint32_t kTimerScopes = 32;
constexpr uint32_t kTemporalFrames = 16; // of a still camera, before a picture that is filtered over time is judged
constexpr const char* kLayers[][2] = {{"beauty", "beauty"}, {"diffuse", "diffuse_indirect"}, {"glossy", "glossy_indirect"}};
constexpr uint32_t kJudgedMaps = 128;                           // texels, of grids to choose among
constexpr uint32_t kJudgedRays = 65536, kFewestJudgedRays = 64; // of all probes of a volume on such a grid, and of one at least
constexpr uint64_t kPathSeed = 1000;                            // the path tracer's paths are not the reference's

// Of look-ups: metres along the normal, and times as far towards the viewer: as far, not at all, and as Majercik et al. 2021 publish.
constexpr float kLookUpBiases[] = {0.0f, 0.05f, 0.1f, 0.2f, 0.4f, 0.8f, 1.6f, 3.2f}, kLookUpViews[] = {1.0f, 0.0f, 4.0f};

double secondsNow()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuSeconds() // of all threads
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

} // namespace

SceneBench::SceneBench(Gpu& lent, std::string deviceName, Desc made)
    : gpu(lent), device(std::move(deviceName)), desc(std::move(made)), fields({gpu, desc.scene, desc.folder, device, desc.build})
{
}

Result<std::unique_ptr<SceneBench>> SceneBench::create(Gpu& gpu, std::string deviceName, Desc desc, const PointSettings& defaults,
                                                       const Progress& progress)
{
    if (std::string fault = validate(desc.scene); !fault.empty()) return Error{ErrorCode::badInput, std::move(fault)};
    std::unique_ptr<SceneBench> made(new SceneBench(gpu, std::move(deviceName), std::move(desc)));
    for (const char* name : {"cache/probes", "cache/fields", "cache/references", "cache/points", "images", "replay"})
    {
        std::error_code problem;
        std::filesystem::create_directories(made->desc.folder / name, problem);
        if (problem)
            return Error{ErrorCode::fileError, fmt::format("The folder '{}' can't be made: {}; give another one with -o.",
                                                           made->desc.folder.string(), problem.message())};
    }
    if (made->desc.camera)
        made->camera = *made->desc.camera;
    else if (!made->desc.scene.cameras.empty())
        made->camera = made->desc.scene.cameras.front();
    else
    {
        auto probes = made->fields.probesFor(defaults, progress);
        if (!probes) return probes.error();
        const std::vector<PlacedProbe>& placed = probes->set.probes;
        made->camera.eye = placed.front().position;
        const vec3 target = placed.size() > 1 ? placed[1].position : made->desc.scene.bounds().centre();
        made->camera.forward = glm::normalize(target - made->camera.eye);
        // Looking straight up or down, the world's up gives the picture no direction.
        const vec3 world = std::abs(made->camera.forward.y) > 0.999f ? vec3(0.0f, 0.0f, -1.0f) : vec3(0.0f, 1.0f, 0.0f);
        made->camera.up = glm::normalize(world - glm::dot(world, made->camera.forward) * made->camera.forward);
    }
    if (!made->desc.settings.judgeGrids) return made;
    SceneBench& bench = *made;
    made->fields.judgeGrids([&bench](const ProbeGrid& grid, const PointSettings& settings) { return bench.wrongOnGrid(grid, settings); },
                            Json{toJson(bench.camera.eye), toJson(bench.camera.forward)}.dump());
    return made;
}

std::string SceneBench::pointKey(const PlannedPoint& point) const
{
    const BenchSettings& s = desc.settings;
    Json all = {{"build", desc.build},
                {"device", device},
                {"scene", fields.sceneKey()},
                {"method", point.settings.method},
                {"settings", settingsJson(point.settings)},
                {"size", {s.width, s.height}},
                {"camera", {toJson(camera.eye), toJson(camera.forward), toJson(camera.up), camera.verticalFov}},
                {"rays", s.rays},
                {"reference", {s.referencePaths, s.referenceBounces, s.referenceUntil}},
                {"seed", s.seed},
                {"frames", s.frames}};
    if (point.settings.frame.roughness) all["roughness"] = *point.settings.frame.roughness;
    if (point.settings.opponent()) // what lights its maps is a field of ours
        all["light"] = {point.settings.lightResolution, point.settings.surfaceTexels, point.settings.surfaceRays,
                        point.settings.surfaceRefined, point.settings.fieldGather};
    return keyOf(all);
}

std::optional<Json> SceneBench::kept(const PlannedPoint& point) const
{
    std::optional<Json> json = readJson(fields.cached("points", pointKey(point), ".json"));
    if (!json) return {};
    (*json)["id"] = point.id; // the same settings may be another knob's default
    (*json)["knob"] = point.knob;
    (*json)["value"] = point.value;
    return json;
}

Status SceneBench::keep(const PlannedPoint& point, const Json& measured) const
{
    return writeText(fields.cached("points", pointKey(point), ".json"), measured.dump(1));
}

/// What a grid is chosen by: rays that the method's own tracer answers wrongly on it, by small maps; of a volume the error of its diffuse
/// light in the picture that is judged.
Result<double> SceneBench::wrongOnGrid(const ProbeGrid& grid, const PointSettings& settings)
{
    if (const std::optional<Volume> volume = settings.volume())
    {
        auto field = volumeOn(bareGrid(desc.scene, grid), settings, *volume, {},
                              std::clamp(kJudgedRays / settings.probes, kFewestJudgedRays, VolumeSettings().rays));
        if (!field) return field.error();
        auto light = makeLightField(gpu, *field);
        if (!light) return light.error();
        auto renderer = rendererOf(settings, *light, settings.frame, {});
        if (!renderer) return renderer.error();
        return diffuseError(settings, **renderer);
    }
    std::vector<vec3> positions;
    for (int z = 0; z < grid.count.z; ++z)
        for (int y = 0; y < grid.count.y; ++y)
            for (int x = 0; x < grid.count.x; ++x) positions.push_back(grid.origin + grid.step * vec3(x, y, z));
    BakeSettings bake;
    bake.resolution = kJudgedMaps;
    bake.chart = settings.chart();
    bake.bounces = bake.surfaceTexels = 0;
    bake.radiance = bake.prefiltered = false;
    bake.scene.light = {.emitterSamples = 0, .skySamples = 0, .sunShadow = knobs::sunShadow.least, .pointShadow = knobs::pointShadow.least};
    bake.grid = grid;
    BakeReport report; // rays ask where surfaces are, not how they are lit
    auto field = bakeLightField(gpu, desc.scene, positions, bake, {}, report);
    if (!field) return field.error();
    auto tracer = TracedMethod::create(
        gpu, std::move(*field), {.opponent = settings.opponent(), .quality = settings.quality, .lowFactor = settings.lowFactor}, "grid");
    if (!tracer) return tracer.error();
    const Result<TraceScore> score = (*tracer)->score(*rays);
    if (!score) return score.error();
    return 2.0 - score->right1 - score->right02;
}

/// Not kept: its light takes a minute at most.
Result<FieldData> SceneBench::volumeFor(const PointSettings& settings, Volume volume, Json& cost, const Progress& progress)
{
    Result<FieldData> places = Error{ErrorCode::badInput, "A volume has no probes."};
    if (volume == Volume::ddgiPlaced)
        places = fields.fieldFor(settings, cost, progress);
    else
    {
        auto probes = fields.probesFor(settings, progress);
        if (!probes) return probes.error();
        cost["probe_set"] = probes->name;
        cost["place_s"] = probes->report["seconds"];
        cost["coverage"] = probes->report["coverage"]["rays"];
        if (!probes->set.grid)
            return Error{ErrorCode::badArgument,
                         fmt::format("Volume {} needs placement grid, not {}.", volumeName(volume), settings.placement)};
        places = bareGrid(desc.scene, *probes->set.grid);
    }
    if (!places) return places;
    const double begin = secondsNow();
    const uint32_t probeRays = raysOfVolume(places->probes.size());
    auto made = volumeOn(std::move(*places), settings, volume, progress, probeRays);
    cost["bake_s"] = secondsNow() - begin;
    return made;
}

Result<FieldData> SceneBench::volumeOn(FieldData places, const PointSettings& settings, Volume volume, const Progress& progress,
                                       uint32_t raysOfProbe)
{
    VolumeSettings wanted;
    wanted.rays = raysOfProbe;
    wanted.bounces = settings.bounces;
    wanted.seed = desc.settings.seed;
    wanted.solids = checkScene(desc.scene).openEdgeShare <= kMostOpenEdges;
    return irradianceVolume(std::move(places), volume, *truth, wanted, progress);
}

Status SceneBench::makeReference(const std::optional<float>& roughness, const Progress& progress)
{
    ReferenceSettings settings;
    settings.width = desc.settings.width;
    settings.height = desc.settings.height;
    settings.samples = desc.settings.referencePaths;
    settings.bounces = desc.settings.referenceBounces;
    settings.seed = desc.settings.seed;
    // Compared pixel by pixel with frames that have one sample a pixel, at its centre: a filtered reference would show every edge as an
    // error.
    settings.pixelCentre = true; // as the rasteriser's
    settings.parts = true;       // so that its noise is no part of any error
    settings.roughness = roughness;
    settings.camera = camera;
    if (auto status = makeTruth(); !status) return status;
    auto kept = keptReference(*truth, fields.sceneKey(), settings,
                              {fields.cached("references", "", "").parent_path(), desc.settings.referenceUntil}, progress);
    if (!kept) return kept.error();
    Reference& reference = kept->reference;
    referenceJson = {{"spp", kept->paths},
                     {"bounces", settings.bounces},
                     {"seconds", kept->seconds},
                     {"estimated_relmse",
                      {{"beauty", numberOrNull(reference.estimatedRelMse)},
                       {"diffuse", numberOrNull(reference.estimatedRelMseDiffuse)},
                       {"glossy", numberOrNull(reference.estimatedRelMseGlossy)}}}};
    referenceImages = std::move(reference.images);
    settings.straight = true;
    settings.seed += kPathSeed; // noise of its own
    auto straight = keptReference(*truth, fields.sceneKey(), settings,
                                  {fields.cached("references", "", "").parent_path(), desc.settings.referenceUntil}, progress);
    if (!straight) return straight.error();
    lampsAndSky = straight->reference.images.find("diffuse_indirect")->pixels;
    return writeReferencePictures();
}

/// What surfaces get straight from lamps and sky is no part of what probes are compared by: a frame's own pass for it, of few samples and
/// a filter, would be an error that methods without surface light have for no reason of theirs. They are given it without error and at no
/// time.
void SceneBench::addLamps(const PointSettings& settings, RenderedFrame& frame) const
{
    if (!settings.givenLamps()) return;
    for (size_t i = 0; i < frame.beauty.size(); ++i)
    {
        const vec3 light = glm::make_vec3(lampsAndSky.data() + 3 * i);
        frame.diffuseIndirect[i] += light;
        frame.beauty[i] += light;
    }
}

Status SceneBench::writeReferencePictures()
{
    if (!desc.settings.pictures) return success();
    referenceJson["images"] = Json::object();
    for (const auto& [name, layer] : kLayers)
    {
        const std::string file = fmt::format("images/{}.reference.{}.half", desc.name, name);
        if (auto status =
                writeHalfPicture(desc.folder / file, referenceImages.width, referenceImages.height, referenceImages.find(layer)->pixels);
            !status)
            return status;
        referenceJson["images"][name] = file;
    }
    return success();
}

Status SceneBench::makeTruth()
{
    if (truth) return success();
    auto embree = RayScene::create(desc.scene);
    if (!embree) return embree.error();
    truth.emplace(std::move(*embree));
    return success();
}

Status SceneBench::prepare()
{
    if (rays) return success();
    if (auto status = makeTruth(); !status) return status;
    auto clock = GpuTimer::create(gpu, kTimerScopes);
    if (!clock) return clock.error();
    timer.emplace(std::move(*clock));
    auto set = sceneRays(desc.scene, *truth, desc.settings.rays, desc.settings.seed);
    if (!set) return set.error();
    rays = std::move(*set);
    return saveRays(*rays, desc.folder / "replay" / fmt::format("{}.rays", desc.name));
}

/// The scene as frames of a kind need it; made once.
Result<const DeviceScene*> SceneBench::sceneOf(const PointSettings& settings, const IndirectEffects& effects, const Progress& progress)
{
    // Frames differ in their scene by area lights alone: with shadow maps, or without where rays through the field shadow them.
    const bool given = settings.givenLamps();
    std::optional<DeviceScene>& scene = deviceScenes[given ? 2 : effects.fieldShadows ? 1 : 0];
    if (!scene)
    {
        DeviceSceneDesc wanted = sceneForFrames({.fieldShadows = effects.fieldShadows}, {});
        if (given) wanted.light.emitterSamples = wanted.light.skySamples = 0;
        auto uploaded = DeviceScene::create(gpu, desc.scene, fieldSpace(desc.scene.bounds()), wanted, progress);
        if (!uploaded) return uploaded.error();
        scene.emplace(std::move(*uploaded));
    }
    return &*scene;
}

uint64_t SceneBench::bytesOf(const PointSettings& settings)
{
    if (settings.pathTraced()) return 0;
    if (const std::optional<Volume> volume = settings.volume()) return uint64_t(settings.probes) * volumeWordsPerProbe(*volume) * 4;
    return uint64_t(settings.probes) * bytesPerProbe(settings.chart(), settings.resolution, settings.bakedSurfaceTexels(), false,
                                                     knobs::surfaceRefined.value, settings.compact);
}

Result<SceneBench::Live> SceneBench::enliven(const PlannedPoint& point, const Progress& progress)
{
    Live live;
    live.plan = &point;
    const PointSettings& settings = point.settings;
    if (settings.pathTraced() && !settings.filteredPaths()) return live;
    const std::optional<Volume> volume = settings.volume();
    if (auto status = settings.filteredPaths() ? makePicture(live, progress)
                      : volume                 ? makeVolume(live, *volume, progress)
                                               : makeTracer(live, progress);
        !status)
        return status.error();
    RenderSettings frame = settings.frame;
    if (const std::optional<Baseline> opponent = settings.opponent())
    {
        const gpu::LightFieldInfo& info = live.tracer->data().info;
        frame.lightShaders = lightPasses(*opponent);
        // The frame's rays start where the race's do, for every tracer.
        frame.normalOffset += baselineOffset(*opponent) / (info.diagonal * info.scale);
    }
    if (settings.filteredPaths()) showPaths(frame, settings.paths);
    if (settings.biasedLookUps())
    {
        const auto lookUps = lookUpsOf(live, frame, progress);
        if (!lookUps) return lookUps.error();
        live.fieldCost["look_up"] = {{"bias", lookUps->bias}, {"view", lookUps->view}};
        if (live.untraced)
        {
            if (auto status = moveLookUps(gpu, *live.untraced, lookUps->bias, lookUps->view); !status) return status.error();
        }
        else
            frame.lightShaders = lightPasses(*settings.opponent(), lookUps->bias, lookUps->view);
    }
    auto renderer = rendererOf(settings, live.untraced ? *live.untraced : live.tracer->lightField(), std::move(frame), progress);
    if (!renderer) return renderer.error();
    live.renderer = std::move(*renderer);
    return live;
}

/// Of a point whose look-ups have no bias of their own the one by which its diffuse light is least wrong in the picture that is judged.
Result<SceneBench::LookUps> SceneBench::lookUpsOf(Live& live, const RenderSettings& frame, const Progress& progress)
{
    const PointSettings& settings = live.plan->settings;
    if (knobs::lookUpBias.inRange(settings.lookUpBias)) return LookUps{settings.lookUpBias, settings.lookUpView};
    LookUps best{};
    double least = HUGE_VAL;
    std::unique_ptr<SceneRenderer> renderer;
    for (const float bias : kLookUpBiases)
        for (const float view : kLookUpViews)
        {
            if (bias == 0.0f && view != kLookUpViews[0]) continue; // there is nothing to share out
            RenderSettings own = frame;
            if (live.untraced)
            {
                if (auto status = moveLookUps(gpu, *live.untraced, bias, view); !status) return status.error();
            }
            else
                own.lightShaders = lightPasses(*settings.opponent(), bias, view);
            if (!live.untraced || !renderer)
            {
                auto made = rendererOf(settings, live.untraced ? *live.untraced : live.tracer->lightField(), std::move(own), progress);
                if (!made) return made.error();
                renderer = std::move(*made);
            }
            const Result<double> error = diffuseError(settings, *renderer);
            if (!error) return error.error();
            if (*error < least) least = *error, best = {bias, view};
        }
    return best;
}

/// relMSE of a point's diffuse light; endless where it isn't a number.
Result<double> SceneBench::diffuseError(const PointSettings& settings, SceneRenderer& renderer) const
{
    auto frame = renderer.render(camera);
    if (!frame) return frame.error();
    addLamps(settings, *frame);
    CompareSettings compared;
    compared.layer = "diffuse_indirect";
    compared.psnr = compared.flip = compared.mse = compared.mean = false;
    compared.sameSurface = true;
    const auto found = compareImages(lightLayers(*frame), referenceImages, compared);
    if (!found) return found.error();
    return std::isfinite(*found->relMse) ? *found->relMse : HUGE_VAL;
}

Result<std::unique_ptr<SceneRenderer>> SceneBench::rendererOf(const PointSettings& settings, const LightField& field, RenderSettings frame,
                                                              const Progress& progress)
{
    frame.width = desc.settings.width;
    frame.height = desc.settings.height;
    frame.seed = uint32_t(desc.settings.seed);
    if (const std::optional<Volume> volume = settings.volume())
    {
        frame.lightShaders.gather = volumePass(*volume);
        frame.effects.rough = frame.effects.glossy = frame.effects.mirror = false; // it holds none
    }
    auto scene = sceneOf(settings, frame.effects, progress);
    if (!scene) return scene.error();
    return SceneRenderer::create(gpu, **scene, field, frame);
}

Status SceneBench::makeTracer(Live& live, const Progress& progress)
{
    const PointSettings& settings = live.plan->settings;
    auto field = fields.fieldFor(settings, live.fieldCost, progress);
    if (!field) return field.error();
    auto tracer = TracedMethod::create(gpu, std::move(*field),
                                       {.opponent = settings.opponent(),
                                        .quality = settings.quality,
                                        .distanceBits = settings.distanceBits,
                                        .lowFactor = settings.lowFactor},
                                       live.plan->id);
    if (!tracer) return tracer.error();
    live.tracer = std::move(*tracer);
    live.fieldCost["probes"] = live.tracer->data().info.probeCount;
    live.fieldCost["bytes"] = bytesJson(live.tracer->bytes());
    return success();
}

Status SceneBench::makePicture(Live& live, const Progress& progress)
{
    auto picture = renderReference(*truth, pathSettings(*live.plan), progress);
    if (!picture) return picture.error();
    live.paths = std::move(picture->images);
    auto light = makeLightField(gpu, tracedPicture(desc.scene, live.paths));
    if (!light) return light.error();
    live.untraced.emplace(std::move(*light));
    return success();
}

Status SceneBench::makeVolume(Live& live, Volume volume, const Progress& progress)
{
    auto field = volumeFor(live.plan->settings, volume, live.fieldCost, progress);
    if (!field) return field.error();
    live.fieldCost["probes"] = field->info.probeCount;
    live.fieldCost["bytes"] = bytesJson(bytesByPart(*field));
    auto light = makeLightField(gpu, *field);
    if (!light) return light.error();
    live.untraced.emplace(std::move(*light));
    return success();
}

Result<Json> SceneBench::errorsOf(const ImageSet& picture) const
{
    Json errors = Json::object();
    for (const auto& [name, layer] : kLayers)
    {
        CompareSettings settings;
        settings.layer = layer;
        settings.psnr = false;
        settings.sameSurface = true; // what is blended is there by lot: elsewhere a method is judged by another surface's light
        auto compared = compareImages(picture, referenceImages, settings);
        if (!compared) return compared.error();
        errors[name] = {{"mse", numberOrNull(*compared->mse)},
                        {"relmse", numberOrNull(*compared->relMse)},
                        {"flip", numberOrNull(*compared->flip)},
                        {"mean", numberOrNull(*compared->mean)},
                        {"relmse_unsure", numberOrNull(compared->relMseUnsure.value_or(0.0))}};
    }
    return errors;
}

ReferenceSettings SceneBench::pathSettings(const PlannedPoint& point) const
{
    ReferenceSettings paths;
    paths.width = desc.settings.width;
    paths.height = desc.settings.height;
    paths.samples = point.settings.paths;
    paths.bounces = desc.settings.referenceBounces; // the truth's
    paths.seed = desc.settings.seed + kPathSeed;
    paths.roughness = point.settings.frame.roughness;
    paths.pixelCentre = true;
    paths.guides = false;
    paths.camera = camera;
    return paths;
}

Result<Json> SceneBench::measure(Live& live, const Progress& progress)
{
    const PlannedPoint& point = *live.plan;
    Json json = {{"id", point.id}, {"method", point.settings.method}, {"knob", point.knob}, {"value", point.value}};
    json["settings"] = settingsJson(point.settings);
    json["clock"] = point.settings.pathTraced() || software() ? "cpu" : "device";
    if (point.settings.pathTraced() && !live.renderer)
    {
        ReferenceSettings paths = pathSettings(point);
        paths.guides = true; // which of them tells what surface is seen
        auto picture = renderReference(*truth, paths, progress);
        if (!picture) return picture.error();
        auto errors = errorsOf(picture->images);
        if (!errors) return errors.error();
        json["error"] = std::move(*errors);
        json["wrong"] = wrongness(json, referenceImages.find("beauty")->pixels);
        return json;
    }
    json.update(live.fieldCost);
    if (live.tracer)
    {
        auto score = live.tracer->score(*rays);
        if (!score) return score.error();
        json["rays"] = raysJson(*score);
    }
    // A filter over time is judged when its history has filled, not by its first frame.
    const uint32_t last = point.settings.frame.effects.temporal ? kTemporalFrames - 1 : 0;
    for (uint32_t i = 0; i < last; ++i)
        if (const auto drawn = live.renderer->draw(camera, i); !drawn) return drawn.error();
    Result<RenderedFrame> frame = live.renderer->render(camera, last);
    if (!frame) return frame.error();
    if (point.settings.filteredPaths()) // direct light and emission are the paths' own: there is nothing to filter
    {
        const float* direct = live.paths.find("direct")->pixels.data();
        for (size_t i = 0; i < frame->beauty.size(); ++i)
            frame->beauty[i] = glm::make_vec3(direct + 3 * i) + frame->diffuseIndirect[i] + frame->glossyIndirect[i];
    }
    addLamps(point.settings, *frame);
    auto errors = errorsOf(lightLayers(*frame));
    if (!errors) return errors.error();
    json["error"] = std::move(*errors);
    if (point.settings.volume()) json["error"].erase("glossy"); // no reflections: compared by diffuse light and the whole picture
    json["wrong"] = wrongness(json, referenceImages.find("beauty")->pixels);
    if (desc.settings.pictures && point.knob == "default")
    {
        auto pictures = writePictures(point, *frame);
        if (!pictures) return pictures.error();
        json["images"] = std::move(*pictures);
    }
    if (!report(progress, "measure", 1.0)) return Error{ErrorCode::cancelled, "Interrupted; what was measured before is kept."};
    return json;
}

Result<Json> SceneBench::writePictures(const PlannedPoint& point, const RenderedFrame& frame)
{
    Json json = Json::object();
    std::string method = point.settings.method;
    std::ranges::replace(method, ' ', '-');
    const std::string stem = fmt::format("images/{}.{}.", desc.name, method);
    const ImageSet layers = lightLayers(frame);
    for (const auto& [name, layer] : kLayers)
    {
        if (point.settings.volume() && std::string_view(name) == "glossy") continue;
        const std::string file = fmt::format("{}{}.half", stem, name);
        if (auto status = writeHalfPicture(desc.folder / file, frame.width, frame.height, layers.find(layer)->pixels); !status)
            return status.error();
        json[name] = file;
    }
    if (point.settings.volume() || point.settings.pathTraced()) return json; // no ray was traced that could be counted
    const char* const counts[] = {"probe", "handoffs", "reads", "unresolved"};
    for (int part = 0; part < 4; ++part)
    {
        std::vector<uint32_t> numbers;
        for (size_t i = 0; i < frame.counts.size(); ++i)
            numbers.push_back(frame.depth[i] > 0.0f ? frame.counts[i][part] : gpu::kNoProbe); // no surface: no count
        const std::string file = fmt::format("{}{}.u32", stem, counts[part]);
        if (auto status = writeNumberPicture(desc.folder / file, frame.width, frame.height, numbers); !status) return status.error();
        json[counts[part]] = file;
    }
    return json;
}

bool SceneBench::software() const
{
    return gpu.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

Result<SceneBench::Passes> SceneBench::timeFrame(Live& live, uint32_t turn)
{
    Passes passes;
    const double cpu = cpuSeconds();
    const auto milliseconds = [cpu] { return 1e3 * (cpuSeconds() - cpu) / std::max(1u, std::thread::hardware_concurrency()); };
    if (live.plan->settings.pathTraced())
    {
        ReferenceSettings paths = pathSettings(*live.plan);
        // Other paths each turn, as the tracers' frames have other rays.
        paths.seed += turn;
        auto picture = renderReference(*truth, paths);
        if (!picture) return picture.error();
        passes.emplace_back("path tracing", milliseconds());
        if (!live.renderer) return passes;
    }
    const double before = milliseconds();
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            live.renderer->record(cmd, camera, turn + 1, &*timer);
        });
    if (!status) return status.error();
    const double used = milliseconds() - before;
    double sum = 0.0;
    const std::vector<GpuTimer::Scope> scopes = timer->read();
    for (const GpuTimer::Scope& scope : scopes) sum += scope.milliseconds;
    // Software's clock also runs while the cores work for others.
    const double share = software() && sum > 0.0 ? used / sum : 1.0;
    for (const GpuTimer::Scope& scope : scopes)
        if (!live.plan->settings.pathTraced() || std::string_view(scope.name).ends_with("denoise"))
            passes.emplace_back(scope.name, share * scope.milliseconds);
    return passes;
}

Json SceneBench::describe(std::span<const PlannedPoint> points) const
{
    const Scene& scene = desc.scene;
    const Bounds bounds = scene.bounds();
    const vec3 target = camera.eye + camera.forward;
    Json json = {{"name", desc.name},
                 {"source", desc.source},
                 {"triangles", scene.triangles.size()},
                 {"width", desc.settings.width},
                 {"height", desc.settings.height},
                 {"camera",
                  {{"name", camera.name},
                   {"eye", toJson(camera.eye)},
                   {"target", toJson(target)},
                   {"fov_degrees", glm::degrees(camera.verticalFov)}}},
                 {"bounds", {{"min", toJson(bounds.low)}, {"max", toJson(bounds.high)}}}};
    if (!points.empty() && points.front().settings.frame.roughness) json["roughness"] = *points.front().settings.frame.roughness;
    if (!referenceJson.is_null()) json["reference"] = referenceJson;
    std::vector<float> heights; // of our default's probes
    Json sets = Json::object();
    for (const PlannedPoint& point : points)
    {
        if (point.settings.pathTraced() || sets.contains(probeSetName(point.settings))) continue;
        const std::optional<BenchProbes> kept = fields.keptProbes(point.settings);
        if (!kept) continue;
        Json set = kept->report;
        set["probes"] = Json::array();
        for (const PlacedProbe& probe : kept->set.probes)
        {
            set["probes"].push_back({{"position", toJson(probe.position)}, {"why", probe.why}});
            if (&point == points.data()) heights.push_back(probe.position.y);
        }
        sets[kept->name] = std::move(set);
    }
    if (!heights.empty())
    {
        std::ranges::nth_element(heights, heights.begin() + ptrdiff_t(heights.size() / 2));
        const float height = heights[heights.size() / 2];
        json["plan"] = {{"height", height}, {"segments", sectionAt(scene, height)}};
    }
    json["probe_sets"] = std::move(sets);
    return json;
}

} // namespace sconce
