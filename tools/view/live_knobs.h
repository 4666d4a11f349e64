#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/knobs.h"
#include "runtime/field/quality.h"
#include "tools/frame_setup.h"

namespace sconce::tools
{

/// What the panel and a script's `set` change.
struct ViewKnobs
{
    FrameChoice frame;
    Quality quality;
    float normalOffset = knobs::normalOffset.value; // diagonals
    std::optional<float> exposure;                  // none: from the picture's log-average
};

/// One of them, by its row of base/knobs.h.
struct LiveKnob
{
    enum class Kind
    {
        whole,
        real,
        choice, // among `choices`
        flag    // on, off
    };
    KnobRow row;
    Kind kind = Kind::whole;
    double least = 0.0, most = 0.0;   // of numbers
    std::vector<std::string> choices; // every value there is, where it isn't all of the range
    /// As people write it; "default" where a value is derived.
    std::function<std::string(const ViewKnobs&)> get;
    /// @param text  a value, or "default" @return  what is wrong with it, without its full stop; empty: it is set
    std::function<std::string(ViewKnobs&, const std::string& text)> set;
};

inline constexpr std::string_view kDefaultWord = "default";

/// In the panel's order: of the frame, of the tracer.
std::span<const LiveKnob> liveKnobs();

/// Sets one by its name. @return  what is wrong, without its full stop: no such knob, with those that there are, or the value
std::string setKnob(ViewKnobs& target, const std::string& name, const std::string& text);

/// A plan's effects with one switched, as FrameChoice::effects takes them: "auto,-mirror".
/// Errors: badArgument: no such effect, or one to be on that the scene doesn't call for.
Result<std::string> effectsWith(const EffectPlan& plan, std::string_view name, bool on);

} // namespace sconce::tools
