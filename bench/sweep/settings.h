#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/opponents/irradiance_volume.h"
#include "bench/race/traced_method.h"
#include "runtime/field/quality.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce
{

using Json = nlohmann::ordered_json;

inline constexpr const char* kPathTracer = "path tracer";
inline constexpr const char* kFilteredPaths = "path tracer filtered"; // its picture through our filters

/// Everything that one point of the bench is measured with, but its scene and picture. The defaults are ours.
struct PointSettings
{
    std::string method = "ours";                // ours, ours-grid (on a uniform grid), an opponent's (bench/opponents), or the path tracer
    uint32_t probes = knobs::benchProbes.value; // asked for; a grid takes the nearest that its shape allows
    std::string placement = std::string(knobs::placement.value); // optimised, skeleton (not refined afterwards), balls, grid
    uint32_t resolution = knobs::benchResolution.value;          // texels a side of an octahedral map; cube faces have half of it
    uint32_t lightResolution = knobs::benchResolution.value;     // of the maps of cube faces by which an opponent's maps are lit
    uint32_t bounces = knobs::benchBounces.value;
    uint32_t surfaceTexels =
        knobs::surfaceTexels.value;                     // of ours, and of what an opponent's maps are lit by; patches are of fields without
    uint32_t surfaceRays = knobs::surfaceRays.value;    // that gather light for each
    float surfaceRefined = knobs::surfaceRefined.value; // share of them, where triangles are gathered from
    bool fieldGather = knobs::gather.is("field");       // surface light gathered through the field, not by rays to triangles
    int octreeVoxels = knobs::octreeVoxels.value;       // OctreeSettings::voxels
    uint32_t lowFactor = knobs::lowFactor.value;        // of an opponent; 0: bestLowFactor
    float lookUpBias = knobs::lookUpBias.value; // of B0+'s light and of a volume of irradiance, metres along the normal; below 0: the best
    float lookUpView = knobs::lookUpView.value; // times as far towards the viewer
    int distanceBits = knobs::distanceBits.value; // of a texel of ours (bench/race/distance_format.h)
    bool compact = knobs::compact.value;          // of ours
    Quality quality;                              // of our tracer
    RenderSettings frame;
    uint32_t paths = knobs::tracedPaths.value; // a pixel, of the path tracer

    bool filteredPaths() const { return method == kFilteredPaths; }
    bool pathTraced() const { return method == kPathTracer || filteredPaths(); }
    std::optional<Baseline> opponent() const { return baselineNamed(method); }
    std::optional<Volume> volume() const { return volumeNamed(method); }
    bool biasedLookUps() const { return volume() || opponent() == Baseline::b0Plus; } // lookUpBias is one of theirs
    /// Whose diffuse light is read where probes are: the light of lamps and sky is the path tracer's, beside what it reads.
    bool givenLamps() const { return (volume() || opponent()) && !frame.effects.tracedDiffuse; }
    uint32_t chart() const;              // that the method reads
    uint32_t bakedSurfaceTexels() const; // 0 for whoever doesn't read surface light
};

/// What a knob decides, and so what must be made anew when it changes.
enum class Stage
{
    place,
    bake,
    trace, // of rays and frames
    frame  // of frames only
};

/// A knob that a bench sweeps: one of base/knobs.h by the name that results have for it. What that doesn't allow, `set` refuses.
struct SweptKnob
{
    std::string_view name;
    Stage stage;
    std::vector<std::string_view> methods; // that have it
    std::vector<std::string_view> sweep;   // values that a bench measures, the default may be among them; empty: the plan says
    std::string_view unit;
    std::string range; // in words
    std::function<Json(const PointSettings&)> get;
    std::function<bool(PointSettings&, std::string_view)> set; // false: not a value of it
};

/// All of them. A knob of RenderSettings, Quality or the bake is one line of the table in settings.cpp.
std::span<const SweptKnob> sweptKnobs();
const SweptKnob* findKnob(std::string_view name);

/// Those that the method has, {"probes": 54, ...}; `stages`: only of those up to this one.
Json settingsJson(const PointSettings& settings, Stage upTo = Stage::frame);
/// The other way, unknown names and values out of place refused. Errors: badInput with a sentence.
Result<PointSettings> settingsFrom(const std::string& method, const Json& json);

} // namespace sconce
