#include "tools/frame_setup.h"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/field/light_groups.h"
#include "scene/scene_check.h"
#include "tools/light_group_options.h"
#include "tools/live_light_options.h"

namespace sconce::tools
{

void addFrameOptions(CLI::App* command, FrameChoice& choice)
{
    command
        ->add_option(
            "--effects", choice.effects,
            described("auto: what the scene calls for, on the tiles of the picture that need it; all: every effect over the whole picture, "
                      "for the same pixels; none; or a list of effects, as `sconce check` names them, and denoise: of the passes only "
                      "those, of lights and surfaces all, where none of the kind is named; -NAME takes one away, as in auto,-mirror,-sun",
                      choice.effects))
        ->type_name("auto|all|none|LIST");
    addKnob(command, "--rays-below", choice.raysBelow, knobs::raysBelow, "R");
    addKnob(command, "--diffuse", choice.diffuse, knobs::diffuse);
    addKnob(command, "--area-shadows", choice.areaShadows, knobs::areaShadows);
    addKnob(command, "--samples", choice.samples, knobs::glossyRays);
    addKnob(command, "--area-samples", choice.areaSamples, knobs::areaSamples);
    addKnob(command, "--trace-every", choice.traceEvery, knobs::traceEvery);
    addKnob(command, "--surface-probes", choice.surfaceProbes, knobs::surfaceProbes);
    addSwitch(command, "--no-denoise", choice.noDenoise, knobs::denoise);
    addSwitch(command, "--temporal", choice.temporal, knobs::temporal);
    addSwitch(command, "--screen-trace", choice.screenTrace, knobs::screenTrace);
    addKnob(command, "--roughness", choice.roughness, knobs::roughness, "R");
    addKnob(command, "--seed", choice.seed, knobs::frameSeed);
}

Result<EffectPlan> planFor(const FrameChoice& choice, const Scene& scene, bool sunComes)
{
    if (sunComes)
    {
        Scene lit = scene;
        turnSun(lit.lights, SunPlace{vec3(0.0f, -1.0f, 0.0f), {}});
        return planFor(choice, lit);
    }
    if (!choice.roughness) return planEffects(checkScene(scene, choice.raysBelow), choice.effects);
    Scene drawn = scene;
    for (Material& material : drawn.materials)
    {
        material.roughness = *choice.roughness;
        material.metallicRoughnessTexture.image = -1; // metals stay what their factor says; only roughness counts for reflections
    }
    return planEffects(checkScene(drawn, choice.raysBelow), choice.effects);
}

Result<RenderSettings> settingsFor(const FrameChoice& choice, const EffectPlan& plan, const FieldData& data, const std::string& field,
                                   std::string& diffuse)
{
    diffuse = !choice.diffuse.empty() ? choice.diffuse : std::string(data.surfaceLight.empty() ? kIrradiance : kSurface);
    if (diffuse == kSurface && data.surfaceLight.empty())
        return Error{
            ErrorCode::badArgument,
            fmt::format("Light field '{}' holds no surface light; bake it with --surface-texels above 0, or give another --diffuse.",
                        field)};
    RenderSettings settings;
    settings.glossyRays = choice.samples;
    settings.traceEvery = choice.traceEvery;
    settings.surfaceProbes = choice.surfaceProbes;
    settings.raysBelow = choice.raysBelow;
    settings.roughness = choice.roughness;
    settings.seed = choice.seed;
    const uint32_t aSample = choice.areaShadows == kField ? knobs::kTracedAreaSamples : settings.areaSamples;
    settings.areaSamples = choice.areaSamples != 0 ? choice.areaSamples : aSample * choice.samples;
    // The plan says what the scene calls for; how a pass does its work is left to the choice.
    settings.effects = plan.indirect();
    settings.effects.denoise = settings.effects.denoise && !choice.noDenoise;
    settings.effects.temporal = choice.temporal;
    settings.effects.screenTrace = choice.screenTrace;
    settings.effects.surfaceLight = diffuse == kSurface;
    settings.effects.tracedDiffuse = diffuse == kTraced;
    settings.effects.patches = diffuse == kPatches;
    settings.effects.fieldShadows = choice.areaShadows == kField;
    return settings;
}

Result<Lighting> lightFor(const FieldData& data, std::span<const LightGroupDesc> groups, std::span<const std::string> dims, Scene& scene)
{
    Lighting made;
    const std::vector<LightGroupDesc> own = data.groups.empty() ? std::vector(groups.begin(), groups.end()) : groupsOf(data.groups);
    if (data.live.links > 0)
    {
        auto taken = takeLiveLights(scene, own);
        if (!taken) return taken.error();
        made.lights = std::move(*taken);
        made.moves = !data.live.lit || !dims.empty() || !std::ranges::equal(made.lights, data.live.lights, sameLight);
    }
    if (!dims.empty())
    {
        auto dimmed = dimScene(scene, own, dims);
        if (!dimmed) return dimmed.error();
        if (!data.groups.empty()) made.weights = std::move(*dimmed);
    }
    made.fixed = scene.lights;
    scene.lights.insert(scene.lights.end(), made.lights.begin(), made.lights.end());
    return made;
}

Result<double> dimField(Gpu& gpu, LightGroups& groups, std::span<const vec3> weights)
{
    auto timer = GpuTimer::create(gpu, 1);
    if (!timer) return timer.error();
    if (Status status = groups.set(weights); !status) return status.error();
    const Status recorded = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            groups.record(cmd, &*timer);
        });
    if (!recorded) return recorded.error();
    double milliseconds = 0.0;
    for (const GpuTimer::Scope& scope : timer->read()) milliseconds += scope.milliseconds;
    return milliseconds;
}

Result<std::map<std::string, double>> settle(Gpu& gpu, LiveLight& live, const LightState& state)
{
    if (Status status = live.set(state); !status) return status.error();
    auto timer = GpuTimer::create(gpu, 8);
    if (!timer) return timer.error();
    std::map<std::string, double> milliseconds;
    while (!live.settled())
    {
        const Status recorded = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                timer->reset(cmd);
                live.record(cmd, {}, &*timer);
            });
        if (!recorded) return recorded.error();
        for (const GpuTimer::Scope& scope : timer->read()) milliseconds[scope.name] += scope.milliseconds;
    }
    return milliseconds;
}

} // namespace sconce::tools
