#include "vulkan_base.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <map>
#include <stdexcept>

namespace
{

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL printMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* count)
{
    ++*static_cast<size_t*>(count);
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
}

int preference(vk::PhysicalDeviceType type)
{
    if (type == vk::PhysicalDeviceType::eDiscreteGpu) return 3;
    if (type == vk::PhysicalDeviceType::eIntegratedGpu) return 2;
    return type == vk::PhysicalDeviceType::eVirtualGpu ? 1 : 0;
}

/// The first family with graphics and compute; -1: there is none.
int usableFamily(const vk::raii::PhysicalDevice& device)
{
    const auto families = device.getQueueFamilyProperties();
    constexpr auto needed = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    for (size_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & needed) == needed) return int(i);
    return -1;
}

} // namespace

Memory::Memory(DeviceMemory& from, const VkMemoryAllocateInfo& info) : allocator(&from)
{
    if (from.allocate(info, memory) != VK_SUCCESS)
        throw std::runtime_error("the device has no " + std::to_string(info.allocationSize) + " bytes left; ask for a smaller picture");
}

Vulkan::Vulkan(const Missing& missing, const Features& add, bool validation)
{
    makeInstance(validation);
    chooseDevice(missing);
    makeDevice(add);
}

void Vulkan::makeInstance(bool validation)
{
    if (validation)
    {
        const auto layers = context.enumerateInstanceLayerProperties();
        if (std::ranges::none_of(layers, [](const auto& l) { return std::strcmp(l.layerName, kValidationLayer) == 0; }))
            throw std::runtime_error(std::string("--validation needs the layer ") + kValidationLayer +
                                     "; install it or leave the option out");
    }
    const vk::ApplicationInfo application{.pApplicationName = "host", .apiVersion = VK_API_VERSION_1_3};
    constexpr vk::ValidationFeatureEnableEXT synchronization[] = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = 1, .pEnabledValidationFeatures = synchronization};
    constexpr const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    vk::InstanceCreateInfo info{.pApplicationInfo = &application};
    if (validation)
    {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = extensions;
    }
    instance = vk::raii::Instance(context, info);
    if (!validation) return;
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    messenger = vk::raii::DebugUtilsMessengerEXT(instance, {.messageSeverity = Severity::eWarning | Severity::eError,
                                                            .messageType = Type::eValidation | Type::ePerformance,
                                                            .pfnUserCallback = printMessage,
                                                            .pUserData = messages.get()});
}

void Vulkan::chooseDevice(const Missing& missing)
{
    std::string lacking;
    int best = -1;
    for (const vk::raii::PhysicalDevice& candidate : vk::raii::PhysicalDevices(instance))
    {
        const auto properties = candidate.getProperties();
        std::vector<std::string> lacks = missing(*instance, *candidate);
        if (usableFamily(candidate) < 0) lacks.push_back("a queue with graphics and compute");
        for (const std::string& what : lacks) lacking += std::string("; ") + properties.deviceName.data() + " lacks " + what;
        if (!lacks.empty() || preference(properties.deviceType) <= best) continue;
        best = preference(properties.deviceType);
        physicalDevice = candidate;
    }
    if (best < 0) throw std::runtime_error("there is no Vulkan device that will do; install a driver of Vulkan 1.3" + lacking);
    family = uint32_t(usableFamily(physicalDevice));
}

void Vulkan::makeDevice(const Features& add)
{
    vk::PhysicalDeviceVulkan13Features features13{.synchronization2 = true, .dynamicRendering = true};
    vk::PhysicalDeviceVulkan12Features features12{.pNext = &features13};
    add(features12, features13);
    constexpr float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queues{.queueFamilyIndex = family, .queueCount = 1, .pQueuePriorities = &priority};
    device = vk::raii::Device(physicalDevice, {.pNext = &features12, .queueCreateInfoCount = 1, .pQueueCreateInfos = &queues});
    queue = device.getQueue(family, 0);
    pool = vk::raii::CommandPool(device, {.flags = vk::CommandPoolCreateFlagBits::eTransient, .queueFamilyIndex = family});
    own = std::make_unique<DeviceMemory>(*device);
}

Memory Vulkan::allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted, bool addressed) const
{
    const auto kinds = physicalDevice.getMemoryProperties();
    for (uint32_t i = 0; i < kinds.memoryTypeCount; ++i)
    {
        if (!(needs.memoryTypeBits >> i & 1) || (kinds.memoryTypes[i].propertyFlags & wanted) != wanted) continue;
        const vk::MemoryAllocateFlagsInfo flags{.flags = vk::MemoryAllocateFlagBits::eDeviceAddress};
        const vk::MemoryAllocateInfo info{.pNext = addressed ? &flags : nullptr, .allocationSize = needs.size, .memoryTypeIndex = i};
        return Memory(*own, info);
    }
    throw std::runtime_error("the device has no memory of the kind " + vk::to_string(wanted) + "; try another device");
}

Image Vulkan::makeImage(vk::Format format, vk::Extent2D size, vk::ImageUsageFlags usage, uint32_t mips) const
{
    const uint32_t limit = physicalDevice.getProperties().limits.maxImageDimension2D;
    if (std::max(size.width, size.height) > limit)
        throw std::runtime_error("a picture of " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                                 " pixels is larger than the device's " + std::to_string(limit) + " a side; make it smaller");
    Image made;
    made.format = format;
    made.size = size;
    made.mips = mips;
    made.image = vk::raii::Image(device, {.imageType = vk::ImageType::e2D,
                                          .format = format,
                                          .extent = {size.width, size.height, 1},
                                          .mipLevels = mips,
                                          .arrayLayers = 1,
                                          .samples = vk::SampleCountFlagBits::e1,
                                          .usage = usage});
    made.memory = allocate(made.image.getMemoryRequirements(), vk::MemoryPropertyFlagBits::eDeviceLocal, false);
    made.image.bindMemory(made.memory.handle(), 0);
    made.view = vk::raii::ImageView(
        device,
        {.image = *made.image, .viewType = vk::ImageViewType::e2D, .format = format, .subresourceRange = {made.aspect(), 0, mips, 0, 1}});
    return made;
}

Buffer Vulkan::makeBuffer(size_t bytes, vk::BufferUsageFlags usage, bool shared) const
{
    Buffer made;
    made.bytes = bytes;
    made.buffer = vk::raii::Buffer(device, {.size = bytes, .usage = usage});
    using Kind = vk::MemoryPropertyFlagBits;
    const vk::MemoryPropertyFlags both = Kind::eHostVisible | Kind::eHostCoherent;
    const bool addressed = bool(usage & vk::BufferUsageFlagBits::eShaderDeviceAddress);
    made.memory = allocate(made.buffer.getMemoryRequirements(), shared ? both : Kind::eDeviceLocal, addressed);
    made.buffer.bindMemory(made.memory.handle(), 0);
    if (shared) made.mapped = static_cast<std::byte*>((*device).mapMemory(made.memory.handle(), 0, VK_WHOLE_SIZE));
    if (addressed) made.address = device.getBufferAddress({.buffer = *made.buffer});
    return made;
}

Buffer Vulkan::upload(std::span<const std::byte> bytes, vk::BufferUsageFlags usage) const
{
    Buffer made = makeBuffer(bytes.size(), usage | vk::BufferUsageFlagBits::eTransferDst, false);
    const Buffer staging = makeBuffer(bytes.size(), vk::BufferUsageFlagBits::eTransferSrc, true);
    std::memcpy(staging.mapped, bytes.data(), bytes.size());
    run([&](vk::CommandBuffer cmd) { cmd.copyBuffer(*staging.buffer, *made.buffer, vk::BufferCopy{.size = bytes.size()}); });
    return made;
}

void Vulkan::run(const std::function<void(vk::CommandBuffer)>& record) const
{
    const vk::raii::CommandBuffers buffers(device,
                                           {.commandPool = *pool, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1});
    const vk::raii::CommandBuffer& cmd = buffers.front();
    cmd.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(*cmd);
    cmd.end();
    const vk::raii::Fence done(device, vk::FenceCreateInfo{});
    queue.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &*cmd}, *done);
    constexpr uint64_t patience = 600'000'000'000; // ns: software devices are slow
    if (device.waitForFences(*done, true, patience) != vk::Result::eSuccess)
        throw std::runtime_error("the device has not answered for ten minutes; update its driver");
}

vk::raii::ShaderModule Vulkan::shader(std::span<const uint32_t> words) const
{
    return vk::raii::ShaderModule(device, {.codeSize = words.size_bytes(), .pCode = words.data()});
}

vk::raii::Pipeline Vulkan::computePipeline(std::span<const uint32_t> words, vk::PipelineLayout layout,
                                           const vk::SpecializationInfo* constants) const
{
    const vk::raii::ShaderModule code = shader(words);
    const vk::PipelineShaderStageCreateInfo stage{
        .stage = vk::ShaderStageFlagBits::eCompute, .module = *code, .pName = "main", .pSpecializationInfo = constants};
    return vk::raii::Pipeline(device, nullptr, vk::ComputePipelineCreateInfo{.stage = stage, .layout = layout});
}

void transition(vk::CommandBuffer cmd, const Image& image, const Use& from, const Use& to, Mips mips)
{
    const vk::ImageMemoryBarrier2 barrier{.srcStageMask = from.stages,
                                          .srcAccessMask = from.access,
                                          .dstStageMask = to.stages,
                                          .dstAccessMask = to.access,
                                          .oldLayout = from.layout,
                                          .newLayout = to.layout,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = *image.image,
                                          .subresourceRange = {image.aspect(), mips.first, mips.count, 0, 1}};
    cmd.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

DescriptorSets makeSets(const Vulkan& vulkan, std::span<const vk::DescriptorType> kinds, vk::ShaderStageFlags stages, uint32_t count)
{
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    std::map<vk::DescriptorType, uint32_t> needed;
    for (const vk::DescriptorType kind : kinds)
    {
        bindings.push_back({.binding = uint32_t(bindings.size()), .descriptorType = kind, .descriptorCount = 1, .stageFlags = stages});
        needed[kind] += count;
    }
    std::vector<vk::DescriptorPoolSize> sizes;
    for (const auto& [kind, number] : needed) sizes.push_back({kind, number});
    DescriptorSets made;
    made.layout = vk::raii::DescriptorSetLayout(vulkan.device, {.bindingCount = uint32_t(bindings.size()), .pBindings = bindings.data()});
    made.pool = vk::raii::DescriptorPool(vulkan.device, {.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                                         .maxSets = count,
                                                         .poolSizeCount = uint32_t(sizes.size()),
                                                         .pPoolSizes = sizes.data()});
    const std::vector<vk::DescriptorSetLayout> layouts(count, *made.layout);
    made.sets =
        vk::raii::DescriptorSets(vulkan.device, {.descriptorPool = *made.pool, .descriptorSetCount = count, .pSetLayouts = layouts.data()});
    return made;
}
