// A layer of Vulkan that makes the device below it a smaller one: it reports a profile's limits, features, memory and clocks. Below the
// validation layer, so that this judges every call by the profile. The environment's SCONCE_SMALL_DEVICE names the profile.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string_view>
#include <utility>

#include <vulkan/vk_layer.h>

namespace
{

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT,
                                kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

struct Profile
{
    std::string_view name;
    VkPhysicalDeviceType type;
    VkPhysicalDeviceLimits limits; // 0: the device's own
    bool coreFeatures;             // those of Vulkan 1.0 that may lack
    bool timestamps;
    VkSubgroupFeatureFlags subgroups;
    std::array<VkDeviceSize, 2> heaps; // MiB, the first device-local
    struct MemoryType
    {
        VkMemoryPropertyFlags flags;
        uint32_t heap;
    };
    std::array<MemoryType, 3> memory;
};

/// The Vulkan 1.3 specification, "Limit Requirements": what every device has at least.
constexpr VkPhysicalDeviceLimits leastLimits()
{
    VkPhysicalDeviceLimits least{};
    least.maxImageDimension1D = least.maxImageDimension2D = least.maxImageDimensionCube = 4096;
    least.maxImageDimension3D = least.maxImageArrayLayers = 256;
    least.maxTexelBufferElements = 65536;
    least.maxUniformBufferRange = 16384;
    least.maxStorageBufferRange = 1u << 27;
    least.maxPushConstantsSize = 128;
    least.maxMemoryAllocationCount = 4096;
    least.maxSamplerAllocationCount = 4000;
    least.bufferImageGranularity = 131072;
    least.maxBoundDescriptorSets = 4;
    least.maxPerStageDescriptorSamplers = least.maxPerStageDescriptorSampledImages = 16;
    least.maxPerStageDescriptorUniformBuffers = 12;
    least.maxPerStageDescriptorStorageBuffers = least.maxPerStageDescriptorStorageImages = 4;
    least.maxPerStageDescriptorInputAttachments = 4;
    least.maxPerStageResources = 128;
    least.maxDescriptorSetSamplers = least.maxDescriptorSetSampledImages = 96;
    least.maxDescriptorSetUniformBuffers = 72;
    least.maxDescriptorSetStorageBuffers = least.maxDescriptorSetStorageImages = 24;
    least.maxVertexInputAttributes = least.maxVertexInputBindings = 16;
    least.maxVertexInputAttributeOffset = 2047;
    least.maxVertexInputBindingStride = 2048;
    least.maxVertexOutputComponents = least.maxFragmentInputComponents = 64;
    least.maxFragmentOutputAttachments = least.maxFragmentCombinedOutputResources = 4;
    least.maxComputeSharedMemorySize = 16384;
    std::ranges::fill(least.maxComputeWorkGroupCount, 65535u);
    least.maxComputeWorkGroupInvocations = 128;
    least.maxComputeWorkGroupSize[0] = least.maxComputeWorkGroupSize[1] = 128;
    least.maxComputeWorkGroupSize[2] = 64;
    least.maxDrawIndexedIndexValue = (1u << 24) - 1;
    least.maxDrawIndirectCount = 1;
    least.maxSamplerLodBias = 2.0f;
    least.maxSamplerAnisotropy = 1.0f;
    least.maxViewports = 1;
    least.maxViewportDimensions[0] = least.maxViewportDimensions[1] = 4096;
    least.minTexelBufferOffsetAlignment = least.minUniformBufferOffsetAlignment = least.minStorageBufferOffsetAlignment = 256;
    least.maxFramebufferWidth = least.maxFramebufferHeight = 4096;
    least.maxFramebufferLayers = 256;
    least.maxColorAttachments = 4;
    least.nonCoherentAtomSize = 256;
    return least;
}

/// The same, "Roadmap 2022": what it says of phones and all larger devices from that year on; what it doesn't say is as of every device.
constexpr VkPhysicalDeviceLimits mobileLimits()
{
    VkPhysicalDeviceLimits limits = leastLimits();
    limits.maxImageDimension1D = limits.maxImageDimension2D = limits.maxImageDimensionCube = 8192;
    limits.maxImageArrayLayers = 2048;
    limits.maxUniformBufferRange = 65536;
    limits.bufferImageGranularity = 4096;
    limits.maxPerStageDescriptorSamplers = 64;
    limits.maxPerStageDescriptorUniformBuffers = 15;
    limits.maxPerStageDescriptorStorageBuffers = 30;
    limits.maxPerStageDescriptorSampledImages = limits.maxPerStageResources = 200;
    limits.maxPerStageDescriptorStorageImages = limits.maxFragmentCombinedOutputResources = 16;
    limits.maxDescriptorSetSamplers = 576;
    limits.maxDescriptorSetUniformBuffers = 90;
    limits.maxDescriptorSetStorageBuffers = 96;
    limits.maxDescriptorSetSampledImages = 1800;
    limits.maxDescriptorSetStorageImages = 144;
    limits.maxComputeWorkGroupInvocations = limits.maxComputeWorkGroupSize[0] = limits.maxComputeWorkGroupSize[1] = 256;
    limits.maxColorAttachments = limits.maxFragmentOutputAttachments = 7;
    limits.maxSamplerLodBias = 14.0f;
    return limits;
}

/// A small card of 2017, as RADV reports Polaris 12, with 2 GiB of its own.
constexpr VkPhysicalDeviceLimits desktopLimits()
{
    VkPhysicalDeviceLimits limits{};
    limits.maxImageDimension3D = 2048;
    limits.maxImageDimensionCube = 16384;
    limits.nonCoherentAtomSize = 64;
    return limits;
}

constexpr Profile kProfiles[] = {
    {"least",
     VK_PHYSICAL_DEVICE_TYPE_OTHER,
     leastLimits(),
     false,
     false,
     VK_SUBGROUP_FEATURE_BASIC_BIT,
     {1024, 1024},
     {{{kLocal, 0}, {kVisible | kCoherent, 1}}}},
    {"mobile",
     VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
     mobileLimits(),
     false,
     false,
     ~0u,
     {1024, 0},
     {{{kLocal | kVisible | kCached, 0}, {kLocal | kVisible | kCoherent, 0}}}},
    {"desktop",
     VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU,
     desktopLimits(),
     true,
     true,
     ~0u,
     {2048, 4096},
     {{{kLocal, 0}, {kVisible | kCoherent, 1}, {kVisible | kCoherent | kCached, 1}}}},
};

const Profile& profile()
{
    static const Profile* const chosen = []
    {
        const char* name = std::getenv("SCONCE_SMALL_DEVICE");
        const Profile* found = std::ranges::find(kProfiles, std::string_view(name ? name : ""), &Profile::name);
        if (found != std::end(kProfiles)) return found;
        std::fprintf(stderr, "SCONCE_SMALL_DEVICE is '%s'; it may be least, mobile or desktop\n", name ? name : "");
        std::abort();
    }();
    return *chosen;
}

using Limits = VkPhysicalDeviceLimits;
constexpr uint32_t Limits::*kLargest[] = {&Limits::maxImageDimension1D,
                                          &Limits::maxImageDimension2D,
                                          &Limits::maxImageDimensionCube,
                                          &Limits::maxImageDimension3D,
                                          &Limits::maxImageArrayLayers,
                                          &Limits::maxTexelBufferElements,
                                          &Limits::maxUniformBufferRange,
                                          &Limits::maxStorageBufferRange,
                                          &Limits::maxPushConstantsSize,
                                          &Limits::maxMemoryAllocationCount,
                                          &Limits::maxSamplerAllocationCount,
                                          &Limits::maxBoundDescriptorSets,
                                          &Limits::maxPerStageDescriptorSamplers,
                                          &Limits::maxPerStageDescriptorUniformBuffers,
                                          &Limits::maxPerStageDescriptorStorageBuffers,
                                          &Limits::maxPerStageDescriptorSampledImages,
                                          &Limits::maxPerStageDescriptorStorageImages,
                                          &Limits::maxPerStageDescriptorInputAttachments,
                                          &Limits::maxPerStageResources,
                                          &Limits::maxDescriptorSetSamplers,
                                          &Limits::maxDescriptorSetUniformBuffers,
                                          &Limits::maxDescriptorSetStorageBuffers,
                                          &Limits::maxDescriptorSetSampledImages,
                                          &Limits::maxDescriptorSetStorageImages,
                                          &Limits::maxVertexInputAttributes,
                                          &Limits::maxVertexInputBindings,
                                          &Limits::maxVertexInputAttributeOffset,
                                          &Limits::maxVertexInputBindingStride,
                                          &Limits::maxVertexOutputComponents,
                                          &Limits::maxFragmentInputComponents,
                                          &Limits::maxFragmentOutputAttachments,
                                          &Limits::maxFragmentCombinedOutputResources,
                                          &Limits::maxComputeSharedMemorySize,
                                          &Limits::maxComputeWorkGroupInvocations,
                                          &Limits::maxDrawIndexedIndexValue,
                                          &Limits::maxDrawIndirectCount,
                                          &Limits::maxViewports,
                                          &Limits::maxFramebufferWidth,
                                          &Limits::maxFramebufferHeight,
                                          &Limits::maxFramebufferLayers,
                                          &Limits::maxColorAttachments};
constexpr VkDeviceSize Limits::*kSmallest[] = {&Limits::bufferImageGranularity, &Limits::minTexelBufferOffsetAlignment,
                                               &Limits::minUniformBufferOffsetAlignment, &Limits::minStorageBufferOffsetAlignment,
                                               &Limits::nonCoherentAtomSize};

void narrow(Limits& own)
{
    const Limits& asked = profile().limits;
    const auto atMost = [](auto& value, auto limit)
    {
        if (limit > 0) value = std::min(value, limit);
    };
    for (const auto limit : kLargest) atMost(own.*limit, asked.*limit);
    for (const auto limit : {&Limits::maxComputeWorkGroupCount, &Limits::maxComputeWorkGroupSize})
        for (size_t i = 0; i < 3; ++i) atMost((own.*limit)[i], (asked.*limit)[i]);
    for (size_t i = 0; i < 2; ++i) atMost(own.maxViewportDimensions[i], asked.maxViewportDimensions[i]);
    atMost(own.maxSamplerLodBias, asked.maxSamplerLodBias);
    atMost(own.maxSamplerAnisotropy, asked.maxSamplerAnisotropy);
    for (const auto limit : kSmallest) own.*limit = std::max(own.*limit, asked.*limit);
    if (!profile().timestamps) own.timestampComputeAndGraphics = VK_FALSE;
}

/// What every device can do with a format beyond what it samples and draws into: storage images, and linear filters of 32-bit floats that
/// some lack. Depth is filtered linearly all the same: a device may lack it, and none is known to. The Vulkan 1.3 specification, "Required
/// Format Support".
VkFormatFeatureFlags without(VkFormat format)
{
    if (profile().coreFeatures) return 0;
    constexpr VkFormat kStored[] = {
        VK_FORMAT_R8G8B8A8_UNORM,    VK_FORMAT_R8G8B8A8_SNORM,    VK_FORMAT_R8G8B8A8_UINT,       VK_FORMAT_R8G8B8A8_SINT,
        VK_FORMAT_R16G16B16A16_UINT, VK_FORMAT_R16G16B16A16_SINT, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32_UINT,
        VK_FORMAT_R32_SINT,          VK_FORMAT_R32_SFLOAT,        VK_FORMAT_R32G32_UINT,         VK_FORMAT_R32G32_SINT,
        VK_FORMAT_R32G32_SFLOAT,     VK_FORMAT_R32G32B32A32_UINT, VK_FORMAT_R32G32B32A32_SINT,   VK_FORMAT_R32G32B32A32_SFLOAT};
    VkFormatFeatureFlags lacks = 0;
    if (std::ranges::find(kStored, format) == std::end(kStored)) lacks |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
    if (format >= VK_FORMAT_R32_SFLOAT && format <= VK_FORMAT_R32G32B32A32_SFLOAT)
        lacks |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
    if (format >= VK_FORMAT_BC1_RGB_UNORM_BLOCK && format <= VK_FORMAT_BC7_SRGB_BLOCK) lacks = ~0u;
    return lacks;
}

void narrow(VkPhysicalDeviceFeatures& features)
{
    if (profile().coreFeatures) return;
    VkPhysicalDeviceFeatures few{};
    few.robustBufferAccess = features.robustBufferAccess;
    features = few;
}

/// The functions of the next layer, of an instance or a device. Found when that is made: later the loader names its first layer's.
struct Next
{
    VkInstance instance = VK_NULL_HANDLE;
    std::function<PFN_vkVoidFunction(const char*)> find;
    std::map<std::string_view, PFN_vkVoidFunction> replaced; // those that this layer has its own of
};
std::mutex mutex;
std::map<void*, Next> known; // by what the loader keeps first in a handle

template <class H> void* keyOf(H handle)
{
    return *reinterpret_cast<void**>(handle);
}
template <class H> const Next& nextOf(H handle)
{
    const std::scoped_lock lock(mutex);
    return known.at(keyOf(handle)); // stays where it is
}
template <class F, class H> F below(H handle, std::string_view name)
{
    return reinterpret_cast<F>(nextOf(handle).replaced.at(name));
}

struct Named
{
    std::string_view name;
    PFN_vkVoidFunction function;
};
std::span<const Named> ofInstances();
std::span<const Named> ofDevices();

template <class H> void keep(H made, VkInstance instance, std::span<const Named> own, std::function<PFN_vkVoidFunction(const char*)> find)
{
    Next next{instance, std::move(find), {}};
    for (const Named& function : own) next.replaced[function.name] = next.find(function.name.data());
    const std::scoped_lock lock(mutex);
    known[keyOf(made)] = std::move(next);
}
template <class H> void forget(H handle, void (*destroy)(H, const VkAllocationCallbacks*), const VkAllocationCallbacks* callbacks)
{
    void* const key = keyOf(handle);
    destroy(handle, callbacks);
    const std::scoped_lock lock(mutex);
    known.erase(key);
}

/// Of the chain that the loader adds to what something is made with: how the next layer's functions are found.
template <class Info> Info* linkOf(const void* chain, VkStructureType type)
{
    for (auto* at = static_cast<const VkBaseInStructure*>(chain); at; at = at->pNext)
        if (auto* info = reinterpret_cast<const Info*>(at); at->sType == type && info->function == VK_LAYER_LINK_INFO)
            return const_cast<Info*>(info);
    return nullptr;
}

VkResult createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkInstance* made)
{
    auto* link = linkOf<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = reinterpret_cast<PFN_vkCreateInstance>(next(nullptr, "vkCreateInstance"))(info, callbacks, made);
    if (result == VK_SUCCESS) keep(*made, *made, ofInstances(), [next, own = *made](const char* name) { return next(own, name); });
    return result;
}

void destroyInstance(VkInstance instance, const VkAllocationCallbacks* callbacks)
{
    if (instance) forget(instance, below<PFN_vkDestroyInstance>(instance, "vkDestroyInstance"), callbacks);
}

void getProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties)
{
    below<PFN_vkGetPhysicalDeviceProperties>(device, "vkGetPhysicalDeviceProperties")(device, properties);
    properties->deviceType = profile().type;
    narrow(properties->limits);
}

void getProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* properties)
{
    below<PFN_vkGetPhysicalDeviceProperties2>(device, "vkGetPhysicalDeviceProperties2")(device, properties);
    properties->properties.deviceType = profile().type;
    narrow(properties->properties.limits);
    for (auto* at = static_cast<VkBaseOutStructure*>(properties->pNext); at; at = at->pNext)
    {
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceSubgroupProperties*>(at)->supportedOperations &= profile().subgroups;
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES)
            reinterpret_cast<VkPhysicalDeviceVulkan11Properties*>(at)->subgroupSupportedOperations &= profile().subgroups;
    }
}

void getFeatures(VkPhysicalDevice device, VkPhysicalDeviceFeatures* features)
{
    below<PFN_vkGetPhysicalDeviceFeatures>(device, "vkGetPhysicalDeviceFeatures")(device, features);
    narrow(*features);
}

void getFeatures2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features)
{
    below<PFN_vkGetPhysicalDeviceFeatures2>(device, "vkGetPhysicalDeviceFeatures2")(device, features);
    narrow(features->features);
}

void narrow(VkFormat format, VkFormatProperties& properties)
{
    properties.linearTilingFeatures &= ~without(format);
    properties.optimalTilingFeatures &= ~without(format);
}

void getFormat(VkPhysicalDevice device, VkFormat format, VkFormatProperties* properties)
{
    below<PFN_vkGetPhysicalDeviceFormatProperties>(device, "vkGetPhysicalDeviceFormatProperties")(device, format, properties);
    narrow(format, *properties);
}

void getFormat2(VkPhysicalDevice device, VkFormat format, VkFormatProperties2* properties)
{
    below<PFN_vkGetPhysicalDeviceFormatProperties2>(device, "vkGetPhysicalDeviceFormatProperties2")(device, format, properties);
    narrow(format, properties->formatProperties);
    for (auto* at = static_cast<VkBaseOutStructure*>(properties->pNext); at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_FORMAT_PROPERTIES_3)
        {
            auto& wide = *reinterpret_cast<VkFormatProperties3*>(at); // its bits are the same ones and more
            wide.linearTilingFeatures &= ~VkFormatFeatureFlags2(without(format));
            wide.optimalTilingFeatures &= ~VkFormatFeatureFlags2(without(format));
        }
}

void getQueueFamilies(VkPhysicalDevice device, uint32_t* count, VkQueueFamilyProperties* families)
{
    below<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(device, "vkGetPhysicalDeviceQueueFamilyProperties")(device, count, families);
    if (!families || profile().timestamps) return;
    for (VkQueueFamilyProperties& family : std::span(families, *count)) family.timestampValidBits = 0;
}

void getQueueFamilies2(VkPhysicalDevice device, uint32_t* count, VkQueueFamilyProperties2* families)
{
    below<PFN_vkGetPhysicalDeviceQueueFamilyProperties2>(device, "vkGetPhysicalDeviceQueueFamilyProperties2")(device, count, families);
    if (!families || profile().timestamps) return;
    for (VkQueueFamilyProperties2& family : std::span(families, *count)) family.queueFamilyProperties.timestampValidBits = 0;
}

/// All of the profile's kinds are the device's one.
void describe(VkPhysicalDeviceMemoryProperties& memory)
{
    memory = {};
    for (const VkDeviceSize size : profile().heaps)
        if (size > 0) memory.memoryHeaps[memory.memoryHeapCount++].size = size << 20;
    memory.memoryHeaps[0].flags = VK_MEMORY_HEAP_DEVICE_LOCAL_BIT;
    for (const Profile::MemoryType& type : profile().memory)
        if (type.flags != 0) memory.memoryTypes[memory.memoryTypeCount++] = {type.flags, type.heap};
}

void getMemory(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* memory)
{
    describe(*memory);
}

void getMemory2(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties2* memory)
{
    below<PFN_vkGetPhysicalDeviceMemoryProperties2>(device, "vkGetPhysicalDeviceMemoryProperties2")(device, memory);
    describe(memory->memoryProperties);
}

uint32_t allTypes()
{
    VkPhysicalDeviceMemoryProperties memory;
    describe(memory);
    return (1u << memory.memoryTypeCount) - 1;
}

VkResult allocate(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory)
{
    VkMemoryAllocateInfo own = *info;
    own.memoryTypeIndex = 0;
    return below<PFN_vkAllocateMemory>(device, "vkAllocateMemory")(device, &own, callbacks, memory);
}

void getBufferNeeds(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needs)
{
    below<PFN_vkGetBufferMemoryRequirements>(device, "vkGetBufferMemoryRequirements")(device, buffer, needs);
    needs->memoryTypeBits = allTypes();
}

void getBufferNeeds2(VkDevice device, const VkBufferMemoryRequirementsInfo2* info, VkMemoryRequirements2* needs)
{
    below<PFN_vkGetBufferMemoryRequirements2>(device, "vkGetBufferMemoryRequirements2")(device, info, needs);
    needs->memoryRequirements.memoryTypeBits = allTypes();
}

void getImageNeeds(VkDevice device, VkImage image, VkMemoryRequirements* needs)
{
    below<PFN_vkGetImageMemoryRequirements>(device, "vkGetImageMemoryRequirements")(device, image, needs);
    needs->memoryTypeBits = allTypes();
}

void getImageNeeds2(VkDevice device, const VkImageMemoryRequirementsInfo2* info, VkMemoryRequirements2* needs)
{
    below<PFN_vkGetImageMemoryRequirements2>(device, "vkGetImageMemoryRequirements2")(device, info, needs);
    needs->memoryRequirements.memoryTypeBits = allTypes();
}

VkResult createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkDevice* made)
{
    auto* link = linkOf<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link) return VK_ERROR_INITIALIZATION_FAILED;
    VkPhysicalDeviceMemoryProperties own;
    below<PFN_vkGetPhysicalDeviceMemoryProperties>(physical, "vkGetPhysicalDeviceMemoryProperties")(physical, &own);
    if (own.memoryTypeCount != 1)
    {
        std::fprintf(stderr, "The layer of small devices takes devices of one kind of memory, such as software Vulkan; this has %u\n",
                     own.memoryTypeCount);
        return VK_ERROR_INITIALIZATION_FAILED;
    }
    // A driver refuses what it hasn't; what the profile hasn't is refused here.
    VkPhysicalDeviceFeatures has{}, asks = info->pEnabledFeatures ? *info->pEnabledFeatures : VkPhysicalDeviceFeatures{};
    getFeatures(physical, &has);
    for (auto* at = static_cast<const VkBaseInStructure*>(info->pNext); at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2)
            asks = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(at)->features;
    const auto bits = [](const VkPhysicalDeviceFeatures& of)
    { return std::span(reinterpret_cast<const VkBool32*>(&of), sizeof(of) / sizeof(VkBool32)); };
    if (!std::ranges::equal(bits(asks), bits(has), [](VkBool32 asked, VkBool32 there) { return !asked || there; }))
        return VK_ERROR_FEATURE_NOT_PRESENT;
    const PFN_vkGetInstanceProcAddr ofInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr ofDevice = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkInstance instance = nextOf(physical).instance;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(ofInstance(instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, callbacks, made);
    if (result == VK_SUCCESS) keep(*made, instance, ofDevices(), [ofDevice, own = *made](const char* name) { return ofDevice(own, name); });
    return result;
}

void destroyDevice(VkDevice device, const VkAllocationCallbacks* callbacks)
{
    if (device) forget(device, below<PFN_vkDestroyDevice>(device, "vkDestroyDevice"), callbacks);
}

PFN_vkVoidFunction deviceFunction(VkDevice device, const char* name);
PFN_vkVoidFunction instanceFunction(VkInstance instance, const char* name);

template <class F> PFN_vkVoidFunction erased(F function)
{
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

std::span<const Named> ofDevices()
{
    static const Named functions[] = {{"vkGetDeviceProcAddr", erased(deviceFunction)},
                                      {"vkDestroyDevice", erased(destroyDevice)},
                                      {"vkAllocateMemory", erased(allocate)},
                                      {"vkGetBufferMemoryRequirements", erased(getBufferNeeds)},
                                      {"vkGetBufferMemoryRequirements2", erased(getBufferNeeds2)},
                                      {"vkGetImageMemoryRequirements", erased(getImageNeeds)},
                                      {"vkGetImageMemoryRequirements2", erased(getImageNeeds2)}};
    return functions;
}

std::span<const Named> ofInstances()
{
    static const Named functions[] = {{"vkGetInstanceProcAddr", erased(instanceFunction)},
                                      {"vkCreateInstance", erased(createInstance)},
                                      {"vkDestroyInstance", erased(destroyInstance)},
                                      {"vkCreateDevice", erased(createDevice)},
                                      {"vkGetPhysicalDeviceProperties", erased(getProperties)},
                                      {"vkGetPhysicalDeviceProperties2", erased(getProperties2)},
                                      {"vkGetPhysicalDeviceFeatures", erased(getFeatures)},
                                      {"vkGetPhysicalDeviceFeatures2", erased(getFeatures2)},
                                      {"vkGetPhysicalDeviceFormatProperties", erased(getFormat)},
                                      {"vkGetPhysicalDeviceFormatProperties2", erased(getFormat2)},
                                      {"vkGetPhysicalDeviceQueueFamilyProperties", erased(getQueueFamilies)},
                                      {"vkGetPhysicalDeviceQueueFamilyProperties2", erased(getQueueFamilies2)},
                                      {"vkGetPhysicalDeviceMemoryProperties", erased(getMemory)},
                                      {"vkGetPhysicalDeviceMemoryProperties2", erased(getMemory2)}};
    return functions;
}

PFN_vkVoidFunction find(std::span<const Named> functions, std::string_view name)
{
    if (name.ends_with("KHR")) name.remove_suffix(3); // those that have become part of Vulkan, by their old names
    const auto found = std::ranges::find(functions, name, &Named::name);
    return found == functions.end() ? nullptr : found->function;
}

PFN_vkVoidFunction deviceFunction(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction own = find(ofDevices(), name);
    return own ? own : nextOf(device).find(name);
}

PFN_vkVoidFunction instanceFunction(VkInstance instance, const char* name)
{
    if (const PFN_vkVoidFunction own = find(ofInstances(), name)) return own;
    if (const PFN_vkVoidFunction own = find(ofDevices(), name)) return own;
    return instance ? nextOf(instance).find(name) : nullptr;
}

} // namespace

extern "C" VK_LAYER_EXPORT VkResult vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* asked)
{
    profile(); // a name that is none ends the program here
    asked->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
    asked->pfnGetInstanceProcAddr = instanceFunction;
    asked->pfnGetDeviceProcAddr = deviceFunction;
    asked->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
