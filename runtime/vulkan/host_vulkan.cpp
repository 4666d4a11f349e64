#include "runtime/vulkan/host_vulkan.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "base/listed.h"
#include "runtime/vulkan/made_device.h"

namespace sconce
{

namespace
{

constexpr uint32_t kApiVersion = VK_API_VERSION_1_3;

template <class F> F load(VkInstance instance, const char* name)
{
    return reinterpret_cast<F>(vkGetInstanceProcAddr(instance, name));
}

VKAPI_ATTR VkBool32 VKAPI_CALL keepMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                           const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    // Called on whichever thread makes the call at fault, so the log is locked.
    auto& log = *static_cast<MessageLog*>(user);
    std::scoped_lock lock(log.mutex);
    log.messages.emplace_back(data->pMessage);
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

struct NamedFeature
{
    VkBool32* value;
    const char* name;
};
/// What the library needs.
std::vector<NamedFeature> neededOf(VkPhysicalDeviceVulkan12Features& v12, VkPhysicalDeviceVulkan13Features& v13)
{
    return {{&v12.bufferDeviceAddress, "bufferDeviceAddress"},
            {&v12.scalarBlockLayout, "scalarBlockLayout"},
            {&v13.dynamicRendering, "dynamicRendering"},
            {&v13.synchronization2, "synchronization2"}};
}

/// Features in one chain, that is asked for or enabled.
struct FeatureChain
{
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12};

    FeatureChain() = default;
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;
};

const char* kindName(VkPhysicalDeviceType type)
{
    switch (type)
    {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "software";
    default:
        return "other";
    }
}

int preference(VkPhysicalDeviceType type)
{
    switch (type)
    {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 0;
    }
}

std::string versionText(uint32_t version)
{
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version));
}

Error vulkanError(const char* call, VkResult result, const char* remedy)
{
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return {memory ? ErrorCode::outOfMemory : ErrorCode::deviceFailure,
            fmt::format("{} failed with VkResult {}; {}", call, int(result), memory ? "free memory" : remedy)};
}

Result<std::vector<VkPhysicalDevice>> devicesOf(VkInstance instance)
{
    auto enumerate = load<PFN_vkEnumeratePhysicalDevices>(instance, "vkEnumeratePhysicalDevices");
    uint32_t count = 0;
    VkResult result = enumerate(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(result == VK_SUCCESS ? count : 0);
    if (result == VK_SUCCESS) result = enumerate(instance, &count, devices.data());
    if (result < 0) return vulkanError("vkEnumeratePhysicalDevices", result, "check the driver with vulkaninfo");
    devices.resize(count); // fewer where one has gone meanwhile
    return devices;
}

VkPhysicalDeviceProperties propertiesOf(VkInstance instance, VkPhysicalDevice device)
{
    VkPhysicalDeviceProperties properties;
    load<PFN_vkGetPhysicalDeviceProperties>(instance, "vkGetPhysicalDeviceProperties")(device, &properties);
    return properties;
}

/// The first queue family with graphics and compute, or -1.
int usableFamily(PFN_vkGetInstanceProcAddr getProc, VkInstance instance, VkPhysicalDevice device, bool& timestamps)
{
    auto query =
        reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(getProc(instance, "vkGetPhysicalDeviceQueueFamilyProperties"));
    uint32_t count = 0;
    query(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    query(device, &count, families.data());
    for (uint32_t i = 0; i < count; ++i)
    {
        const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
        if ((families[i].queueFlags & both) != both) continue;
        timestamps = families[i].timestampValidBits > 0;
        return int(i);
    }
    return -1;
}

Result<VkInstance> makeInstance(bool validation, MessageLog* log, std::span<const char* const> wanted = {})
{
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "sconce";
    application.apiVersion = kApiVersion;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    std::vector<const char*> extensions(wanted.begin(), wanted.end());
    const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    messenger.pfnUserCallback = keepMessage;
    messenger.pUserData = log;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    if (validation)
    {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &layer;
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = load<PFN_vkCreateInstance>(nullptr, "vkCreateInstance")(&info, nullptr, &instance);
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        return Error{ErrorCode::missingFeature,
                     "The layer VK_LAYER_KHRONOS_validation is not installed; install the Vulkan validation layers or "
                     "run without validation"};
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        return Error{ErrorCode::missingFeature,
                     fmt::format("No Vulkan driver has all of {}; install one that can draw into windows", fmt::join(extensions, ", "))};
    if (result != VK_SUCCESS) return vulkanError("vkCreateInstance", result, "check that a Vulkan driver is installed");
    return instance;
}

Result<VkPhysicalDevice> chooseDevice(VkInstance instance, const std::string& wanted)
{
    const auto found = devicesOf(instance);
    if (!found) return found.error();
    const std::vector<VkPhysicalDevice>& devices = *found;
    if (devices.empty())
        return Error{ErrorCode::missingFeature, "No Vulkan device was found; install a Vulkan driver (Mesa has a software one)"};
    size_t index = 0;
    const auto [end, fault] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    const bool isIndex = !wanted.empty() && fault == std::errc() && end == wanted.data() + wanted.size();
    VkPhysicalDevice best = VK_NULL_HANDLE;
    int bestPreference = -1;
    std::string names;
    for (size_t i = 0; i < devices.size(); ++i)
    {
        const VkPhysicalDeviceProperties properties = propertiesOf(instance, devices[i]);
        names += fmt::format("{}{} {}", i ? ", " : "", i, properties.deviceName);
        if (isIndex ? i != index : !wanted.empty() && !std::strstr(properties.deviceName, wanted.c_str())) continue;
        if (preference(properties.deviceType) <= bestPreference) continue;
        best = devices[i];
        bestPreference = preference(properties.deviceType);
    }
    if (!best) return Error{ErrorCode::badArgument, fmt::format("No Vulkan device matches '{}'; there are: {}", wanted, names)};
    return best;
}

} // namespace

void requireFeatures(VkPhysicalDeviceVulkan12Features& v12, VkPhysicalDeviceVulkan13Features& v13)
{
    for (const NamedFeature& feature : neededOf(v12, v13)) *feature.value = VK_TRUE;
}

std::vector<std::string> missingFeatures(PFN_vkGetInstanceProcAddr getProc, VkInstance instance, VkPhysicalDevice device)
{
    std::vector<std::string> missing;
    VkPhysicalDeviceProperties properties;
    reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(getProc(instance, "vkGetPhysicalDeviceProperties"))(device, &properties);
    bool timestamps = false;
    if (usableFamily(getProc, instance, device, timestamps) < 0) missing.push_back("a queue family with graphics and compute");
    if (properties.apiVersion < kApiVersion)
    {
        missing.push_back(fmt::format("Vulkan 1.3 (it has {})", versionText(properties.apiVersion)));
        return missing; // the 1.3 feature struct is unknown to it
    }
    FeatureChain features;
    reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(getProc(instance, "vkGetPhysicalDeviceFeatures2"))(device, &features.all);
    for (const NamedFeature& feature : neededOf(features.v12, features.v13))
        if (!*feature.value) missing.push_back(feature.name);
    return missing;
}

MadeDevice::~MadeDevice()
{
    // The messenger goes after the device, to hear what its destruction finds still alive.
    if (host.device) load<PFN_vkDestroyDevice>(host.instance, "vkDestroyDevice")(host.device, nullptr);
    if (messenger)
        load<PFN_vkDestroyDebugUtilsMessengerEXT>(host.instance, "vkDestroyDebugUtilsMessengerEXT")(host.instance, messenger, nullptr);
    if (host.instance) load<PFN_vkDestroyInstance>(host.instance, "vkDestroyInstance")(host.instance, nullptr);
}

std::string MadeDevice::name() const
{
    return propertiesOf(host.instance, host.physicalDevice).deviceName;
}

struct OwnDevice::State
{
    std::unique_ptr<MadeDevice> made;
};

OwnDevice::OwnDevice(std::unique_ptr<State> made) : state(std::move(made)) {}
OwnDevice::OwnDevice(OwnDevice&&) noexcept = default;
OwnDevice& OwnDevice::operator=(OwnDevice&&) noexcept = default;
OwnDevice::~OwnDevice() = default;
const HostVulkan& OwnDevice::host() const
{
    return state->made->host;
}
bool OwnDevice::validating() const
{
    return state->made->validation;
}
std::string OwnDevice::name() const
{
    return state->made->name();
}

std::vector<std::string> OwnDevice::validationMessages() const
{
    std::scoped_lock lock(state->made->log.mutex);
    return state->made->log.messages;
}

Result<OwnDevice> OwnDevice::create()
{
    return create(Desc{});
}

namespace
{

/// The messenger in makeInstance() covers the making and the destruction of the instance alone; this one, all between.
Status listen(MadeDevice& made)
{
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = keepMessage;
    info.pUserData = &made.log;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    const VkResult result = load<PFN_vkCreateDebugUtilsMessengerEXT>(made.host.instance, "vkCreateDebugUtilsMessengerEXT")(
        made.host.instance, &info, nullptr, &messenger);
    if (result != VK_SUCCESS) return vulkanError("vkCreateDebugUtilsMessengerEXT", result, "run without validation");
    made.messenger = messenger;
    return success();
}

} // namespace

Result<OwnDevice> OwnDevice::create(const Desc& desc)
{
    auto made = makeDevice(desc);
    if (!made) return made.error();
    auto state = std::make_unique<State>();
    state->made = std::move(*made);
    return OwnDevice(std::move(state));
}

Result<std::unique_ptr<MadeDevice>> makeDevice(const OwnDevice::Desc& desc, std::span<const char* const> instanceExtensions,
                                               std::span<const char* const> deviceExtensions, void* extensionFeatures)
{
    auto made = std::make_unique<MadeDevice>();
    const char* wish = std::getenv("SCONCE_VALIDATION");
    made->validation = desc.validation || (wish && std::strcmp(wish, "1") == 0);
    auto instance = makeInstance(made->validation, &made->log, instanceExtensions);
    if (!instance) return instance.error();
    HostVulkan& host = made->host;
    host.instance = *instance;
    host.getInstanceProcAddr = vkGetInstanceProcAddr;
    host.memoryBudget = desc.memoryBudget;
    if (made->validation)
        if (auto status = listen(*made); !status) return status.error();
    auto chosen = chooseDevice(host.instance, desc.device);
    if (!chosen) return chosen.error();
    host.physicalDevice = *chosen;
    // Before the device is made: vkCreateDevice refuses without saying which feature is absent.
    const std::vector<std::string> missing = missingFeatures(vkGetInstanceProcAddr, host.instance, *chosen);
    if (!missing.empty())
        return Error{ErrorCode::missingFeature, fmt::format("The device {} lacks {}; update its driver or choose another device",
                                                            propertiesOf(host.instance, *chosen).deviceName, listed(missing))};
    bool timestamps = false;
    host.queueFamily = uint32_t(usableFamily(vkGetInstanceProcAddr, host.instance, *chosen, timestamps));
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = host.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    FeatureChain features;
    requireFeatures(features.v12, features.v13);
    features.v13.pNext = extensionFeatures;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.all};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = uint32_t(deviceExtensions.size());
    info.ppEnabledExtensionNames = deviceExtensions.data();
    VkDevice device = VK_NULL_HANDLE;
    const VkResult result = load<PFN_vkCreateDevice>(host.instance, "vkCreateDevice")(host.physicalDevice, &info, nullptr, &device);
    if (result == VK_ERROR_EXTENSION_NOT_PRESENT)
        return Error{ErrorCode::missingFeature,
                     fmt::format("The device {} has not all of {}; update its driver or choose another device",
                                 propertiesOf(host.instance, *chosen).deviceName, fmt::join(deviceExtensions, ", "))};
    if (result != VK_SUCCESS) return vulkanError("vkCreateDevice", result, "check the driver with vulkaninfo");
    host.device = device;
    load<PFN_vkGetDeviceQueue>(host.instance, "vkGetDeviceQueue")(host.device, host.queueFamily, 0, &host.queue);
    return made;
}

Result<std::vector<DeviceSummary>> deviceSummary()
{
    auto instance = makeInstance(false, nullptr);
    if (!instance) return instance.error();
    MadeDevice owner; // of the instance alone
    owner.host.instance = *instance;
    const auto devices = devicesOf(*instance);
    if (!devices) return devices.error();
    std::vector<DeviceSummary> all;
    for (VkPhysicalDevice device : *devices)
    {
        VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
        VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, &subgroup};
        VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver};
        load<PFN_vkGetPhysicalDeviceProperties2>(*instance, "vkGetPhysicalDeviceProperties2")(device, &properties);
        VkPhysicalDeviceMemoryProperties memory;
        load<PFN_vkGetPhysicalDeviceMemoryProperties>(*instance, "vkGetPhysicalDeviceMemoryProperties")(device, &memory);
        DeviceSummary summary;
        summary.name = properties.properties.deviceName;
        summary.kind = kindName(properties.properties.deviceType);
        summary.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
        summary.apiVersion = versionText(properties.properties.apiVersion);
        for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount))
            if (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) summary.heapBytes = std::max<uint64_t>(summary.heapBytes, heap.size);
        summary.maxImageSize2D = properties.properties.limits.maxImageDimension2D;
        summary.maxImageLayers = properties.properties.limits.maxImageArrayLayers;
        summary.maxStorageBuffer = properties.properties.limits.maxStorageBufferRange;
        summary.subgroupSize = subgroup.subgroupSize;
        usableFamily(vkGetInstanceProcAddr, *instance, device, summary.timestamps);
        summary.missing = missingFeatures(vkGetInstanceProcAddr, *instance, device);
        all.push_back(std::move(summary));
    }
    return all;
}

} // namespace sconce
