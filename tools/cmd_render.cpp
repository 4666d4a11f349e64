// sconce render: one frame as a host would draw it, with its passes timed.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "bench/opponents/baselines.h"
#include "runtime/field/field_stream.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/live_light.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/scene/scene_renderer.h"
#include "runtime/scene/shape_meshes.h"
#include "runtime/vulkan/host_vulkan.h"
#include "scene/scene_check.h"
#include "tools/field_report.h"
#include "tools/frame_pictures.h"
#include "tools/frame_setup.h"
#include "tools/from_field.h"
#include "tools/light_group_options.h"
#include "tools/live_light_options.h"
#include "tools/moving_shape_options.h"
#include "tools/pictures.h"
#include "tools/quality_option.h"

namespace sconce::tools
{

namespace
{

struct RenderOptions : FrameChoice
{
    SceneOptions scene;
    CameraOptions camera;
    PictureOptions pictures;
    std::string field, tracer = "ours", device;
    MovingShapeOptions shapes;
    bool drawnOnly = false;
    QualityOption quality;
    std::vector<std::string> groups, dims;
    std::string sunPath;
    bool fromField = false;
    float stereo = 0.0f;     // metres between the eyes; 0: one
    std::vector<float> lens; // k1, k2
    float warmUp = knobs::warmUpSeconds.value;
    uint32_t width = knobs::width.value, height = knobs::height.value, frames = knobs::drawnFrames.value;
    uint32_t resident = knobs::resident.value;
};

/// A light field as a picture needs it.
struct OpenedField
{
    FieldData data;
    std::optional<MapFile> maps; // of one whose maps come as they are asked for; `data` is without them then
};

Result<OpenedField> openFor(const RenderOptions& options)
{
    if (options.resident == 0)
    {
        Result<FieldData> data = loadFieldFor(options.field, options.tracer);
        if (!data) return data.error();
        return OpenedField{std::move(*data), std::nullopt};
    }
    if (options.tracer != "ours")
        return Error{ErrorCode::badArgument,
                     fmt::format("--tracer {} reads all maps; leave it out, or --resident {}.", options.tracer, options.resident)};
    Result<FieldAndMaps> opened = openField(options.field);
    if (!opened) return opened.error();
    return OpenedField{std::move(opened->field), std::move(opened->maps)};
}

/// What `light` becomes by the options of a day.
struct Day
{
    Lighting light;
    std::vector<SunPlace> path; // of the sun, a picture each; empty: it stays
};

/// Changes the scene's light as the options say. Errors: as lightFor(), and badArgument where something doesn't fit the field.
Result<Day> chooseLight(const RenderOptions& options, const FieldData& data, std::span<const LightGroupDesc> groups, Scene& scene)
{
    if (data.live.links == 0 && !options.sunPath.empty())
        return Error{
            ErrorCode::badArgument,
            fmt::format("The lights of light field '{}' can't move; bake it with --live-links, or leave --sun-path out.", options.field)};
    auto light = lightFor(data, groups, options.dims, scene);
    if (!light) return light.error();
    Day made{std::move(*light), {}};
    made.light.moves = made.light.moves || !options.sunPath.empty();
    if (made.light.moves && options.tracer != "ours")
        return Error{ErrorCode::badArgument,
                     fmt::format("--tracer {} finds no light that has moved; relight the field (`sconce relight`), or leave it out.",
                                 options.tracer)};
    if (options.sunPath.empty()) return made;
    if (const std::string fault = heldSunFault(made.light.fixed); !fault.empty())
        return Error{ErrorCode::badArgument, fmt::format("--sun-path: {}; bake '{}' without that group.", fault, options.field)};
    auto path = sunPath(options.sunPath, options.frames);
    if (!path) return path.error();
    made.path = std::move(*path);
    return made;
}

/// Frames of one picture.
struct Drawn
{
    RenderedFrame frame; // the last
    std::vector<double> frameMs;
    std::map<std::string, std::vector<double>> passMs;
    std::vector<std::string> passes; // in the order of the frame
    uint64_t deviceBytes = 0;
    std::optional<FieldStream::Counts> streamed;
};

/// Draws until all maps that the picture asks for are there, or as many as there is room for.
Status settleMaps(Gpu& gpu, SceneRenderer& renderer, FieldStream& stream, const Camera& camera, const Progress& progress)
{
    constexpr int kStill = 4; // frames without a change: some are in flight before what they ask for is known
    for (int still = 0; still < kStill;)
    {
        const FieldStream::Counts before = stream.counts();
        if (Status status = gpu.submit([&](VkCommandBuffer cmd) { stream.record(cmd, camera.eye); }); !status) return status;
        if (const auto times = renderer.draw(camera); !times) return times.error();
        if (Status status = stream.status(); !status) return status;
        const FieldStream::Counts counts = stream.counts();
        if (!progress("read maps", counts.resident == 0 ? 0.0 : double(counts.resident) / (counts.resident + counts.missing)))
            return Error{ErrorCode::cancelled, "Interrupted; nothing was written."};
        const bool changed = counts.read != before.read || counts.missing != before.missing || stream.state().reader->reads();
        still = changed ? 0 : still + 1;
    }
    return success();
}

Result<Drawn> drawFrames(Gpu& gpu, const Scene& scene, const LightField& field, const RenderSettings& settings, const Camera& camera,
                         uint32_t frames, float warmUp, FieldStream* stream, const Context& context)
{
    const Error interrupted{ErrorCode::cancelled, "Interrupted; nothing was written."};
    // After the effects are settled: frames that take no samples of emitters and sky need no shadow maps of them.
    const auto deviceScene =
        DeviceScene::create(gpu, scene, field.info(), sceneForFrames(settings.effects, field.info(), camera.eye), consoleProgress(context));
    if (!deviceScene) return deviceScene.error();
    const auto renderer = SceneRenderer::create(gpu, *deviceScene, field, settings);
    if (!renderer) return renderer.error();
    const Progress progress = consoleProgress(context);
    if (stream)
        if (Status status = settleMaps(gpu, **renderer, *stream, camera, progress); !status) return status.error();
    for (const Stopwatch watch; watch.seconds() < warmUp;)
    {
        if (!progress("warm up", watch.seconds() / warmUp)) return interrupted;
        const auto times = (*renderer)->draw(camera);
        if (!times) return times.error();
    }
    (*renderer)->cut(); // no history from the frames that warmed up
    Drawn drawn;
    for (uint32_t i = 0; i < frames; ++i)
    {
        if (!progress("render", double(i) / frames)) return interrupted;
        // With --temporal each frame draws rays of its own for the history to average; without, all are the same picture, timed again.
        auto times = (*renderer)->draw(camera, settings.effects.temporal ? i : 0);
        if (!times) return times.error();
        // The sum of the passes, not the wall clock: what the host does between them is not the frame's.
        double sum = 0.0;
        for (const GpuTimer::Scope& scope : *times)
        {
            sum += scope.milliseconds;
            if (!drawn.passMs.contains(scope.name)) drawn.passes.emplace_back(scope.name);
            drawn.passMs[scope.name].push_back(scope.milliseconds);
        }
        if (!times->empty()) drawn.frameMs.push_back(sum);
    }
    progress("render", 1.0);
    auto frame = (*renderer)->read();
    if (!frame) return frame.error();
    drawn.frame = std::move(*frame);
    drawn.deviceBytes = (*renderer)->deviceBytes();
    if (stream) drawn.streamed = stream->counts();
    return drawn;
}

/// The name of one of several pictures: a number before its extension.
std::string numbered(const std::string& file, uint32_t number)
{
    if (file.empty()) return file;
    const std::filesystem::path path(file);
    return (path.parent_path() / fmt::format("{}-{:04}{}", path.stem().string(), number, path.extension().string())).string();
}

/// What --quality says and the command line doesn't.
Status takeQuality(RenderOptions& options, Quality& tracer)
{
    const Result<std::optional<PointSettings>> quality = options.quality.load();
    if (!quality) return quality.error();
    if (*quality)
    {
        const RenderSettings& frame = (*quality)->frame;
        tracer = (*quality)->quality;
        if (options.areaSamples == 0) options.quality.take("--samples", options.areaSamples, frame.areaSamples);
        options.quality.take("--samples", options.samples, frame.glossyRays);
        options.quality.take("--no-denoise", options.noDenoise, !frame.effects.denoise);
        options.quality.take("--temporal", options.temporal, frame.effects.temporal);
        // Surface light is the default where the field holds it; where it holds none, the file that says so is drawn without.
        if (frame.effects.tracedDiffuse || frame.effects.patches || !frame.effects.surfaceLight)
            options.quality.take("--diffuse", options.diffuse,
                                 std::string(frame.effects.tracedDiffuse ? kTraced
                                             : frame.effects.patches     ? kPatches
                                                                         : kIrradiance));
        options.quality.take("--area-shadows", options.areaShadows, std::string(frame.effects.fieldShadows ? kField : kMaps));
        options.quality.take("--rays-below", options.raysBelow, frame.raysBelow);
        options.quality.take("--trace-every", options.traceEvery, frame.traceEvery);
        options.quality.take("--surface-probes", options.surfaceProbes, frame.surfaceProbes);
    }
    return success();
}

/// Means over the pixels that traced rays.
void addCounts(Json& json, const RenderedFrame& frame, uint32_t samples)
{
    double unknown = 0.0, fetches = 0.0, handoffs = 0.0, traced = 0.0;
    for (size_t i = 0; i < frame.counts.size(); ++i)
    {
        if (frame.counts[i].z == 0) continue;
        ++traced;
        handoffs += frame.counts[i].y;
        fetches += frame.counts[i].z;
        unknown += frame.counts[i].w;
    }
    json["traced_pixels"] = traced / double(frame.counts.size()); // share of the picture
    if (traced == 0.0) return;
    json["unknown_share"] = unknown / (traced * samples);
    json["fetches_per_ray"] = fetches / (traced * samples);
    json["handoffs_per_ray"] = handoffs / (traced * samples);
}

/// Shares of the pixels whose diffuse light is of surface light, by what it is from.
void addDiffuseFrom(Json& json, const RenderedFrame& frame)
{
    size_t all = 0;
    for (const size_t pixels : frame.diffuseFrom) all += pixels;
    if (all == 0) return;
    const char* const names[] = {"irradiance", "cells", "hidden", "nearest_texel", "one_probe", "two_probes"};
    for (size_t i = 0; i < frame.diffuseFrom.size(); ++i) json["diffuse_from"][names[i]] = double(frame.diffuseFrom[i]) / double(all);
}

double median(std::vector<double> values)
{
    std::ranges::sort(values);
    return values.empty() ? 0.0 : 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

/// A picture for each place of the sun, with light that has settled.
int drawDay(const RenderOptions& options, Gpu& gpu, Scene& scene, const LightField& field, LiveLight& live, const Day& day,
            const RenderSettings& settings, const Camera& camera, const EffectPlan& plan, const Context& context)
{
    const Stopwatch watch;
    Json json;
    for (uint32_t i = 0; i < day.path.size(); ++i)
    {
        std::vector<Light> lights = day.light.lights;
        turnSun(lights, day.path[i]);
        const auto milliseconds = settle(gpu, live, {lights, day.light.weights});
        if (!milliseconds) return fail(milliseconds.error());
        scene.lights = day.light.fixed;
        scene.lights.insert(scene.lights.end(), lights.begin(), lights.end());
        capScene(scene, plan);
        const Result<Drawn> drawn = drawFrames(gpu, scene, field, settings, camera, 1, 0.0f, nullptr, context);
        if (!drawn) return fail(drawn.error());
        PictureOptions pictures = options.pictures;
        pictures.output = numbered(options.pictures.output, i);
        pictures.png = numbered(options.pictures.png, i);
        Json one = {{"sun", toJson(day.path[i].direction)}, {"live_light_ms", *milliseconds}};
        if (Status status = pictures.write(imagesOf(drawn->frame), one); !status) return fail(status.error());
        if (!context.json) std::cout << pictures.output << "\n";
        json["pictures"].push_back(one);
    }
    addCost(json, watch);
    if (context.json) print(json);
    return exitOk;
}

View viewOf(const RenderOptions& options)
{
    View view{.width = options.width, .height = options.height, .samples = options.samples, .eyesApart = options.stereo};
    if (!options.lens.empty()) view.lens = {options.lens[0], options.lens[1]};
    return view;
}

/// A picture that no geometry is drawn for.
int drawWithoutGeometry(const RenderOptions& options, Gpu& gpu, const std::string& device, const LightField& field, const ViewRays& rays,
                        const Context& context)
{
    const Stopwatch watch;
    const std::optional<Baseline> baseline = baselineNamed(options.tracer);
    const Result<RayTracer> tracer = makeRayTracer(gpu, field, baseline ? traceRaysPass(*baseline) : RayShaders{});
    if (!tracer) return fail(tracer.error());
    FieldPicture drawn;
    std::vector<double> milliseconds;
    for (uint32_t i = 0; i < options.frames; ++i)
    {
        Result<FieldPicture> one = drawFromField(*tracer, rays, consoleProgress(context));
        if (!one) return fail(one.error());
        drawn = std::move(*one);
        if (drawn.milliseconds > 0.0) milliseconds.push_back(drawn.milliseconds);
    }
    Json json = {{"device", device},
                 {"tracer", options.tracer},
                 {"from_field", true},
                 {"samples", rays.samples()},
                 {"stereo", options.stereo},
                 {"lens", options.lens},
                 {"frames", options.frames},
                 {"dim", options.dims},
                 {"frame_ms", milliseconds.empty() ? Json(nullptr) : Json(median(milliseconds))},
                 {"rays", drawn.rays},
                 {"unknown_share", double(drawn.unknown) / double(drawn.rays)},
                 {"fetches_per_ray", drawn.fetchesPerRay},
                 {"handoffs_per_ray", drawn.handoffsPerRay}};
    if (Status status = options.pictures.write(std::move(drawn.images), json); !status) return fail(status.error());
    addCost(json, watch);
    if (context.json)
        print(json);
    else
        std::cout << fmt::format("{}: {}x{} from the field alone on {}, {} rays in {:f} ms, {:.3f} % that no probe could answer\n",
                                 options.pictures.output, rays.width(), rays.height(), device, drawn.rays, median(milliseconds),
                                 100.0 * double(drawn.unknown) / double(drawn.rays));
    return exitOk;
}

/// All that a picture is made of and that can be refused without a device, which takes longer to start than all of that together.
struct Asked
{
    Scene scene;
    Camera camera;
    EffectPlan plan;
    OpenedField opened;
    Day lighting;
    RenderSettings settings;
    std::string diffuse; // how diffuse light is read
    std::optional<ViewRays> fromField;
};

/// What stands on the device for it. Members go in the order in which they may: the last first.
struct OnDevice
{
    std::optional<OwnDevice> device;
    std::shared_ptr<Gpu> gpu;
    std::optional<LightField> field;
    std::optional<LightGroups> groups; // of a field that streams, whose maps go on to be mixed; others are dimmed once
    std::optional<FieldStream> stream;
    std::optional<LiveLight> live;
    std::optional<double> groupsMs;
    std::map<std::string, double> liveMs; // by pass
};

void noteWhatTheFieldLacks(const Asked& asked, const Context& context)
{
    const FieldData& data = asked.opened.data;
    if (!data.sceneName.empty() && data.sceneName != asked.scene.name)
        note(context, fmt::format("Note: the light field was baked from scene '{}', this is '{}'.", data.sceneName, asked.scene.name));
    // A field doesn't keep light apart by its source: what was baked of an effect can't be taken out of it here.
    for (const PlannedEffect& effect : asked.plan.effects)
        if (effect.ofScene && !effect.givenUp.empty() && std::ranges::find(data.effects, effect.name) != data.effects.end())
            note(context, fmt::format("Note: the light field was baked with {}, and what it holds of that stays in indirect light; bake "
                                      "with the same --effects.",
                                      effect.name));
}

Result<Asked> prepare(const RenderOptions& options, const Context& context)
{
    // Before the scene is loaded: a misspelt layer should cost no waiting.
    if (const std::string problem = options.pictures.problem(options.fromField ? kFieldLayers : frameLayers()); !problem.empty())
        return Error{ErrorCode::badArgument, problem};
    if (options.screenTrace && (options.frames < 2 || !options.sunPath.empty()))
        return Error{ErrorCode::badArgument,
                     fmt::format("--screen-trace shows what the frame before does, and {}; give --frames 2 or more{}.",
                                 options.sunPath.empty() ? "there is but one frame" : "each picture of --sun-path is a first one",
                                 options.sunPath.empty() ? "" : ", without --sun-path")};
    if (options.sunPath.empty()) // whose pictures have numbers
        if (Status status = options.pictures.writable(); !status) return status.error();
    const Result<std::vector<LightGroupDesc>> groups = groupsOf(options.groups);
    if (!groups) return groups.error();
    const Result<std::vector<MovingShape>> shapes = options.shapes.read();
    if (!shapes) return shapes.error();
    Result<Scene> scene = options.scene.load(context);
    if (!scene) return scene.error();
    const Result<Camera> camera = options.camera.choose(*scene);
    if (!camera) return camera.error();
    std::optional<ViewRays> fromField;
    if (options.fromField)
    {
        Result<ViewRays> rays = ViewRays::create(*camera, viewOf(options));
        if (!rays) return rays.error();
        fromField = std::move(*rays);
    }
    // The area pass has our tracer built in, which can't read an opponent's octahedral maps.
    if (options.areaShadows == kField && options.tracer != "ours")
        return Error{ErrorCode::badArgument,
                     fmt::format("--area-shadows field is traced by our tracer; leave it out, or --tracer {}.", options.tracer)};
    // The plan first, by what the whole scene calls for; what it gives up then goes, or it would leave shadow maps and passes behind.
    Result<EffectPlan> plan = planFor(options, *scene, !options.sunPath.empty());
    if (!plan) return plan.error();
    noteGivenUp(context, *plan);
    Result<OpenedField> opened = openFor(options);
    if (!opened) return opened.error();
    auto lighting = chooseLight(options, opened->data, *groups, *scene);
    if (!lighting) return lighting.error();
    capScene(*scene, *plan); // after the groups have found their lights
    std::string diffuse;
    Result<RenderSettings> settings = settingsFor(options, *plan, opened->data, options.field, diffuse);
    if (!settings) return settings.error();
    settings->layers = wantsLayersOfLight(options.pictures.aov);
    settings->width = options.width;
    settings->height = options.height;
    if (!options.drawnOnly) settings->shapes = *shapes;
    addShapes(*scene, *shapes); // after the plan: they call for nothing
    Asked asked{std::move(*scene),    *camera, std::move(*plan),    std::move(*opened), std::move(*lighting),
                std::move(*settings), diffuse, std::move(fromField)};
    noteWhatTheFieldLacks(asked, context);
    return asked;
}

/// The field in its light.
Status light(OnDevice& on, const Asked& asked)
{
    const Lighting& wanted = asked.lighting.light;
    if (wanted.moves)
    {
        auto live = makeLiveLight(*on.gpu, *on.field, asked.opened.data);
        if (!live) return live.error();
        on.live = std::move(*live);
        const auto settled = settle(*on.gpu, *on.live, {wanted.lights, wanted.weights});
        if (!settled) return settled.error();
        on.liveMs = *settled;
    }
    else if (!wanted.weights.empty())
    {
        auto groups = makeLightGroups(*on.gpu, *on.field, asked.opened.data);
        if (!groups) return groups.error();
        const Result<double> dimmed = dimField(*on.gpu, *groups, wanted.weights);
        if (!dimmed) return dimmed.error();
        on.groupsMs = *dimmed;
        if (on.field->state().maps) on.groups = std::move(*groups);
    }
    return success();
}

Status putOnDevice(OnDevice& on, const RenderOptions& options, const Quality& tracer, Asked& asked)
{
    Result<OwnDevice> device = OwnDevice::create({.device = options.device});
    if (!device) return device.error();
    on.device = std::move(*device);
    Result<std::shared_ptr<Gpu>> gpu = Gpu::create(on.device->host());
    if (!gpu) return gpu.error();
    on.gpu = std::move(*gpu);
    OpenedField& opened = asked.opened;
    Result<LightField> field = opened.maps ? makeStreamedField(*on.gpu, opened.data, std::move(*opened.maps), options.resident, tracer)
                                           : makeLightField(*on.gpu, opened.data, tracer);
    if (!field) return field.error();
    on.field = std::move(*field);
    if (Status status = light(on, asked); !status || options.resident == 0) return status;
    auto stream = makeFieldStream(*on.gpu, *on.field, {});
    if (!stream) return stream.error();
    on.stream = std::move(*stream);
    return success();
}

/// All that the picture depends on, so that it can be drawn again from what stands beside it, and what it took.
Json reportOf(const RenderOptions& options, const Asked& asked, const OnDevice& on, const Drawn& drawn)
{
    const RenderSettings& settings = asked.settings;
    Json json;
    json["device"] = on.device->name();
    json["tracer"] = options.tracer;
    json["effects"] = Json::object();
    for (const PlannedEffect& effect : asked.plan.effects) json["effects"][effect.name] = effect.on;
    json["effects"]["denoise"] = settings.effects.denoise;
    json["given_up"] = Json::object();
    for (const PlannedEffect& effect : asked.plan.effects)
        if (!effect.givenUp.empty()) json["given_up"][effect.name] = effect.givenUp;
    json["device_bytes"] = drawn.deviceBytes;
    json["samples"] = settings.glossyRays;
    json["trace_every"] = settings.traceEvery;
    json["surface_probes"] = settings.surfaceProbes;
    json["rays_below"] = settings.raysBelow;
    json["diffuse"] = asked.diffuse;
    json["area_shadows"] = options.areaShadows;
    json["temporal"] = settings.effects.temporal;
    json["screen_trace"] = settings.effects.screenTrace && (settings.effects.glossy || settings.effects.mirror);
    json["frames"] = options.frames;
    json["dim"] = options.dims;
    json["shapes"] = options.shapes.file;
    json["drawn_only"] = options.drawnOnly;
    if (on.groupsMs) json["light_groups_ms"] = *on.groupsMs;
    if (on.live)
    {
        json["live_light_ms"] = on.liveMs;
        json["live_device_bytes"] = on.live->deviceBytes();
    }
    if (drawn.streamed)
        json["stream"] = {
            {"resident", drawn.streamed->resident},
            {"missing", drawn.streamed->missing},
            {"read", drawn.streamed->read},
            {"full", drawn.streamed->full},
            {"field_device_bytes", on.field->deviceBytes() + on.stream->deviceBytes() + (on.groups ? on.groups->deviceBytes() : 0)}};
    json["frame_ms"] = drawn.frameMs.empty() ? Json(nullptr) : Json(median(drawn.frameMs));
    json["passes_ms"] = Json::object();
    for (const std::string& pass : drawn.passes) json["passes_ms"][pass] = median(drawn.passMs.at(pass));
    // Only the rays of reflections are counted, where layers tell what they cost; frames without have no means to give.
    if (settings.layers && (settings.effects.glossy || settings.effects.mirror)) addCounts(json, drawn.frame, settings.glossyRays);
    addDiffuseFrom(json, drawn.frame);
    json["clamped_pixels"] = drawn.frame.clamped;
    return json;
}

void sayTimes(const RenderOptions& options, const OnDevice& on, const Drawn& drawn)
{
    std::cout << options.pictures.output << ": " << options.width << "x" << options.height << " on " << on.device->name() << ", frame "
              << (drawn.frameMs.empty() ? std::string("not timed") : fmt::format("{:f} ms", median(drawn.frameMs))) << "\n";
    for (const std::string& pass : drawn.passes) std::cout << "  " << pass << ": " << median(drawn.passMs.at(pass)) << " ms\n";
    std::cout << std::flush;
}

int runRender(RenderOptions options, const Context& context)
{
    const Stopwatch watch;
    Quality tracer;
    if (const Status taken = takeQuality(options, tracer); !taken) return fail(taken.error());
    Result<Asked> asked = prepare(options, context);
    if (!asked) return fail(asked.error());
    OnDevice on;
    if (const Status status = putOnDevice(on, options, tracer, *asked); !status) return fail(status.error());
    const FieldData& data = asked->opened.data;
    if (asked->fromField)
    {
        if (data.radiance.empty())
            note(context,
                 "Note: the light field was baked without the effects glossy and mirror; what is seen is as blurred as its prefiltered "
                 "radiance. Bake it with --effects all.");
        return drawWithoutGeometry(options, *on.gpu, on.device->name(), *on.field, *asked->fromField, context);
    }
    RenderSettings& settings = asked->settings;
    if ((settings.effects.glossy || settings.effects.mirror) && !on.field->holdsRadiance())
        note(context,
             "Note: the light field was baked without the effects glossy and mirror; reflections are as blurred as its prefiltered "
             "radiance. Bake it with --effects all.");
    // An opponent's rays start further off their surface, or they meet it again; that is in metres, the setting a share of the diagonal.
    if (const std::optional<Baseline> baseline = baselineNamed(options.tracer))
    {
        settings.lightShaders = lightPasses(*baseline);
        settings.normalOffset += baselineOffset(*baseline) / (data.info.diagonal * data.info.scale);
    }
    if (!asked->lighting.path.empty())
        return drawDay(options, *on.gpu, asked->scene, *on.field, *on.live, asked->lighting, settings, asked->camera, asked->plan, context);
    const Result<Drawn> drawn = drawFrames(*on.gpu, asked->scene, *on.field, settings, asked->camera, options.frames, options.warmUp,
                                           on.stream ? &*on.stream : nullptr, context);
    if (!drawn) return fail(drawn.error());
    Json json = reportOf(options, *asked, on, *drawn);
    if (Status status = options.pictures.write(imagesOf(drawn->frame), json); !status) return fail(status.error());
    // After the pictures are written, so that the cost has that in it.
    addCost(json, watch);
    if (context.json)
        print(json);
    else
        sayTimes(options, on, *drawn);
    return exitOk;
}

} // namespace

void addRenderCommand(CLI::App& app, Context& context)
{
    CLI::App* command = addCommand(app, context, "render", "Draws a frame with the indirect light of a light field and times its passes");
    auto options = std::make_shared<RenderOptions>();
    options->scene.add(command);
    command->add_option("--field", options->field, ".sconce file of `sconce bake` (required)")->required()->type_name("FILE");
    options->camera.add(command);
    addSize(command, options->width, options->height);
    addFrameOptions(command, *options);
    addTracer(command, options->tracer);
    options->shapes.add(command);
    command
        ->add_flag("--drawn-only", options->drawnOnly,
                   described("Draw the shapes, but don't tell indirect light of them: what they would cost and change", words("off")))
        ->needs("--shapes");
    addKnob(command, "--frames", options->frames, knobs::drawnFrames);
    addKnob(command, "--warm-up", options->warmUp, knobs::warmUpSeconds);
    addKnob(command, "--resident", options->resident, knobs::resident);
    addGroups(command, options->groups, "Lights of the scene for --dim, where the field has no groups");
    addDims(command, options->dims, "; of a field's groups its light, too");
    command
        ->add_option("--sun-path", options->sunPath,
                     described("Draws --frames pictures of a day, numbered, each lit to the end by a sun on its way: lines of "
                               "time,x,y,z or time,x,y,z,r,g,b after a header of these names; see --sun",
                               words("none")))
        ->type_name("FILE");
    CLI::Option* fromField = command->add_flag(
        "--from-field", options->fromField,
        described("Draws no geometry: rays from the eye meet what probes saw, --samples a pixel; SCENE gives camera and lights",
                  words("off")));
    command
        ->add_option("--stereo", options->stereo,
                     described("With --from-field: metres between two eyes, whose pictures stand beside each other", words("one eye")))
        ->needs(fromField)
        ->type_name("METRES");
    command
        ->add_option("--lens", options->lens,
                     described("With --from-field: for a headset's lens, which shows what is r half heights from the middle at the tangent "
                               "1 + K1 r^2 + K2 r^4 times as large",
                               words("none")))
        ->needs(fromField)
        ->delimiter(',')
        ->expected(2)
        ->type_name("K1,K2");
    addDevice(command, options->device);
    options->pictures.add(command, frameLayers());
    options->quality.add(command);
    // What only geometry's pixels have.
    for (const char* other :
         {"--effects", "--rays-below", "--diffuse", "--area-shadows", "--area-samples", "--trace-every", "--surface-probes", "--no-denoise",
          "--temporal", "--screen-trace", "--roughness", "--sun-path", "--shapes", "--resident", "--seed", "--warm-up"})
        fromField->excludes(command->get_option(other));
    onChosen(command, context, options, runRender);
}

} // namespace sconce::tools
