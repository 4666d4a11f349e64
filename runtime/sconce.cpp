#include "runtime/sconce.h"

#include "runtime/bake/bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/frame/indirect_light.h"

namespace sconce
{

Version libraryVersion()
{
    return {};
}

Result<Device> Device::create(const HostVulkan& host, Version header)
{
    const auto text = [](const Version& v)
    { return std::to_string(v.major) + "." + std::to_string(v.minor) + "." + std::to_string(v.patch); };
    if (header.major != libraryVersion().major || header.minor != libraryVersion().minor)
        return Error{ErrorCode::badArgument, "sconce.h is of version " + text(header) + " and the linked library of " +
                                                 text(libraryVersion()) + "; compile and link against the same"};
    auto gpu = Gpu::create(host);
    if (!gpu) return gpu.error();
    return Device(std::move(*gpu));
}

uint64_t Device::bytes() const
{
    return shared->memory().used();
}

Result<GpuTimer> GpuTimer::create(const Device& device, uint32_t maxScopes)
{
    auto timer = create(device.gpu(), maxScopes);
    if (timer) timer->keptAlive = device.gpu().shared_from_this();
    return timer;
}

Result<LightField> LightField::load(const Device& device, const std::filesystem::path& file, const Quality& quality)
{
    const auto data = loadField(file);
    if (!data) return data.error();
    return makeLightField(device.gpu(), *data, quality);
}

Result<IndirectLight> IndirectLight::create(const Device& device, const LightField& field, const Desc& desc)
{
    return makeIndirectLight(device.gpu(), field, desc);
}

Result<RayTracer> RayTracer::create(const Device& device, const LightField& field)
{
    return makeRayTracer(device.gpu(), field);
}

Status bakeLightField(const Device& device, const Scene& scene, std::span<const vec3> probes, const BakeDesc& desc,
                      const std::filesystem::path& file, const Progress& progress)
{
    const auto plan = planEffects(checkScene(scene), desc.effects);
    if (!plan) return plan.error();
    Scene capped = scene;
    capScene(capped, *plan);
    BakeSettings settings;
    settings.resolution = desc.resolution;
    settings.bounces = desc.bounces;
    settings.converged = desc.converged;
    settings.take(*plan);
    BakeReport report;
    const auto field = bakeLightField(device.gpu().host, capped, probes, settings, progress, report);
    if (!field) return field.error();
    return saveField(*field, file);
}

} // namespace sconce
