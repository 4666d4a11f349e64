#include "runtime/effect_plan.h"

#include <algorithm>

#include "runtime/field_data.h"

namespace sconce
{

namespace
{

constexpr size_t kImageBytes = 16; // a pixel of an RGBA32F image

std::string bytes(size_t count, const char* of)
{
    return std::to_string(count) + " bytes a " + of;
}

/// What an effect costs, in passes, images, and bytes of the field; milliseconds depend on machine and picture: `sconce render` prints
/// them.
std::string costOf(std::string_view name)
{
    const size_t radiance = radianceWordsPerProbe(gpu::kChartCube, 256) * sizeof(uint32_t);
    if (name == "sun") return "A shadow map, and a look-up a pixel.";
    if (name == "punctual") return "Six shadow maps a light, and a look-up a light and pixel.";
    if (name == "emitters" || name == "sky") return "Shadow maps of its samples, and 8 look-ups a diffuse pixel; the bake's light.";
    if (name == "diffuse")
        return "A pass over diffuse tiles of at most 4 probes a look-up, a filter, " + bytes(2 * kImageBytes, "pixel") + ", " +
               bytes(kIrradianceWordsPerProbe * sizeof(uint32_t), "probe") + ".";
    if (name == "rough")
        return "12 reads more a probe of the diffuse pass, " + bytes(kImageBytes, "pixel") + ", " +
               bytes(gpu::kPrefilteredWords * sizeof(uint32_t), "probe") + ".";
    if (name == "glossy")
        return "A ray a pixel of glossy tiles of about 20 distance reads, " + bytes(kImageBytes, "pixel") + ", " +
               bytes(radiance, "probe") + " at faces of 256 texels.";
    if (name == "mirror") return "A ray a pixel of mirroring tiles, " + bytes(kImageBytes, "pixel") + "; the radiance of glossy.";
    if (name == "denoise") return "Four filter passes over glossy tiles, " + bytes(kImageBytes, "pixel") + ".";
    if (name == "masked") return "A texture read a pixel where something is cut out, in G-buffer, bake and shadow maps.";
    return "Nothing: every surface is lit and seen from both sides.";
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
    return {on("diffuse"), on("rough"), on("glossy"), on("mirror"), on("denoise"), false, !wholePicture};
}

Result<EffectPlan> planEffects(const SceneReport& scene, std::string_view wanted)
{
    EffectPlan plan;
    bool noise = false;
    for (const SceneEffect& effect : scene.effects)
    {
        plan.effects.push_back({effect.name, effect.called, false, effect.why, costOf(effect.name)});
        noise = noise || (effect.name == "glossy" && effect.called);
    }
    plan.effects.push_back({"denoise", noise, false, noise ? "Glossy rays are random." : "No ray is random.", costOf("denoise")});
    for (const std::string& part : split(wanted))
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
            for (PlannedEffect& effect : plan.effects) effect.on = false;
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
            return Error{ErrorCode::badArgument, "effects: '" + name + "' is not auto, all, none, or one of " + names + "."};
        }
    }
    return plan;
}

} // namespace sconce
