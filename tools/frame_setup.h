#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/field/field_data.h"
#include "runtime/field/live_light.h"
#include "runtime/frame/effect_plan.h"
#include "runtime/scene/scene_renderer.h"
#include "tools/common.h"

namespace sconce::tools
{

inline constexpr std::string_view kSurface = knobs::kDiffuse[0], kIrradiance = knobs::kDiffuse[1], kPatches = knobs::kDiffuse[2],
                                  kTraced = knobs::kDiffuse[3];
inline constexpr std::string_view kMaps = knobs::kAreaShadows[0], kField = knobs::kAreaShadows[1];
static_assert(kSurface == "surface" && kPatches == "patches" && kTraced == "traced" && kField == "field");

/// What `render` and `view` let people choose of a frame. Ranges and prices: base/knobs.h.
struct FrameChoice
{
    std::string effects = "auto"; // as planEffects() takes them
    uint32_t samples = knobs::glossyRays.value, traceEvery = knobs::traceEvery.value, surfaceProbes = knobs::surfaceProbes.value,
             seed = knobs::frameSeed.value;
    uint32_t areaSamples = 0; // 0: by samples
    std::optional<float> roughness;
    float raysBelow = knobs::raysBelow.value;
    bool noDenoise = !knobs::denoise.value, temporal = knobs::temporal.value, screenTrace = knobs::screenTrace.value;
    std::string diffuse{knobs::diffuse.value}; // empty: surface, irradiance where the field has no surface light
    std::string areaShadows{knobs::areaShadows.value};

    bool operator==(const FrameChoice&) const = default;
};

/// Its options. @param choice  lives as long as the command line
void addFrameOptions(CLI::App* command, FrameChoice& choice);

/// The plan for the scene as it is drawn: with `roughness` every surface has that. Errors: badArgument (names what is no effect).
/// @param sunComes  a sun will shine in it, whether it has one or not
Result<EffectPlan> planFor(const FrameChoice& choice, const Scene& scene, bool sunComes = false);

/// The choice's, but for size and tracer. @param diffuse  out: that was chosen
/// @param field  its file's name, for the sentence
/// Errors: badArgument: diffuse light that the field doesn't hold.
Result<RenderSettings> settingsFor(const FrameChoice& choice, const EffectPlan& plan, const FieldData& data, const std::string& field,
                                   std::string& diffuse);

/// The light that pictures are drawn in.
struct Lighting
{
    std::vector<vec3> weights; // of the field's groups; empty: as they were baked
    std::vector<Light> fixed;  // of the scene, that stay
    std::vector<Light> lights; // that move
    bool moves = false;        // live light is to be made
};

/// Takes what moves out of the scene, changes the rest of its light by weights of groups, and puts what moves there again.
/// @param groups  of the scene, where the field has none
/// @param dims  as weightsOf() takes them
/// Errors: as takeLiveLights() and dimScene().
Result<Lighting> lightFor(const FieldData& data, std::span<const LightGroupDesc> groups, std::span<const std::string> dims, Scene& scene);

/// Changes the light of a field on the device, as a host does before a frame. @return  milliseconds by the device's clock; 0: it has none
Result<double> dimField(Gpu& gpu, LightGroups& groups, std::span<const vec3> weights);

/// Lights a field with live links anew, to the end. @return  milliseconds by the device's clock, a pass
Result<std::map<std::string, double>> settle(Gpu& gpu, LiveLight& live, const LightState& state);

} // namespace sconce::tools
