#include "runtime/bake/group_bake.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/parallel.h"
#include "runtime/bake/surface_baker.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/live_light.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

void addSeconds(BakeReport& all, const BakeReport& one)
{
    for (double BakeReport::*part : {&BakeReport::sceneSeconds, &BakeReport::probeSeconds, &BakeReport::octreeSeconds,
                                     &BakeReport::gatherSeconds, &BakeReport::bounceSeconds, &BakeReport::prefilterSeconds})
        all.*part += one.*part;
    all.gatherRays += one.gatherRays;
    all.longestSubmission = std::max(all.longestSubmission, one.longestSubmission);
    all.peakDeviceBytes = std::max(all.peakDeviceBytes, one.peakDeviceBytes);
}

/// Whether two bakes of one scene have kept their light at the same places.
bool samePlaces(const FieldData& a, const FieldData& b)
{
    return a.distance == b.distance && a.octree.texels == b.octree.texels && a.radiance.size() == b.radiance.size() &&
           a.prefiltered.size() == b.prefiltered.size() && a.surfaceLight.size() == b.surfaceLight.size() &&
           a.info.refinedTexels == b.info.refinedTexels && a.info.hidden == b.info.hidden && a.lamps.size() == b.lamps.size();
}

/// Takes a group's light out of its bake.
LightGroup groupOf(FieldData&& baked, LightGroupDesc which)
{
    LightGroup group{std::move(which),
                     baked.info.sky,
                     {},
                     std::move(baked.radiance),
                     std::move(baked.irradiance),
                     std::move(baked.prefiltered),
                     std::move(baked.surfaceLight)};
    for (const gpu::Lamp& lamp : baked.lamps) group.lamps.push_back(lamp.radiance);
    return group;
}

/// Where rays of some group found too little, none of the shares is known: else there would be light missing.
void agreeOnKnown(FieldData& field)
{
    const size_t words = field.surfaceLight.size(), cells = surfaceTexelWords(field.info),
                 texels = twin::LightFieldTwin<float>(field, {}).surfaceTexels();
    parallelFor(words,
                [&](size_t i)
                {
                    if (i >= texels && i < cells) return; // tilts
                    const auto unknown = [&](const LightGroup& group) { return group.surfaceLight[i] == 0; };
                    if (std::ranges::any_of(field.groups, unknown))
                        for (LightGroup& group : field.groups) group.surfaceLight[i] = 0;
                });
}

/// Takes lights of no extent that no group names out of the groups, which is what moves.
/// @param groups, selected  of the scene; the one of all other light goes where nothing is left in it, unless it is the only one
std::vector<uint32_t> takeLiveLights(std::vector<LightGroupDesc>& groups, std::vector<LightSelection>& selected)
{
    const auto rest = std::ranges::find_if(groups, [](const LightGroupDesc& group) { return group.members.empty(); });
    if (rest == groups.end()) return {};
    LightSelection& others = selected[size_t(rest - groups.begin())];
    std::vector<uint32_t> live = std::exchange(others.lights, {});
    if (groups.size() > 1 && others.materials.empty() && !others.sky)
    {
        selected.erase(selected.begin() + (rest - groups.begin()));
        groups.erase(rest);
    }
    return live;
}

std::string groupFault(const BakeSettings& settings, size_t probes)
{
    if (settings.chart != gpu::kChartCube || settings.surfaceTexels == 0 || settings.light)
        return "light groups are kept of surface light on cube faces; give surface texels, and the chart cube";
    if (settings.faces)
        return "faces that a host draws show the emission of all lights at once, and light groups and live links keep it apart; bake "
               "without them, or let the bake draw the scene";
    if (settings.compact)
        return "light that may change can't be in blocks; leave compact false, or bake without light groups and live links";
    if (settings.liveLinks == 0)
        return settings.lit ? "" : "geometry and material alone are light's links; give live links, or let the field be lit";
    if (!settings.rays) return "live links are found by rays to triangles; give rays, or gather by triangles";
    if (settings.liveLinks > settings.surfaceRays)
        return fmt::format("there are {} live links of {} rays that gather surface light; give no more links than rays", settings.liveLinks,
                           settings.surfaceRays);
    const uint64_t side = surfaceSizeOf(settings.chart, chartSize(settings.chart, settings.resolution), settings.surfaceTexels);
    if (const uint64_t links = 6 * side * side * probes * settings.liveLinks; links > kMostLiveLinks)
        return fmt::format("{} probes have {} live links, and there may be {}; give fewer probes, live links, or surface texels", probes,
                           links, kMostLiveLinks);
    return {};
}

/// Bakes of one scene: in all light, then in that of each group.
struct GroupBakes
{
    std::vector<LightGroupDesc> groups;
    std::vector<LightSelection> selected;
    std::vector<uint32_t> live; // lights of the scene that move
    LightLayout layout;
    BakeSettings settings; // with the layout

    /// A group's light alone.
    Scene sceneOf(const Scene& scene, size_t group) const
    {
        Scene alone = scene;
        for (const uint32_t light : live) alone.lights[light].intensity = vec3(0.0f);
        for (size_t other = 0; other < groups.size(); ++other)
            if (other != group) dimLights(alone, selected[other], vec3(0.0f));
        return alone;
    }
    std::string nameOf(size_t group) const { return fmt::format("light group '{}'", groups[group].name); }
};

/// @param plan  is referred to by its own settings
Status planGroups(const Scene& scene, size_t probes, const BakeSettings& settings, std::vector<LightGroupDesc> groups, GroupBakes& plan)
{
    if (std::string fault = groupFault(settings, probes); !fault.empty()) return Error{ErrorCode::badArgument, "Bake: " + fault};
    if (settings.liveLinks > 0 && groups.empty()) groups.push_back({"rest", {}});
    auto selected = selectLights(scene, groups);
    if (!selected) return selected.error();
    if (settings.liveLinks > 0) plan.live = takeLiveLights(groups, *selected);
    std::vector<Light> lights;
    for (const uint32_t light : plan.live) lights.push_back(scene.lights[light]);
    if (std::string fault = lightFault(lights); !fault.empty()) return Error{ErrorCode::badArgument, "Bake, live links: " + fault};
    plan.groups = std::move(groups);
    plan.selected = std::move(*selected);
    plan.layout.liveLinks = settings.liveLinks;
    plan.layout.groups = plan.groups.size();
    plan.settings = settings;
    plan.settings.layout = &plan.layout;
    return success();
}

Progress named(const Progress& progress, const std::string& name)
{
    return [&progress, name](std::string_view stage, double done)
    { return sconce::report(progress, fmt::format("{}: {}", name, stage), done); };
}
constexpr const char* kAllLight = "all light";

} // namespace

Status bakeGroupShard(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                      std::vector<LightGroupDesc> groups, const BakeShard& shard, const Progress& progress, BakeReport& report)
{
    GroupBakes plan;
    if (auto status = planGroups(scene, probes.size(), settings, std::move(groups), plan); !status) return status;
    if (auto status = bakeShard(gpu, scene, probes, plan.settings, shard, named(progress, kAllLight), report); !status) return status;
    plan.layout.live.links = settings.liveLinks; // as the bake of all light leaves it: the groups' don't find links anew
    for (size_t g = 0; g < plan.groups.size(); ++g)
    {
        BakeReport spent;
        auto status = bakeShard(gpu, plan.sceneOf(scene, g), probes, plan.settings, shard, named(progress, plan.nameOf(g)), spent);
        if (!status) return status;
        addSeconds(report, spent);
    }
    return success();
}

Result<FieldData> bakeLightGroups(Gpu& gpu, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                                  std::vector<LightGroupDesc> wanted, const Progress& progress, BakeReport& report)
{
    GroupBakes plan;
    if (auto status = planGroups(scene, probes.size(), settings, std::move(wanted), plan); !status) return status.error();
    const std::vector<LightGroupDesc>& groups = plan.groups;
    auto field = bakeLightField(gpu, scene, probes, plan.settings, named(progress, kAllLight), report);
    if (!field) return field;
    for (size_t g = 0; g < groups.size(); ++g)
    {
        BakeReport spent;
        auto part = bakeLightField(gpu, plan.sceneOf(scene, g), probes, plan.settings, named(progress, plan.nameOf(g)), spent);
        if (!part) return part;
        if (!samePlaces(*field, *part))
            return Error{ErrorCode::deviceFailure,
                         fmt::format("Bake: light group '{}' was baked to other places than all light; the device does not draw the same "
                                     "scene twice alike",
                                     groups[g].name)};
        addSeconds(report, spent);
        field->bounces = std::max(field->bounces, part->bounces);
        field->groups.push_back(groupOf(std::move(*part), groups[g]));
    }
    agreeOnKnown(*field);
    const std::vector<vec3> weights(groups.size(), vec3(1.0f));
    if (settings.liveLinks == 0)
    {
        if (auto status = mixGroups(*field, weights); !status) return status.error();
        return field;
    }
    field->live = std::move(plan.layout.live);
    std::vector<Light> lights;
    for (const uint32_t light : plan.live) lights.push_back(scene.lights[light]);
    // Fewer than by default are wanted for their own sake; else light that moves settles.
    const uint32_t bounces = settings.bounces < knobs::bounces.value ? settings.bounces : knobs::bounces.most;
    const auto relit = settings.lit ? relightField(gpu, *field, lights, weights, bounces)
                                    : relightField(gpu, *field, {}, std::vector<vec3>(groups.size(), vec3(0.0f)));
    if (!relit) return relit.error();
    if (settings.lit) return field;
    field->live.lights = std::move(lights); // which whoever lights it takes if told nothing else
    field->live.lit = false;
    return field;
}

} // namespace sconce
