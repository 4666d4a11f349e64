#include "tools/view/session.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "runtime/field/light_groups.h"
#include "runtime/vulkan/gpu.h"
#include "scene/camera_check.h"

namespace sconce::tools
{

namespace
{

constexpr uint32_t kMostScopes = 24; // passes of a frame with those of live light

bool sameLight(const LightChoice& a, const LightChoice& b)
{
    const auto same = [](const SunPlace& x, const SunPlace& y) { return x.direction == y.direction && x.irradiance == y.irradiance; };
    return a.dims == b.dims && a.sun.has_value() == b.sun.has_value() && (!a.sun || same(*a.sun, *b.sun));
}

auto flagsOf(const IndirectEffects& e)
{
    return std::array{e.diffuse, e.surfaceLight, e.tracedDiffuse, e.patches,  e.fieldShadows, e.rough,
                      e.glossy,  e.mirror,       e.denoise,       e.temporal, e.screenTrace,  e.tiles};
}

/// What a renderer is made for, and can't change.
bool sameRenderer(const RenderSettings& a, const RenderSettings& b)
{
    return a.width == b.width && a.height == b.height && a.traceEvery == b.traceEvery && a.surfaceProbes == b.surfaceProbes &&
           a.roughness == b.roughness && flagsOf(a.effects) == flagsOf(b.effects);
}

/// What the scene on the device depends on, light apart: what it keeps of its effects, and what samples of light frames need.
std::string keyOf(const EffectPlan& plan, const RenderSettings& settings)
{
    std::string key;
    for (const PlannedEffect& effect : plan.effects)
        if (effect.ofScene) key += effect.on ? '1' : '0';
    const IndirectEffects& e = settings.effects;
    for (const bool flag : {e.diffuse, e.surfaceLight, e.tracedDiffuse, e.patches, e.fieldShadows}) key += flag ? '1' : '0';
    return key;
}

bool sameQuality(const Quality& a, const Quality& b)
{
    return std::memcmp(&a.trace, &b.trace, sizeof a.trace) == 0; // numbers of 32 bits, no padding
}

} // namespace

Result<std::unique_ptr<Session>> Session::create(Gpu& gpu, Desc desc)
{
    std::unique_ptr<Session> made(new Session(gpu, std::move(desc)));
    auto field = makeLightField(gpu, made->desc.field, made->quality);
    if (!field) return field.error();
    made->lightField = std::move(*field);
    auto timer = GpuTimer::create(gpu, kMostScopes);
    if (!timer) return timer.error();
    made->timer = std::move(*timer);
    if (made->desc.field.groups.empty())
        for (const LightGroupDesc& group : made->desc.groups) made->groupNames.push_back(group.name);
    for (const LightGroup& group : made->desc.field.groups) made->groupNames.push_back(group.which.name);
    return made;
}

Session::~Session()
{
    dropRenderer();
}

void Session::dropRenderer()
{
    gpu.vk.DeviceWaitIdle(gpu.host.device);
    shown.reset();
    renderer.reset();
}

void Session::cut()
{
    frame = 0;
    if (renderer) renderer->cut();
}

/// Sets the field's light; the scene's own is set by whoever draws it.
Status Session::relight(const LightChoice& light, const Lighting& lighting)
{
    if (lighting.moves || live)
    {
        if (!live)
        {
            dropRenderer(); // whatever traces the field looks for live light when it is made
            lightGroups.reset();
            auto made = makeLiveLight(gpu, *lightField, desc.field);
            if (!made) return made.error();
            live = std::move(*made);
        }
        liveState = {lighting.lights, lighting.weights};
        if (Status set = live->set(liveState); !set) return set;
    }
    else if (!desc.field.groups.empty() && (lightGroups || !light.dims.empty()))
    {
        if (!lightGroups)
        {
            auto made = makeLightGroups(gpu, *lightField, desc.field);
            if (!made) return made.error();
            lightGroups = std::move(*made);
        }
        const std::vector<vec3> asBaked(desc.field.groups.size(), vec3(1.0f));
        if (Status set = lightGroups->set(lighting.weights.empty() ? asBaked : lighting.weights); !set) return set;
    }
    return success();
}

Status Session::rebuildScene(Scene scene, const RenderSettings& settings)
{
    dropRenderer();
    deviceScene.reset();
    auto made = DeviceScene::create(gpu, scene, lightField->info(), sceneForFrames(settings.effects, lightField->info(), eye));
    if (!made) return made.error();
    deviceScene = std::move(*made);
    lit = std::make_shared<const Scene>(std::move(scene));
    ++version;
    return success();
}

Status Session::rebuildRenderer(const RenderSettings& settings)
{
    dropRenderer();
    auto made = SceneRenderer::create(gpu, *deviceScene, *lightField, settings);
    if (!made) return made.error();
    auto pass = Show::create(gpu, (*made)->pictures(), settings.width, settings.height);
    if (!pass) return pass.error();
    renderer = std::move(*made);
    shown = std::move(*pass);
    frame = 0;
    return success();
}

Status Session::apply(const ViewKnobs& knobs, const LightChoice& light, uint32_t width, uint32_t height)
{
    if (light.sun && !sunMoves())
        return Error{ErrorCode::badArgument,
                     fmt::format("The lights of light field '{}' can't move; bake it with --live-links.", desc.fieldName)};
    auto plan = planFor(knobs.frame, desc.scene, light.sun.has_value());
    if (!plan) return plan.error();
    std::string diffuse;
    auto settings = settingsFor(knobs.frame, *plan, desc.field, desc.fieldName, diffuse);
    if (!settings) return settings.error();
    settings->width = width;
    settings->height = height;
    settings->normalOffset = knobs.normalOffset;

    const bool otherLight = !sameLight(light, lightNow);
    const std::string key = keyOf(*plan, *settings);
    if (!deviceScene || otherLight || key != sceneKey)
    {
        Scene scene = desc.scene;
        auto lighting = lightFor(desc.field, desc.groups, light.dims, scene);
        if (!lighting) return lighting.error();
        if (light.sun)
        {
            if (const std::string fault = heldSunFault(lighting->fixed); !fault.empty()) return Error{ErrorCode::badArgument, fault + "."};
            turnSun(lighting->lights, *light.sun);
            lighting->moves = true;
            scene.lights = lighting->fixed;
            scene.lights.insert(scene.lights.end(), lighting->lights.begin(), lighting->lights.end());
        }
        capScene(scene, *plan); // after the groups have found their lights
        if (!deviceScene || otherLight)
            if (Status set = relight(light, *lighting); !set) return set;
        sceneKey.clear();
        if (Status made = rebuildScene(std::move(scene), *settings); !made) return made;
        sceneKey = key;
        lightNow = light;
    }
    effects = std::move(*plan);
    if (!sameQuality(knobs.quality, quality))
    {
        if (Status set = lightField->setQuality(knobs.quality); !set) return set;
        const gpu::TraceQuality &wanted = knobs.quality.trace, &had = quality.trace;
        if (wanted.farBounds != had.farBounds || wanted.order != had.order) dropRenderer(); // which are fixed in a pass when it is made
        quality = knobs.quality;
    }
    if (!renderer || !sameRenderer(*settings, drawn))
    {
        if (Status made = rebuildRenderer(*settings); !made) return made;
    }
    else if (Status set = renderer->setSampling(*settings); !set)
        return set;
    drawn = *settings;
    return success();
}

Status Session::draw(const Camera& camera, const Shown& wanted, bool settleAtOnce)
{
    if (const std::string fault = cameraFault(camera); !fault.empty()) return Error{ErrorCode::badArgument, fault};
    if (!ready()) return Error{ErrorCode::badArgument, "Nothing can be drawn with these settings."};
    if (live && !live->settled() && settleAtOnce)
    {
        const auto settled = settle(gpu, *live, liveState);
        if (!settled) return settled.error();
    }
    eye = camera.eye;
    if (Status moved = deviceScene->lookFrom(gpu, eye); !moved) return moved;
    const bool changing = live && !live->settled();
    if (changing) renderer->lightChanged();
    // As `render` numbers its frames: with a filter over time each draws rays of its own, without one all are the same picture.
    const uint32_t index = drawn.effects.temporal ? frame : 0;
    const Status submitted = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            if (changing) live->record(cmd, {.eye = camera.eye}, &*timer);
            if (lightGroups) lightGroups->record(cmd, &*timer);
            renderer->record(cmd, camera, drawn.seed + index, &*timer);
            shown->record(cmd, wanted);
        });
    if (!submitted) return submitted;
    ++frame;
    lastTimes = timer->read();
    return success();
}

Status Session::redraw(const Shown& wanted)
{
    return gpu.submit([&](VkCommandBuffer cmd) { shown->record(cmd, wanted); });
}

uint64_t Session::deviceBytes() const
{
    return gpu.memory().used();
}

} // namespace sconce::tools
