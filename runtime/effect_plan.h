#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/result.h"
#include "scene/scene_check.h"

namespace sconce
{

/// Which terms and filters of indirect light are made. What is off has no pipeline, no image and no dispatch.
struct IndirectEffects
{
    bool diffuse = true;   // prefiltered irradiance
    bool rough = true;     // reflections from prefiltered radiance, of surfaces rougher than FrameView::raysBelow
    bool glossy = true;    // reflections by traced rays
    bool mirror = true;    // the one ray of perfect mirrors
    bool denoise = true;   // of the glossy term
    bool temporal = false; // filter over time, too, what is filtered over the picture
    bool tiles = true;     // run each pass on the tiles that need it; false: over the whole picture, with the same pixels
};

/// One effect: whether the scene calls for it and why, what it costs, and whether the plan has it.
struct PlannedEffect
{
    std::string name; // as SceneEffect, and `denoise`
    bool called = false;
    bool on = false;
    std::string why;  // a sentence
    std::string cost; // a sentence
};

/// What a frame and a light field have of all effects. Called for and off: what the host gives up.
struct EffectPlan
{
    std::vector<PlannedEffect> effects;
    bool wholePicture = false; // every pass over the whole picture: `all`

    bool on(std::string_view name) const;
    bool called(std::string_view name) const;
    IndirectEffects indirect() const;
    bool needsRadiance() const { return on("glossy") || on("mirror"); }
    bool needsPrefiltered() const { return on("rough"); }
};

/// @param wanted  auto: what the scene calls for; all: everything, over the whole picture, for the same pixels; none; or a list of names,
///                parted by commas: of those only what is named. A name with a minus is taken away: "auto,-mirror"
/// Errors: badArgument (names what is not an effect, and lists those that are).
Result<EffectPlan> planEffects(const SceneReport& scene, std::string_view wanted = "auto");

} // namespace sconce
