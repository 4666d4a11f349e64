#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "runtime/vulkan/host_vulkan.h"

namespace sconce
{

/// What the validation layer said, from whichever thread.
struct MessageLog
{
    std::mutex mutex;
    std::vector<std::string> messages;
};

/// An instance with a device: what stands behind OwnDevice, and what a program of ours with a window makes, which needs extensions for its
/// surface. Defined with OwnDevice in host_vulkan.cpp. Whatever is made from it must go before it.
struct MadeDevice
{
    HostVulkan host;
    MessageLog log; // outlives the instance, whose messenger writes to it
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    bool validation = false;

    MadeDevice() = default;
    MadeDevice(const MadeDevice&) = delete;
    MadeDevice& operator=(const MadeDevice&) = delete;
    ~MadeDevice();
    std::string name() const; // of the physical device
};

/// @param instanceExtensions, deviceExtensions  names, that the instance and the device get beside what the library needs
/// @param features  the chain of what those extensions' features are, enabled
/// Errors: as OwnDevice::create(); missingFeature where an extension is none of the loader's, or of the device's: named.
Result<std::unique_ptr<MadeDevice>> makeDevice(const OwnDevice::Desc& desc, std::span<const char* const> instanceExtensions = {},
                                               std::span<const char* const> deviceExtensions = {}, void* features = nullptr);

} // namespace sconce
