#include "runtime/bake/group_bake.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/parallel.h"
#include "runtime/bake/surface_baker.h"
#include "runtime/field/light_groups.h"
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

} // namespace

Result<FieldData> bakeLightGroups(const HostVulkan& host, const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings,
                                  std::vector<LightGroupDesc> groups, const Progress& progress, BakeReport& report)
{
    const auto selected = selectLights(scene, groups);
    if (!selected) return selected.error();
    if (settings.chart != gpu::kChartCube || settings.surfaceTexels == 0 || settings.light)
        return Error{ErrorCode::badArgument,
                     "Bake: light groups are kept of surface light on cube faces; give surface texels, and the chart cube"};
    LightLayout layout;
    BakeSettings own = settings;
    own.layout = &layout;
    const auto baked = [&](const Scene& lit, const std::string& name, BakeReport& spent)
    {
        const Progress named = [&](std::string_view stage, double done)
        { return sconce::report(progress, fmt::format("{}: {}", name, stage), done); };
        return bakeLightField(host, lit, probes, own, named, spent);
    };
    auto field = baked(scene, "all light", report);
    if (!field) return field;
    for (size_t g = 0; g < groups.size(); ++g)
    {
        Scene alone = scene;
        for (size_t other = 0; other < groups.size(); ++other)
            if (other != g) dimLights(alone, (*selected)[other], vec3(0.0f));
        BakeReport spent;
        auto part = baked(alone, fmt::format("light group '{}'", groups[g].name), spent);
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
    if (auto status = mixGroups(*field, std::vector<vec3>(groups.size(), vec3(1.0f))); !status) return status.error();
    return field;
}

} // namespace sconce
