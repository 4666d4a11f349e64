#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/result.h"

namespace sconce
{

/// What a host lends: its own Vulkan objects, which must outlive everything made from them. The device needs Vulkan 1.3 with the features
/// that missingFeatures() checks, enabled; the queue family needs graphics and compute.
struct HostVulkan
{
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    VkQueue queue = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    const VkAllocationCallbacks* allocationCallbacks = nullptr;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE; // what compiled pipelines are looked up in and added to; without one a driver's own
    uint64_t memoryBudget = 0;                      // bytes of device memory the library may hold; 0: 80 % of the largest device-local heap

    // Where other threads use the queue, too: submits under the host's lock. Else vkQueueSubmit is called as it is.
    std::function<VkResult(const VkSubmitInfo&, VkFence)> submit;

    // A host with its own device memory allocator sets both; otherwise vkAllocateMemory and vkFreeMemory are called. By one
    // Device and those of its forThread() never two at a time. What is asked for goes on with its pNext, which holds
    // VkMemoryAllocateFlagsInfo; the memory is one of its own, from offset 0, which nobody but the library maps.
    std::function<VkResult(const VkMemoryAllocateInfo&, VkDeviceMemory&)> allocateMemory;
    std::function<void(VkDeviceMemory)> freeMemory;
};

/// Names of what a device lacks to run the library, empty when it can.
std::vector<std::string> missingFeatures(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance, VkPhysicalDevice device);

/// Switches the library's features on in what a host creates its device with; the rest stays as the host has set it.
void requireFeatures(VkPhysicalDeviceVulkan12Features& v12, VkPhysicalDeviceVulkan13Features& v13);

/// The device and instance of a program that has none of its own.
class OwnDevice
{
public:
    struct Desc
    {
        std::string device;      // index, or a part of the name; empty: the best (discrete, integrated, virtual, software)
        bool validation = false; // core and synchronization validation; also on when the environment has SCONCE_VALIDATION=1
        uint64_t memoryBudget = 0;
    };

    static Result<OwnDevice> create(const Desc& desc);
    static Result<OwnDevice> create();
    OwnDevice(OwnDevice&&) noexcept;
    OwnDevice& operator=(OwnDevice&&) noexcept;
    ~OwnDevice();

    const HostVulkan& host() const;
    std::string name() const;
    /// Every message of the validation layer so far; they are also printed to stderr, each after "validation: ". Empty when validation is
    /// off.
    std::vector<std::string> validationMessages() const;
    bool validating() const;

private:
    struct State;
    explicit OwnDevice(std::unique_ptr<State> made);
    std::unique_ptr<State> state;
};

/// One Vulkan device as `sconce doctor` shows it.
struct DeviceSummary
{
    std::string name;
    std::string kind;   // discrete, integrated, virtual, software, other
    std::string driver; // name and version
    std::string apiVersion;
    uint64_t heapBytes = 0;      // largest device-local heap
    uint32_t maxImageSize2D = 0; // texels
    uint32_t maxImageLayers = 0;
    uint64_t maxStorageBuffer = 0; // bytes
    uint32_t subgroupSize = 0;
    bool timestamps = false;
    std::vector<std::string> missing; // features without which Sconce can't run on it
};
Result<std::vector<DeviceSummary>> deviceSummary();

} // namespace sconce
