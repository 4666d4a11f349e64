#include "bench/sweep/plan.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "bench/sweep/tune.h"
#include "runtime/field/field_data.h"

namespace sconce
{
namespace
{

const std::string kLevelKnob = "level"; // the named quality levels

struct Opponent
{
    const char* name;
    const char* placement;
    uint32_t faces;            // 0: maps as ours; 1: octahedral maps of as much memory; 2: cube faces of a power of two of texels a side
    std::vector<double> curve; // further resolutions, times the default's
};

const std::vector<Opponent>& opponents()
{
    static const std::vector<Opponent> all{{"ours-grid", "grid", 0, {}},        {"b0", "grid", 1, {0.5, 2.0}},
                                           {"b0plus", "grid", 1, {0.5, 2.0}},   {"b0plus-octree", "optimised", 1, {0.5, 2.0}},
                                           {"wang", "optimised", 2, {0.5}},     {"ddgi", "grid", 0, {}},
                                           {"ddgi-placed", "optimised", 0, {}}, {"sh-grid", "grid", 0, {}}};
    return all;
}

/// Texels a side of the largest octahedral maps that take no more bytes than cube faces of a resolution.
uint32_t octahedralOfAsMuch(uint32_t resolution)
{
    uint32_t size = resolution & ~15u; // whole cells of the low-resolution map
    while (bytesPerProbe(gpu::kChartOctahedral, size + 16) <= bytesPerProbe(gpu::kChartCube, resolution)) size += 16;
    return size;
}

class Planner
{
public:
    explicit Planner(const PlanSettings& planSettings) : plan(planSettings) {}

    void addDefault(const PointSettings& settings)
    {
        if (wants(settings)) points.push_back({settings.method + "/default", "default", "", settings});
    }

    /// Nothing where the value is the default's.
    void addVaried(const PointSettings& base, const SweptKnob& knob, const std::string& value)
    {
        if (!wants(base)) return;
        if (!plan.knobs.empty() && std::ranges::find(plan.knobs, knob.name) == plan.knobs.end()) return;
        PlannedPoint point{fmt::format("{}/{}={}", base.method, knob.name, value), std::string(knob.name), value, base};
        if (!knob.set(point.settings, value)) return; // beyond its range, as half of the least resolution is
        if (knob.get(point.settings) == knob.get(base)) return;
        const auto same = [&](const PlannedPoint& other) { return other.id == point.id; };
        if (std::ranges::none_of(points, same)) points.push_back(std::move(point));
    }

    void addLevel(const PointSettings& base, const QualityLevel& level)
    {
        if (!wants(base) || (!plan.knobs.empty() && std::ranges::find(plan.knobs, kLevelKnob) == plan.knobs.end())) return;
        const std::string value(level.name);
        points.push_back({fmt::format("{}/{}={}", base.method, kLevelKnob, value), kLevelKnob, value, base});
        applyLevel(points.back().settings, level);
    }

    void addProbeCounts(const PointSettings& base, std::initializer_list<double> factors)
    {
        for (const double factor : factors)
            addVaried(base, *findKnob("probes"), fmt::to_string(std::max(1u, uint32_t(base.probes * factor))));
    }

    std::vector<PlannedPoint> points;

private:
    bool wants(const PointSettings& settings) const
    {
        return plan.methods.empty() || std::ranges::find(plan.methods, settings.method) != plan.methods.end();
    }

    const PlanSettings& plan;
};

std::vector<std::string> methodNames()
{
    std::vector<std::string> names{PointSettings{}.method};
    for (const Opponent& opponent : opponents()) names.push_back(opponent.name);
    names.insert(names.end(), {kPathTracer, kFilteredPaths});
    return names;
}

} // namespace

Result<std::vector<PlannedPoint>> planPoints(const PlanSettings& settings)
{
    const std::vector<std::string> methods = methodNames();
    for (const std::string& name : settings.methods)
        if (std::ranges::find(methods, name) == methods.end())
            return Error{ErrorCode::badArgument, fmt::format("There is no method '{}'; there are: {}.", name, fmt::join(methods, ", "))};
    for (const std::string& name : settings.knobs)
        if (!findKnob(name) && name != kLevelKnob)
        {
            std::string known;
            for (const SweptKnob& knob : sweptKnobs()) known += fmt::format("{}, ", knob.name);
            return Error{ErrorCode::badArgument, fmt::format("There is no knob '{}'; there are: {}{}.", name, known, kLevelKnob)};
        }
    Planner planner(settings);
    PointSettings ours = settings.ours;
    ours.method = PointSettings{}.method;
    ours.probes = settings.probes;
    ours.frame.roughness = settings.roughness;
    planner.addDefault(ours);
    std::vector<PointSettings> theirs;
    for (const Opponent& opponent : opponents())
    {
        PointSettings point = ours;
        point.method = opponent.name;
        point.placement = opponent.placement;
        point.lightResolution = ours.resolution;
        if (opponent.faces == 1) point.resolution = octahedralOfAsMuch(ours.resolution);
        if (opponent.faces == 2) point.resolution = 2 * std::bit_ceil(ours.resolution); // wang's chain halves its maps to the last
        theirs.push_back(point);
        planner.addDefault(point);
    }
    for (const char* method : {kPathTracer, kFilteredPaths})
    {
        PointSettings paths = ours;
        paths.method = method;
        planner.addDefault(paths);
        for (const std::string_view value : findKnob("paths")->sweep) planner.addVaried(paths, *findKnob("paths"), std::string(value));
    }
    // Volumes with as many bytes as our diffuse light is read from: surface light, cells, and the distances that tell which probe sees a
    // point.
    const size_t without = bytesPerProbe(gpu::kChartCube, ours.resolution, 0), face = ours.resolution / 2,
                 surface = bytesPerProbe(gpu::kChartCube, ours.resolution, knobs::surfaceTexels.value) - without +
                           (2 * gpu::kPatches + 6 * face * face) * sizeof(uint32_t);
    for (const PointSettings& volume : theirs)
        if (volume.volume() && *volume.volume() != Volume::ddgiPlaced)
            planner.addProbeCounts(volume, {double(surface) / double(sizeof(uint32_t) * volumeWordsPerProbe(*volume.volume()))});
    if (settings.methodsOnly) return std::move(planner.points);

    planner.addProbeCounts(ours, {0.25, 0.5, 2.0});
    for (const SweptKnob& knob : sweptKnobs())
        if (std::ranges::find(knob.methods, ours.method) != knob.methods.end())
            for (const std::string_view value : knob.sweep) planner.addVaried(ours, knob, std::string(value));
    for (const QualityLevel& level : qualityLevels()) planner.addLevel(ours, level);
    for (size_t i = 0; i < theirs.size(); ++i)
    {
        // Opponents get what any method has: other numbers of probes and texels, more rays, sparser tracing.
        planner.addProbeCounts(theirs[i], {0.5, 2.0});
        for (const double factor : opponents()[i].curve)
            planner.addVaried(theirs[i], *findKnob("resolution"), fmt::to_string(uint32_t(theirs[i].resolution * factor) & ~15u));
        if (theirs[i].volume()) continue;
        planner.addVaried(theirs[i], *findKnob("rays"), "4");
        planner.addVaried(theirs[i], *findKnob("trace every"), "4"); // any tracer gains by it
    }
    return std::move(planner.points);
}

} // namespace sconce
