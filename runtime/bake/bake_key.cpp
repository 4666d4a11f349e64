#include "runtime/bake/bake_key.h"

#include "runtime/bake/surface_baker.h"
#include "runtime/scene/content_key.h"

namespace sconce
{
namespace
{

void addSettings(ContentHash& hash, const BakeSettings& s)
{
    hash.add(s.resolution), hash.add(s.chart), hash.add(s.bounces), hash.add(s.converged);
    hash.add(s.surfaceTexels), hash.add(s.surfaceRefined), hash.add(s.lampTexels), hash.add(s.surfaceRays), hash.add(s.liveLinks);
    hash.add(s.lit), hash.add(s.rays != nullptr), hash.add(s.radiance), hash.add(s.readsSurfaces), hash.add(s.prefiltered);
    hash.add(s.octree.voxels), hash.add(s.octree.topShift);
    hash.add(s.effects.size());
    for (const std::string& effect : s.effects) hash.addText(effect);
    const LightSettings& light = s.scene.light;
    hash.add(s.scene.maxTextureSize), hash.add(light.emitterSamples), hash.add(light.skySamples), hash.add(light.areaShadows);
    hash.add(light.sunShadow), hash.add(light.pointShadow), hash.add(light.emitterShadow), hash.add(light.skyShadow);
    hash.addAll(light.lamps);
    hash.add(s.grid.has_value());
    if (s.grid)
    {
        for (int axis = 0; axis < 3; ++axis) hash.add(s.grid->count[axis]);
        hash.add(s.grid->origin), hash.add(s.grid->step);
    }
}

/// Of the first of some bakes of one scene in several lights, what the maps and links of the next depend on.
void addLayout(ContentHash& hash, const LightLayout& layout)
{
    hash.add(layout.liveLinks), hash.add(layout.groups), hash.add(layout.live.links), hash.add(layout.lamps.has_value());
    if (layout.lamps) hash.addAll(layout.lamps->triangles), hash.addAll(layout.lamps->maps);
}

} // namespace

uint64_t bakeKey(const Scene& scene, std::span<const vec3> probes, const BakeSettings& settings)
{
    ContentHash hash;
    addScene(hash, scene);
    hash.addText(scene.name); // which the field keeps
    hash.add(probes.size());
    for (const vec3& probe : probes) hash.add(probe);
    addSettings(hash, settings);
    hash.add(settings.light != nullptr);
    if (settings.light) hash.add(settings.light->bounces), hash.addAll(settings.light->surfaceLight);
    hash.add(settings.layout != nullptr);
    if (settings.layout) addLayout(hash, *settings.layout);
    return hash.value();
}

uint64_t deviceKey(const HostVulkan& host)
{
    const auto ask =
        reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(host.getInstanceProcAddr(host.instance, "vkGetPhysicalDeviceProperties"));
    VkPhysicalDeviceProperties is{};
    ask(host.physicalDevice, &is);
    ContentHash hash;
    hash.add(is.vendorID), hash.add(is.deviceID), hash.add(is.driverVersion), hash.add(is.apiVersion);
    hash.addText(is.deviceName);
    hash.addBytes(std::as_bytes(std::span(is.pipelineCacheUUID))); // of the driver's build
    return hash.value();
}

} // namespace sconce
