// sconce doctor: Vulkan devices, their limits, and what they lack.
#include <algorithm>
#include <iostream>

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

int runDoctor(const NoOptions&, const Context& context)
{
    const Result<std::vector<DeviceSummary>> devices = deviceSummary();
    if (!devices) return fail(devices.error());
    Json list = Json::array();
    for (const DeviceSummary& device : *devices)
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
                        {"usable", device.missing.empty()}});
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
