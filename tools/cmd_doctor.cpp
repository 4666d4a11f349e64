// sconce doctor: Vulkan devices, their limits, what they lack, and which form of a pass they get where there are several.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>

#include "runtime/vulkan/gpu.h"
#include "runtime/vulkan/host_vulkan.h"
#include "tools/common.h"
#include "tools/version.h"

namespace sconce::tools
{

namespace
{

struct NoOptions
{
};

/// What passes have several forms of: which a device gets, and why.
struct BackEnd
{
    std::string of, taken, why;
};

std::vector<BackEnd> backEndsOf(const Gpu& gpu)
{
    const bool software = gpu.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const std::string why = std::getenv("SCONCE_RAYS_A_LANE") ? "SCONCE_RAYS_A_LANE says so"
                            : gpu.raysALane > 1               ? "in long lists a lane whose ray ends takes the next"
                            : software                        ? "a processor's lanes work together to the end of the longest ray"
                                                              : "compute passes have no subgroup ballots";
    return {
        {"words of maps", "texel buffers",
         fmt::format("of up to {} texels each; a light field with more is read by address", gpu.properties.limits.maxTexelBufferElements)},
        {"lists of rays", gpu.raysALane == 1 ? "a ray a lane" : fmt::format("{} rays a lane", gpu.raysALane), why}};
}

/// @param index  of deviceSummary(). Of a device that can't be had all the same, why.
std::vector<BackEnd> backEndsOf(size_t index)
{
    const auto own = OwnDevice::create({.device = std::to_string(index)});
    const auto gpu = own ? Gpu::create(own->host()) : own.error();
    if (!gpu) return {{"any pass", "none", gpu.error().message}};
    return backEndsOf(**gpu);
}

int runDoctor(const NoOptions&, const Context& context)
{
    const Result<std::vector<DeviceSummary>> devices = deviceSummary();
    if (!devices) return fail(devices.error());
    std::vector<std::vector<BackEnd>> backEnds(devices->size());
    for (size_t i = 0; i < devices->size(); ++i)
        if ((*devices)[i].missing.empty()) backEnds[i] = backEndsOf(i);
    Json list = Json::array();
    for (size_t i = 0; i < devices->size(); ++i)
    {
        const DeviceSummary& device = (*devices)[i];
        Json forms = Json::array();
        for (const BackEnd& one : backEnds[i]) forms.push_back({{"of", one.of}, {"taken", one.taken}, {"why", one.why}});
        list.push_back({{"name", device.name},
                        {"kind", device.kind},
                        {"driver", device.driver},
                        {"api", device.apiVersion},
                        {"heap_bytes", device.heapBytes},
                        {"max_image_size", device.maxImageSize2D},
                        {"max_image_layers", device.maxImageLayers},
                        {"max_storage_buffer", device.maxStorageBuffer},
                        {"subgroup_size", device.subgroupSize},
                        {"timestamps", device.timestamps},
                        {"missing", device.missing},
                        {"usable", device.missing.empty()},
                        {"back_ends", forms}});
    }
    if (context.json)
        print({{"version", versionText()}, {"devices", list}});
    else
    {
        std::cout << "sconce " << versionText() << "\n";
        for (size_t i = 0; i < devices->size(); ++i)
        {
            const DeviceSummary& device = (*devices)[i];
            std::cout << i << "  " << device.name << " (" << device.kind << ", Vulkan " << device.apiVersion << ", " << device.driver
                      << ")\n"
                      << "   memory heap " << (device.heapBytes >> 20) << " MiB, images to " << device.maxImageSize2D << " px and "
                      << device.maxImageLayers << " layers, storage buffers to " << (device.maxStorageBuffer >> 20) << " MiB, subgroups of "
                      << device.subgroupSize << (device.timestamps ? "" : ", no timestamps") << "\n";
            std::cout << (device.missing.empty() ? "   can run Sconce\n" : "   lacks:");
            for (const std::string& feature : device.missing) std::cout << " " << feature;
            std::cout << (device.missing.empty() ? "" : "\n");
            for (const BackEnd& one : backEnds[i]) std::cout << "   " << one.of << ": " << one.taken << " (" << one.why << ")\n";
        }
        std::cout << std::flush;
    }
    if (std::ranges::none_of(*devices, [](const DeviceSummary& device) { return device.missing.empty(); }))
        return fail(ErrorCode::missingFeature,
                    "No Vulkan device can run Sconce; update the driver, or install mesa-vulkan-drivers for a software device.");
    return exitOk;
}

} // namespace

void addDoctorCommand(CLI::App& app, Context& context)
{
    CLI::App* command =
        addCommand(app, context, "doctor", "Vulkan devices, their limits and missing features; exit 4 when none can be used");
    onChosen(command, context, std::make_shared<NoOptions>(), runDoctor);
}

} // namespace sconce::tools
