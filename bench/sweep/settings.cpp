#include "bench/sweep/settings.h"

#include <algorithm>
#include <charconv>
#include <type_traits>

#include <fmt/format.h>

namespace sconce
{
namespace
{

template <class T> bool parse(std::string_view text, T& value)
{
    if constexpr (std::is_same_v<T, std::string>)
        value = text;
    else if constexpr (std::is_same_v<T, bool>)
    {
        if (text != "on" && text != "off") return false;
        value = text == "on";
    }
    else
    {
        const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
        return !text.empty() && read.ec == std::errc() && read.ptr == text.data() + text.size();
    }
    return true;
}

/// @param said   what base/knobs.h says of it
/// @param field  (auto& settings) -> the member, which decides how the value is read and written
template <class T, class Field>
SweptKnob knob(std::string_view name, Stage stage, std::vector<std::string_view> methods, std::vector<std::string_view> sweep,
               const Knob<T>& said, Field field)
{
    const auto get = [field](const PointSettings& settings) -> Json
    {
        const auto& value = field(settings);
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, bool>)
            return value ? "on" : "off";
        else if constexpr (std::is_same_v<Value, float>) // as it is spelled: 0.002, not 0.0020000000949949026
        {
            char text[32];
            const auto end = std::to_chars(text, text + sizeof text, value).ptr;
            double nearest = 0.0;
            std::from_chars(text, end, nearest);
            return nearest;
        }
        else
            return value;
    };
    const auto set = [field, &said](PointSettings& settings, std::string_view text)
    {
        using Value = std::remove_cvref_t<decltype(field(settings))>;
        Value value{};
        if (!parse(text, value)) return false;
        if constexpr (std::is_same_v<Value, T> || std::is_same_v<Value, std::string>) // not a choice that settings hold as switches
            if (!said.allows(value)) return false;
        field(settings) = value;
        return true;
    };
    return {name, stage, std::move(methods), std::move(sweep), said.unit, rangeText(said), get, set};
}

#define SCONCE_FIELD(member)                                                                                                               \
    [](auto& s) -> auto&                                                                                                                   \
    {                                                                                                                                      \
        return s.member;                                                                                                                   \
    }

std::vector<std::string_view> all(std::vector<std::string_view> some, const std::vector<std::string_view>& others)
{
    some.insert(some.end(), others.begin(), others.end());
    return some;
}

std::vector<SweptKnob> makeKnobs()
{
    const std::vector<std::string_view> ours{"ours"}, tracers{"ours", "ours-grid", "b0", "b0plus", "b0plus-octree", "wang"},
        opponents{"b0", "b0plus", "b0plus-octree", "wang"}, lists{"ours", "ours-grid", "b0plus-octree", "wang", "ddgi-placed"},
        paths{kPathTracer, kFilteredPaths}, fields{"ours", "ours-grid"}, volumes{"ddgi", "ddgi-placed", "sh-grid"},
        biased = all({"b0plus"}, volumes), placed = all(tracers, volumes), mapped = all(tracers, {"ddgi-placed"});
    using enum Stage;
    return {
        knob("probes", place, placed, {}, knobs::benchProbes, SCONCE_FIELD(probes)),
        knob("placement", place, placed, {"optimised", "skeleton", "balls"}, knobs::placement, SCONCE_FIELD(placement)),
        knob("resolution", bake, mapped, {"128", "256", "416", "512", "1024"}, knobs::resolution, SCONCE_FIELD(resolution)),
        knob("bounces", bake, placed, {"0", "1", "2", "4"}, knobs::bounces, SCONCE_FIELD(bounces)),
        knob("surface texels", bake, fields, {"0", "26", "52", "104"}, knobs::surfaceTexels, SCONCE_FIELD(surfaceTexels)),
        knob("surface rays", bake, fields, {"16", "64", "256"}, knobs::surfaceRays, SCONCE_FIELD(surfaceRays)),
        knob("surface refined", bake, fields, {"0", "0.02", "0.1"}, knobs::surfaceRefined, SCONCE_FIELD(surfaceRefined)),
        knob("field gather", bake, fields, {"off", "on"}, knobs::gather, SCONCE_FIELD(fieldGather)),
        knob("compact", bake, fields, {"off", "on"}, knobs::compact, SCONCE_FIELD(compact)),
        knob("octree voxels", bake, lists, {"32", "64", "128", "256"}, knobs::octreeVoxels, SCONCE_FIELD(octreeVoxels)),
        knob("low factor", trace, opponents, {}, knobs::lowFactor, SCONCE_FIELD(lowFactor)),
        knob("look-up bias", trace, biased, {}, knobs::lookUpBias, SCONCE_FIELD(lookUpBias)),
        knob("look-up view", trace, biased, {}, knobs::lookUpView, SCONCE_FIELD(lookUpView)),
        knob("distance bits", trace, ours, {"16", "24", "32"}, knobs::distanceBits, SCONCE_FIELD(distanceBits)),
        knob("ranked", trace, ours, {"1", "2", "3", "4"}, knobs::ranked, SCONCE_FIELD(quality.trace.ranked)),
        knob("hand-offs", trace, ours, {"0", "2", "8", "24", "64"}, knobs::maxHandoffs, SCONCE_FIELD(quality.trace.maxHandoffs)),
        knob("start level", trace, ours, {"0", "2", "4", "6"}, knobs::startLevel, SCONCE_FIELD(quality.trace.startLevel)),
        knob("coarsest level", trace, ours, {"0", "2", "4", "6"}, knobs::coarsestLevel, SCONCE_FIELD(quality.trace.coarsestLevel)),
        knob("tolerance", trace, ours, {"0.25", "0.5", "1", "2", "4"}, knobs::tolerance, SCONCE_FIELD(quality.trace.tolerance)),
        knob("opinion", trace, ours, {"0", "0.001", "0.002", "0.01"}, knobs::opinion, SCONCE_FIELD(quality.trace.opinion)),
        knob("far bounds", trace, ours, {"0", "1"}, knobs::farBounds, SCONCE_FIELD(quality.trace.farBounds)),
        knob("order", trace, ours, {"0", "1", "2", "3"}, knobs::order, SCONCE_FIELD(quality.trace.order)),
        knob("rays", frame, tracers, {"1", "2", "4", "8"}, knobs::glossyRays, SCONCE_FIELD(frame.glossyRays)),
        knob("trace every", frame, tracers, {"1", "2", "4", "8", "16"}, knobs::traceEvery, SCONCE_FIELD(frame.traceEvery)),
        knob("surface probes", frame, fields, {"1", "2"}, knobs::surfaceProbes, SCONCE_FIELD(frame.surfaceProbes)),
        knob("area samples", frame, placed, {"2", "8", "32"}, knobs::areaSamples, SCONCE_FIELD(frame.areaSamples)),
        knob("field shadows", frame, fields, {"off", "on"}, knobs::areaShadows, SCONCE_FIELD(frame.effects.fieldShadows)),
        knob("denoise", frame, placed, {"on", "off"}, knobs::denoise, SCONCE_FIELD(frame.effects.denoise)),
        knob("temporal", frame, placed, {"off", "on"}, knobs::temporal, SCONCE_FIELD(frame.effects.temporal)),
        knob("patches", frame, fields, {"off", "on"}, knobs::diffuse, SCONCE_FIELD(frame.effects.patches)),
        knob("traced diffuse", frame, tracers, {"off", "on"}, knobs::diffuse, SCONCE_FIELD(frame.effects.tracedDiffuse)),
        knob("rays below", frame, tracers, {"0", "0.2", "1"}, knobs::raysBelow, SCONCE_FIELD(frame.raysBelow)),
        knob("paths", frame, paths, {"1", "4", "16", "64"}, knobs::tracedPaths, SCONCE_FIELD(paths)),
    };
}

#undef SCONCE_FIELD

bool has(const SweptKnob& knob, const std::string& method)
{
    return std::ranges::find(knob.methods, method) != knob.methods.end();
}

} // namespace

uint32_t PointSettings::chart() const
{
    const std::optional<Baseline> baseline = opponent();
    return baseline && *baseline != Baseline::wang ? gpu::kChartOctahedral : gpu::kChartCube; // wang's maps are made from cube faces
}

uint32_t PointSettings::bakedSurfaceTexels() const
{
    return (method == "ours" || method == "ours-grid") && !frame.effects.patches ? surfaceTexels : 0;
}

std::span<const SweptKnob> sweptKnobs()
{
    static const std::vector<SweptKnob> all = makeKnobs();
    return all;
}

const SweptKnob* findKnob(std::string_view name)
{
    const auto found = std::ranges::find(sweptKnobs(), name, &SweptKnob::name);
    return found == sweptKnobs().end() ? nullptr : &*found;
}

Json settingsJson(const PointSettings& settings, Stage upTo)
{
    Json json = Json::object();
    // Knobs of other methods are left out, so that they are no part of the key by which a point is kept.
    for (const SweptKnob& knob : sweptKnobs())
        if (has(knob, settings.method) && knob.stage <= upTo) json[std::string(knob.name)] = knob.get(settings);
    return json;
}

Result<PointSettings> settingsFrom(const std::string& method, const Json& json)
{
    PointSettings settings;
    settings.method = method;
    if (!json.is_object()) return Error{ErrorCode::badInput, fmt::format("The settings of a point of method '{}' are no object.", method)};
    for (const auto& [name, value] : json.items())
    {
        const SweptKnob* knob = findKnob(name);
        if (!knob || !has(*knob, method)) return Error{ErrorCode::badInput, fmt::format("Method '{}' has no knob '{}'.", method, name)};
        if (!knob->set(settings, value.is_string() ? value.get<std::string>() : value.dump()))
            return Error{ErrorCode::badInput, fmt::format("Knob '{}' can't be {}; give {}.", name, value.dump(), knob->range)};
    }
    return settings;
}

} // namespace sconce
