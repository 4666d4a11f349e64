#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/race/traced_method.h"
#include "runtime/field/quality.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce
{

using Json = nlohmann::ordered_json;

inline constexpr const char* kPathTracer = "path tracer";

/// Everything that one point of the bench is measured with, but its scene and picture. The defaults are ours.
struct PointSettings
{
    std::string method = "ours"; // ours, ours-grid (on a uniform grid), an opponent's (bench/opponents/baselines.h), or the path tracer
    uint32_t probes = 0;         // asked for; a grid takes the nearest that its shape allows
    std::string placement = "optimised"; // optimised, skeleton (not refined afterwards), balls, grid
    uint32_t resolution = 416;           // texels a side of an octahedral map; cube faces have half of it
    uint32_t bounces = 2;
    int octreeVoxels = 0;   // OctreeSettings::voxels
    uint32_t lowFactor = 0; // of an opponent; 0: bestLowFactor
    int distanceBits = 32;  // of a texel of ours (bench/race/distance_format.h)
    Quality quality;        // of our tracer
    RenderSettings frame;
    uint32_t paths = 1; // a pixel, of the path tracer

    bool pathTraced() const { return method == kPathTracer; }
    std::optional<Baseline> opponent() const { return baselineNamed(method); }
    uint32_t chart() const; // that the method reads
};

/// What a knob decides, and so what must be made anew when it changes.
enum class Stage
{
    place,
    bake,
    trace, // of rays and frames
    frame  // of frames only
};

/// A knob that trades accuracy for time or memory.
struct Knob
{
    std::string_view name;
    Stage stage;
    std::vector<std::string_view> methods; // that have it
    std::vector<std::string_view> sweep;   // values that a bench measures, the default may be among them; empty: the plan says
    std::string_view unit;
    std::function<Json(const PointSettings&)> get;
    std::function<bool(PointSettings&, std::string_view)> set; // false: not a value of it
};

/// All of them. A knob of RenderSettings, Quality or the bake is one line of the table in settings.cpp.
std::span<const Knob> knobs();
const Knob* findKnob(std::string_view name);

/// Those that the method has, {"probes": 54, ...}; `stages`: only of those up to this one.
Json settingsJson(const PointSettings& settings, Stage upTo = Stage::frame);
/// The other way, unknown names and values out of place refused. Errors: badInput with a sentence.
Result<PointSettings> settingsFrom(const std::string& method, const Json& json);

} // namespace sconce
