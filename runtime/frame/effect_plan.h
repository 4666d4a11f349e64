#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/knobs.h"
#include "base/result.h"
#include "scene/scene_check.h"
#include "shaders/shared/light_field.h"

namespace sconce
{

/// Which terms and filters of indirect light are made. What is off has no pipeline, no image and no dispatch.
struct IndirectEffects
{
    bool diffuse = true;        // diffuse light
    bool surfaceLight = true;   // diffuse light from the surface light, where the field holds it and the next two don't say otherwise; else
                                // from prefiltered irradiance
    bool tracedDiffuse = false; // by traced rays, emitters and sky seen by them
    bool patches = false;       // from the probes' patches; nothing where it is traced
    bool fieldShadows = knobs::areaShadows.is("field"); // emitters' and the sky's samples shadowed by rays through the light field, not by
                                                        // maps; nothing where rays give diffuse light
    bool rough = true;                     // reflections from prefiltered radiance, of surfaces rougher than FrameView::raysBelow
    bool glossy = true;                    // reflections by traced rays
    bool mirror = true;                    // the one ray of perfect mirrors
    bool denoise = knobs::denoise.value;   // of the glossy term
    bool temporal = knobs::temporal.value; // filter over time, too, what is filtered over the picture
    bool screenTrace =
        knobs::screenTrace.value; // traced reflections show what the picture of the frame before does, too, where they meet it
    bool tiles = true;            // run each pass on the tiles that need it; false: over the whole picture, with the same pixels
};

/// Whether frames with these effects read diffuse light from the field's surface light.
inline bool readsSurfaceLight(const IndirectEffects& e, const gpu::LightFieldInfo& field)
{
    return e.diffuse && e.surfaceLight && !e.tracedDiffuse && !e.patches && field.surfaceSize > 0;
}

/// One effect: whether the scene calls for it and why, what it costs, and whether the plan has it.
struct PlannedEffect
{
    std::string name;     // as SceneEffect, and `denoise`
    bool ofScene = false; // what the scene consists of, which a light field remembers; else a pass
    bool called = false;
    bool on = false;
    std::string why;     // a sentence
    std::string cost;    // a sentence
    std::string givenUp; // a sentence: what picture and bake lack; empty unless called and off
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

/// @param wanted  auto: what the scene calls for; all: everything, over the whole picture, for the same pixels; none of the passes; or a
///                list of names, parted by commas: of the passes only those named. What the scene consists of (sun, punctual, emitters,
///                sky; masked, thin-two-sided) stays unless some of the same kind is named. A minus takes a name away: "auto,-mirror"
/// Errors: badArgument (names what is not an effect, and lists those that are).
Result<EffectPlan> planEffects(const SceneReport& scene, std::string_view wanted = "auto");

/// Takes from a scene what its plan has not: lights, emission, sky, holes cut by alpha, back faces. Bake and draw what is left: nothing
/// that was taken away leaves a pipeline, a shadow map, a byte or a trace of its light.
void capScene(Scene& scene, const EffectPlan& plan);

} // namespace sconce
