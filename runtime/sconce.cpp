#include "runtime/sconce.h"

#include <fmt/format.h>

#include "base/safe_file.h"
#include "runtime/bake/bake.h"
#include "runtime/bake/group_bake.h"
#include "runtime/field/light_field.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/light_groups.h"
#include "runtime/field/live_light.h"
#include "runtime/frame/indirect_light.h"
#include "runtime/frame/input_check.h"

namespace sconce
{

Version libraryVersion()
{
    return {};
}

Result<Device> Device::create(const HostVulkan& host, Version header)
{
    const auto text = [](const Version& v) { return fmt::format("{}.{}.{}", v.major, v.minor, v.patch); };
    if (header.major != libraryVersion().major || header.minor != libraryVersion().minor)
        return Error{ErrorCode::badArgument,
                     fmt::format("sconce.h is of version {} and the linked library of {}; compile and link against the same", text(header),
                                 text(libraryVersion()))};
    auto gpu = Gpu::create(host);
    if (!gpu) return gpu.error();
    return Device(std::move(*gpu));
}

Result<Device> Device::forThread() const
{
    auto gpu = shared->forThread();
    if (!gpu) return gpu.error();
    return Device(std::move(*gpu));
}

Status Device::nanFindings() const
{
    return shared->nanFindings();
}

uint64_t Device::bytes() const
{
    return shared->memory().used();
}

Result<GpuTimer> GpuTimer::create(const Device& device, uint32_t maxScopes)
{
    return create(device.gpu(), maxScopes);
}

Result<LightField> LightField::load(const Device& device, const std::filesystem::path& file, const Quality& quality, uint32_t resident)
{
    if (resident > 0)
    {
        auto streamed = openField(file);
        if (!streamed) return streamed.error();
        return makeStreamedField(device.gpu(), streamed->field, std::move(streamed->maps), resident, quality);
    }
    const auto data = loadField(file);
    if (!data) return data.error();
    return makeLightField(device.gpu(), *data, quality);
}

namespace
{

/// What tells that a file isn't that of a field, as a sentence without its full stop; empty where nothing does.
std::string otherField(const LightField& field, const FieldData& data, const std::filesystem::path& file)
{
    const gpu::LightFieldInfo &here = field.info(), &there = data.info;
    if (here.probeCount == there.probeCount && here.faceSize == there.faceSize && here.surfaceSize == there.surfaceSize &&
        here.refinedTexels == there.refinedTexels && here.hidden == there.hidden && field.state().groupCount == data.groups.size())
        return field.state().lightHash == lightHashOf(data)
                   ? ""
                   : fmt::format("'{}' is of another bake of as many probes than this light field; give the file that it was loaded from",
                                 file.string());
    return fmt::format("'{}' has {} probes of {} texels in {} light groups and is not the file of this light field, which has {} of {} in "
                       "{}; give that which it was loaded from",
                       file.string(), there.probeCount, there.faceSize, data.groups.size(), here.probeCount, here.faceSize,
                       field.state().groupCount);
}

} // namespace

Result<LightGroups> LightGroups::load(const Device& device, const LightField& field, const std::filesystem::path& file)
{
    const auto make = [&](const FieldData& data) -> Result<LightGroups>
    {
        if (std::string fault = otherField(field, data, file); !fault.empty()) return Error{ErrorCode::badArgument, std::move(fault)};
        return makeLightGroups(device.gpu(), field, data);
    };
    if (field.state().maps) // the stream reads their shares
    {
        const auto opened = openField(file);
        return opened ? make(opened->field) : Result<LightGroups>(opened.error());
    }
    const auto data = loadField(file);
    return data ? make(*data) : Result<LightGroups>(data.error());
}

Result<LiveLight> LiveLight::load(const Device& device, const LightField& field, const std::filesystem::path& file)
{
    const auto data = loadField(file);
    if (!data) return data.error();
    if (std::string fault = otherField(field, *data, file); !fault.empty()) return Error{ErrorCode::badArgument, std::move(fault)};
    return makeLiveLight(device.gpu(), field, *data);
}

Result<IndirectLight> IndirectLight::create(const Device& device, const LightField& field, const Desc& desc)
{
    return makeIndirectLight(device.gpu(), field, desc);
}

Result<std::vector<std::string>> validateInputs(const Device& device, const LightField& field, const FrameInputs& inputs,
                                                const gpu::FrameView& view)
{
    return checkInputs(device.gpu(), field, inputs, view);
}

Result<RayTracer> RayTracer::create(const Device& device, const LightField& field)
{
    return makeRayTracer(device.gpu(), field);
}

Status bakeLightField(const Device& device, const Scene& scene, std::span<const vec3> probes, const BakeDesc& desc,
                      const std::filesystem::path& file, const Progress& progress)
{
    // Whether the file can be written is known before hours of work, not after them.
    if (Status fine = writable(file); !fine) return fine;
    if (const std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, fault};
    const auto plan = planEffects(checkScene(scene), desc.effects);
    if (!plan) return plan.error();
    Scene capped = scene;
    capScene(capped, *plan);
    BakeSettings settings;
    settings.resolution = desc.resolution;
    settings.bounces = desc.bounces;
    settings.converged = desc.converged;
    settings.surfaceTexels = desc.surfaceTexels;
    settings.surfaceRays = desc.surfaceRays;
    settings.surfaceRefined = desc.surfaceRefined;
    settings.lampTexels = desc.lampTexels;
    settings.submissionMs = desc.submissionMs;
    settings.rays = desc.rays;
    settings.faces = desc.faces;
    settings.liveLinks = desc.liveLinks;
    settings.lit = desc.lit;
    settings.compact = desc.compact;
    settings.take(*plan);
    BakeReport report;
    const auto field = desc.groups.empty() && desc.liveLinks == 0 && desc.lit
                           ? bakeLightField(device.gpu(), capped, probes, settings, progress, report)
                           : bakeLightGroups(device.gpu(), capped, probes, settings, desc.groups, progress, report);
    if (!field) return field.error();
    return saveField(*field, file);
}

} // namespace sconce
