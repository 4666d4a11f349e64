#include "tools/view/live_knobs.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace sconce::tools
{

namespace
{

/// False where the text is no value of the type; ranges are the knob's.
template <class T> bool read(const std::string& text, T& value)
{
    if constexpr (std::is_same_v<T, bool>)
    {
        value = text == "on";
        return value || text == "off";
    }
    else if constexpr (std::is_same_v<T, std::string>)
    {
        value = text;
        return true;
    }
    else
    {
        const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
        return fault == std::errc() && end == text.data() + text.size();
    }
}

template <class T> LiveKnob described(const Knob<T>& knob)
{
    LiveKnob made;
    made.row = rowOf(knob);
    if constexpr (std::is_same_v<T, bool>)
        made.kind = LiveKnob::Kind::flag;
    else if constexpr (std::is_same_v<T, std::string_view>)
        made.kind = LiveKnob::Kind::choice;
    else
    {
        made.kind = std::is_floating_point_v<T> ? LiveKnob::Kind::real : LiveKnob::Kind::whole;
        made.least = double(knob.least);
        made.most = double(knob.most);
    }
    for (const T choice : knob.only) made.choices.push_back(knobText(choice));
    return made;
}

/// @tparam Value  what ViewKnobs has: the knob's type, std::string of a choice, or an optional of it
/// @param at  where that is
/// @param unset  the value that stands for "derived"; none: the knob has no such
template <class Value, class T, class At> LiveKnob live(const Knob<T>& knob, At at, std::optional<Value> unset = std::nullopt)
{
    LiveKnob made = described(knob);
    const Value fallback = unset ? *unset : Value(knob.value);
    made.get = [at, unset](const ViewKnobs& knobs)
    {
        const Value& value = at(const_cast<ViewKnobs&>(knobs));
        return unset && value == *unset ? std::string(kDefaultWord) : knobText(T(value));
    };
    made.set = [at, fallback, &knob](ViewKnobs& knobs, const std::string& text) -> std::string
    {
        if (text == kDefaultWord) at(knobs) = fallback;
        if (text == kDefaultWord) return {};
        Value value{};
        if (!read(text, value) || !knob.inRange(T(value))) return knob_words::fault(knob.name, fmt::format("'{}'", text), rangeText(knob));
        at(knobs) = value;
        return {};
    };
    return made;
}

/// One that may be unset.
template <class At> LiveKnob optionalLive(const Knob<float>& knob, At at)
{
    LiveKnob made = described(knob);
    made.get = [at](const ViewKnobs& knobs)
    {
        const std::optional<float>& value = at(const_cast<ViewKnobs&>(knobs));
        return value ? knobText(*value) : std::string(kDefaultWord);
    };
    made.set = [at, &knob](ViewKnobs& knobs, const std::string& text) -> std::string
    {
        float value = 0.0f;
        if (text == kDefaultWord)
            at(knobs).reset();
        else if (!read(text, value) || !knob.inRange(value))
            return knob_words::fault(knob.name, fmt::format("'{}'", text), rangeText(knob));
        else
            at(knobs) = value;
        return {};
    };
    return made;
}

LiveKnob denoiseKnob()
{
    LiveKnob made = described(knobs::denoise);
    made.get = [](const ViewKnobs& knobs) { return knobText(!knobs.frame.noDenoise); };
    made.set = [](ViewKnobs& knobs, const std::string& text) -> std::string
    {
        bool on = knobs::denoise.value;
        if (text != kDefaultWord && !read(text, on))
            return knob_words::fault("denoise", fmt::format("'{}'", text), rangeText(knobs::denoise));
        knobs.frame.noDenoise = !on;
        return {};
    };
    return made;
}

#define SCONCE_AT(member)                                                                                                                  \
    [](ViewKnobs & k) -> auto&                                                                                                             \
    {                                                                                                                                      \
        return k.member;                                                                                                                   \
    }

std::vector<LiveKnob> makeLiveKnobs()
{
    return {optionalLive(knobs::exposure, SCONCE_AT(exposure)),
            live<uint32_t>(knobs::glossyRays, SCONCE_AT(frame.samples)),
            live<std::string>(knobs::diffuse, SCONCE_AT(frame.diffuse), std::optional<std::string>(std::string())),
            live<std::string>(knobs::areaShadows, SCONCE_AT(frame.areaShadows)),
            live<uint32_t>(knobs::areaSamples, SCONCE_AT(frame.areaSamples), std::optional<uint32_t>(0)),
            live<uint32_t>(knobs::traceEvery, SCONCE_AT(frame.traceEvery)),
            live<uint32_t>(knobs::surfaceProbes, SCONCE_AT(frame.surfaceProbes)),
            live<float>(knobs::raysBelow, SCONCE_AT(frame.raysBelow)),
            optionalLive(knobs::roughness, SCONCE_AT(frame.roughness)),
            denoiseKnob(),
            live<bool>(knobs::temporal, SCONCE_AT(frame.temporal)),
            live<bool>(knobs::screenTrace, SCONCE_AT(frame.screenTrace)),
            live<float>(knobs::normalOffset, SCONCE_AT(normalOffset)),
            live<uint32_t>(knobs::frameSeed, SCONCE_AT(frame.seed)),
            live<int>(knobs::ranked, SCONCE_AT(quality.trace.ranked)),
            live<float>(knobs::opinion, SCONCE_AT(quality.trace.opinion)),
            live<int>(knobs::maxHandoffs, SCONCE_AT(quality.trace.maxHandoffs)),
            live<int>(knobs::startLevel, SCONCE_AT(quality.trace.startLevel)),
            live<int>(knobs::coarsestLevel, SCONCE_AT(quality.trace.coarsestLevel)),
            live<float>(knobs::tolerance, SCONCE_AT(quality.trace.tolerance)),
            live<float>(knobs::epsilon, SCONCE_AT(quality.trace.epsilon)),
            live<int>(knobs::farBounds, SCONCE_AT(quality.trace.farBounds)),
            live<int>(knobs::order, SCONCE_AT(quality.trace.order))};
}

} // namespace

std::span<const LiveKnob> liveKnobs()
{
    static const std::vector<LiveKnob> all = makeLiveKnobs();
    return all;
}

std::string setKnob(ViewKnobs& target, const std::string& name, const std::string& text)
{
    std::string names;
    for (const LiveKnob& knob : liveKnobs())
    {
        if (knob.row.name == name) return knob.set(target, text);
        names += fmt::format("{}{}", names.empty() ? "" : ", ", knob.row.name);
    }
    return fmt::format("there is no knob '{}' to set; there are {}", name, names);
}

Result<std::string> effectsWith(const EffectPlan& plan, std::string_view name, bool on)
{
    std::string text = "auto", names;
    bool known = false;
    for (const PlannedEffect& effect : plan.effects)
    {
        const bool meant = effect.name == name;
        known = known || meant;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", effect.name);
        if (meant && on && !effect.called)
            return Error{ErrorCode::badArgument, fmt::format("The scene doesn't call for the effect '{}': {}", name, effect.why)};
        if (effect.called && !(meant ? on : effect.on)) text += fmt::format(",-{}", effect.name);
    }
    if (!known) return Error{ErrorCode::badArgument, fmt::format("There is no effect '{}'; there are {}.", name, names)};
    return text;
}

} // namespace sconce::tools
