#include "runtime/frame/effect_plan.h"

#include <algorithm>
#include <span>

#include <fmt/format.h>

#include "runtime/field/field_data.h"

namespace sconce
{

namespace
{

constexpr size_t kImageBytes = 8; // a pixel of an image of kLightFormat

std::string bytes(size_t count, const char* of)
{
    return fmt::format("{} bytes a {}", count, of);
}

/// What an effect costs, in passes, images, and bytes of the field; milliseconds depend on machine and picture: `sconce render` prints
/// them.
std::string costOf(std::string_view name)
{
    const size_t radiance = radianceWordsPerProbe(gpu::kChartCube, 256) * sizeof(uint32_t);
    const size_t surfaceLight =
        bytesPerProbe(gpu::kChartCube, knobs::resolution.value, knobs::surfaceTexels.value, false, knobs::surfaceRefined.value) -
        bytesPerProbe(gpu::kChartCube, knobs::resolution.value, 0, false, 0.0f) + 2 * gpu::kPatches * sizeof(uint32_t);
    if (name == "sun") return "A shadow map, and a look-up a pixel.";
    if (name == "punctual") return "Six shadow maps a light, and a look-up a light and pixel.";
    if (name == "emitters")
        return "Rays of the bake; in a frame a shadowed look-up a pixel for each that is kept as a lamp, and nothing for the others.";
    if (name == "sky") return "Rays of the bake, nothing in a frame.";
    if (name == "diffuse")
        return fmt::format("A pass over diffuse tiles of about 27 reads a look-up, one for 2x2 pixels where they are of one flat surface, "
                           "{}, {}.",
                           bytes(kImageBytes, "pixel"), bytes(surfaceLight, "probe"));
    if (name == "rough")
        return fmt::format("12 reads more a probe of the diffuse pass, {}, {}.", bytes(kImageBytes, "pixel"),
                           bytes(gpu::kPrefilteredWords * sizeof(uint32_t), "probe"));
    if (name == "glossy")
        return fmt::format("A ray a pixel of glossy tiles of about 20 distance reads, {}, {} at faces of 256 texels.",
                           bytes(kImageBytes, "pixel"), bytes(radiance, "probe"));
    if (name == "mirror")
        return fmt::format("A ray a pixel of mirroring tiles; the image of glossy, or {} without; the radiance of glossy.",
                           bytes(kImageBytes, "pixel"));
    if (name == "denoise") return fmt::format("Four filter passes over glossy tiles, {}.", bytes(kImageBytes, "pixel"));
    if (name == "masked") return "A texture read a pixel where something is cut out, in G-buffer, bake and shadow maps.";
    return "The back faces of what is closed are drawn, too: up to twice the triangles; no light of its own.";
}

std::string lossOf(std::string_view name)
{
    if (name == "sun") return "Directional lights shine no more: neither their light nor any bounce of it is there.";
    if (name == "punctual") return "Point and spot lights shine no more: neither their light nor any bounce of it is there.";
    if (name == "emitters") return "Emitters are dark: they are not seen, and neither their light nor any bounce of it is there.";
    if (name == "sky") return "The sky is black: it is not seen, and neither its light nor any bounce of it is there.";
    if (name == "diffuse") return "Diffuse surfaces show sun and punctual lights only.";
    if (name == "rough") return "Rough surfaces reflect sun and punctual lights only.";
    if (name == "glossy") return "Glossy surfaces reflect sun and punctual lights only.";
    if (name == "mirror") return "Mirrors are black.";
    if (name == "denoise") return "Glossy reflections keep the noise of their rays.";
    if (name == "masked") return "What alpha cuts out is solid: leaves are whole quads, and cast such shadows.";
    return "Sheets are seen from their front only, by the eye and by probes; their shadow stays.";
}

/// What a scene consists of, of two kinds; every other effect is a pass.
constexpr std::string_view kSources[] = {"sun", "punctual", "emitters", "sky"}, kSurfaces[] = {"masked", "thin-two-sided"};

/// All effects of the same kind; empty: it is a pass.
std::span<const std::string_view> kindOf(std::string_view name)
{
    for (const std::span<const std::string_view> kind : {std::span<const std::string_view>(kSources), {kSurfaces}})
        if (std::ranges::find(kind, name) != kind.end()) return kind;
    return {};
}

std::vector<std::string> split(std::string_view text)
{
    std::vector<std::string> parts;
    while (true)
    {
        const size_t comma = text.find(',');
        parts.emplace_back(text.substr(0, comma));
        if (comma == std::string_view::npos) return parts;
        text.remove_prefix(comma + 1);
    }
}

const PlannedEffect* find(const EffectPlan& plan, std::string_view name)
{
    const auto it = std::ranges::find(plan.effects, name, &PlannedEffect::name);
    return it == plan.effects.end() ? nullptr : &*it;
}

} // namespace

bool EffectPlan::on(std::string_view name) const
{
    const PlannedEffect* effect = find(*this, name);
    return effect && effect->on;
}

bool EffectPlan::called(std::string_view name) const
{
    const PlannedEffect* effect = find(*this, name);
    return effect && effect->called;
}

IndirectEffects EffectPlan::indirect() const
{
    IndirectEffects passes;
    passes.diffuse = on("diffuse");
    passes.rough = on("rough");
    passes.glossy = on("glossy");
    passes.mirror = on("mirror");
    passes.denoise = on("denoise");
    passes.tiles = !wholePicture;
    return passes;
}

Result<EffectPlan> planEffects(const SceneReport& scene, std::string_view wanted)
{
    EffectPlan plan;
    bool noise = false;
    for (const SceneEffect& effect : scene.effects)
    {
        plan.effects.push_back({effect.name, !kindOf(effect.name).empty(), effect.called, false, effect.why, costOf(effect.name), {}});
        noise = noise || (effect.name == "glossy" && effect.called);
    }
    plan.effects.push_back(
        {"denoise", false, noise, false, noise ? "Glossy rays are random." : "No ray is random.", costOf("denoise"), {}});
    // A list, or none: of the passes what is named, and of what the scene consists of all, where none of the kind is named.
    const std::vector<std::string> parts = split(wanted);
    for (PlannedEffect& effect : plan.effects)
    {
        const std::span<const std::string_view> kind = kindOf(effect.name);
        effect.on = effect.called && effect.ofScene &&
                    std::ranges::none_of(parts, [&](const std::string& part) { return std::ranges::find(kind, part) != kind.end(); });
    }
    // In the order given: a later name overrides what an earlier one, or 'auto', has set.
    for (const std::string& part : parts)
    {
        const bool away = part.starts_with('-');
        const std::string name = away ? part.substr(1) : part;
        const auto named = std::ranges::find(plan.effects, name, &PlannedEffect::name);
        if (name == "auto" || name == "all")
        {
            for (PlannedEffect& effect : plan.effects) effect.on = !away && (name == "all" || effect.called);
            plan.wholePicture = name == "all" && !away;
        }
        else if (name == "none")
        {
            for (PlannedEffect& effect : plan.effects) effect.on = effect.on && effect.ofScene;
        }
        else if (named != plan.effects.end())
            named->on = !away;
        else
        {
            std::string names;
            for (const PlannedEffect& effect : plan.effects)
            {
                names += names.empty() ? "" : ", ";
                names += effect.name;
            }
            return Error{ErrorCode::badArgument, fmt::format("effects: '{}' is not auto, all, none, or one of {}.", name, names)};
        }
    }
    for (PlannedEffect& effect : plan.effects)
        if (effect.called && !effect.on) effect.givenUp = lossOf(effect.name);
    return plan;
}

void capScene(Scene& scene, const EffectPlan& plan)
{
    std::erase_if(scene.lights, [&](const Light& light) { return !plan.on(light.type == LightType::directional ? "sun" : "punctual"); });
    if (!plan.on("sky")) scene.sky = vec3(0.0f);
    for (Material& material : scene.materials)
    {
        if (!plan.on("emitters"))
        {
            material.emission = vec3(0.0f);
            material.emissionTexture = {};
        }
        if (!plan.on("masked"))
        {
            material.alphaCutoff = 0.0f;
            material.blended = false;
        }
    }
    // What is closed shows no back face: a scene that doesn't call for sheets keeps both, as ever.
    scene.twoSided = plan.on("thin-two-sided") || !plan.called("thin-two-sided");
}

} // namespace sconce
