#include "runtime/vulkan/gpu.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "runtime/vulkan/nan_scan.h"
#include "runtime/vulkan/rays_a_lane.h"

namespace sconce
{

namespace
{

constexpr VkDeviceSize kStagingBytes = VkDeviceSize(16) << 20;

bool isDepth(VkFormat format)
{
    return format == VK_FORMAT_D16_UNORM || format == VK_FORMAT_D32_SFLOAT;
}

} // namespace

uint32_t texelBytes(VkFormat format)
{
    switch (format)
    {
    case VK_FORMAT_D16_UNORM:
        return 2;
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R8G8B8A8_UNORM:
        return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
        return 16;
    default:
        assert(!"a format that no frame is made of");
        return 0;
    }
}

VkImageAspectFlags GpuImage::aspect() const
{
    return isDepth(made.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

Error Gpu::failure(const char* call, VkResult result) const
{
    const bool memoryLost = result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY;
    return {memoryLost ? ErrorCode::outOfMemory : ErrorCode::deviceFailure,
            fmt::format("{} failed on {} with VkResult {}{}", call, properties.deviceName, int(result),
                        memoryLost ? "; free memory or lower the resolution"
                                   : "; check the driver, and run with SCONCE_VALIDATION=1 for the cause")};
}

Result<std::shared_ptr<Gpu>> Gpu::create(const HostVulkan& host)
{
    if (!host.instance || !host.physicalDevice || !host.device || !host.queue || !host.getInstanceProcAddr)
        return Error{ErrorCode::badArgument, "HostVulkan lacks an instance, a device, a queue or vkGetInstanceProcAddr; fill all of them"};
    std::shared_ptr<Gpu> gpu(new Gpu(host));
    const auto getDeviceProc = reinterpret_cast<PFN_vkGetDeviceProcAddr>(host.getInstanceProcAddr(host.instance, "vkGetDeviceProcAddr"));
    const char* absent = nullptr;
#define SCONCE_LOAD(name)                                                                                                                  \
    gpu->vk.name = reinterpret_cast<PFN_vk##name>(getDeviceProc(host.device, "vk" #name));                                                 \
    if (!gpu->vk.name) absent = "vk" #name;
    SCONCE_DEVICE_FUNCTIONS(SCONCE_LOAD)
#undef SCONCE_LOAD
    if (absent) return Error{ErrorCode::missingFeature, fmt::format("The host's device has no {}; create it for Vulkan 1.3", absent)};
    const auto instanceProc = [&](const char* name) { return host.getInstanceProcAddr(host.instance, name); };
    reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(instanceProc("vkGetPhysicalDeviceProperties"))(host.physicalDevice,
                                                                                                       &gpu->properties);
    uint32_t familyCount = 0;
    const auto families =
        reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(instanceProc("vkGetPhysicalDeviceQueueFamilyProperties"));
    families(host.physicalDevice, &familyCount, nullptr);
    std::vector<VkQueueFamilyProperties> family(familyCount);
    families(host.physicalDevice, &familyCount, family.data());
    if (host.queueFamily >= familyCount)
        return Error{ErrorCode::badArgument,
                     fmt::format("HostVulkan::queueFamily is {} but the device has {} families", host.queueFamily, familyCount)};
    constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    if ((family[host.queueFamily].queueFlags & kNeeded) != kNeeded)
        return Error{ErrorCode::badArgument,
                     fmt::format("HostVulkan::queueFamily {} of {} has no graphics or no compute; lend a queue of a family with both",
                                 host.queueFamily, gpu->properties.deviceName)};
    if (const auto missing = missingFeatures(host.getInstanceProcAddr, host.instance, host.physicalDevice); !missing.empty())
        return Error{ErrorCode::missingFeature,
                     fmt::format("{} lacks {}; lend another device", gpu->properties.deviceName, fmt::join(missing, ", "))};
    gpu->timestamps = family[host.queueFamily].timestampValidBits > 0;
    VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 more{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
    reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(instanceProc("vkGetPhysicalDeviceProperties2"))(host.physicalDevice, &more);
    const bool ballots =
        (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) && (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT);
    const auto rays = sconce::raysALane(gpu->properties.deviceType, ballots);
    if (!rays) return rays.error();
    gpu->raysALane = *rays;
    gpu->pool = std::make_unique<GpuMemory>(gpu->host, gpu->vk);
    if (auto status = gpu->makeCommands(); !status) return status.error();
    return gpu;
}

Result<std::shared_ptr<Gpu>> Gpu::forThread()
{
    std::shared_ptr<Gpu> gpu(new Gpu(host));
    gpu->first = home().shared_from_this();
    gpu->vk = vk;
    gpu->properties = properties;
    gpu->timestamps = timestamps;
    gpu->raysALane = raysALane;
    if (auto status = gpu->makeCommands(); !status) return status.error();
    return gpu;
}

/// What a thread has alone.
Status Gpu::makeCommands()
{
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.queueFamilyIndex = host.queueFamily;
    VkResult result = commandPool.make(*this, vk.CreateCommandPool, host.device, &poolInfo, host.allocationCallbacks);
    if (result != VK_SUCCESS) return failure("vkCreateCommandPool", result);
    VkCommandBufferAllocateInfo commandInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    commandInfo.commandPool = commandPool.get();
    commandInfo.commandBufferCount = 1;
    result = vk.AllocateCommandBuffers(host.device, &commandInfo, &commands);
    if (result != VK_SUCCESS) return failure("vkAllocateCommandBuffers", result);
    // Last: the scan makes a pipeline and buffers with all that stands above.
    if (const char* wanted = std::getenv("SCONCE_NAN_SCAN"); wanted && std::strcmp(wanted, "1") == 0)
    {
        auto made = NanScan::create(*this);
        if (!made) return made.error();
        scan = std::move(*made);
    }
    return success();
}

Gpu::Gpu(const HostVulkan& lent) : host(lent) {}

Gpu::~Gpu()
{
    staging = Buffer(); // before the pool of memory, which is declared before it
    scan.reset();
}

Result<Buffer> Gpu::makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags extraUsage, MemoryUse use, const char* what)
{
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    // Vulkan has no buffers of 0 bytes, and what is empty is bound all the same.
    info.size = std::max<VkDeviceSize>(bytes, 16);
    info.usage = extraUsage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    Buffer made;
    made.bytes = info.size;
    made.name = what;
    VkResult result = made.buffer.make(*this, vk.CreateBuffer, host.device, &info, host.allocationCallbacks);
    if (result != VK_SUCCESS) return failure("vkCreateBuffer", result);
    VkMemoryRequirements needs;
    vk.GetBufferMemoryRequirements(host.device, made.buffer.get(), &needs);
    auto piece = memory().allocate(needs, use, true, what);
    if (!piece) return piece.error();
    made.memory = OwnedPiece(memory(), *piece);
    result = vk.BindBufferMemory(host.device, made.buffer.get(), made.memory.piece().memory(), made.memory.piece().offset);
    if (result != VK_SUCCESS) return failure("vkBindBufferMemory", result);
    VkBufferDeviceAddressInfo addressInfo{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    addressInfo.buffer = made.buffer.get();
    made.deviceAddress = vk.GetBufferDeviceAddress(host.device, &addressInfo);
    if (scan) NanScan::note(made);
    return made;
}

Status Gpu::makeTexelView(Buffer& buffer, VkFormat format)
{
    const VkDeviceSize texels = buffer.size() / (format == VK_FORMAT_R32_UINT ? 4 : 16);
    if (texels > properties.limits.maxTexelBufferElements)
        return Error{ErrorCode::missingFeature, fmt::format("{} need a buffer of {} texels; the device allows {}; bake fewer probes",
                                                            buffer.what(), texels, properties.limits.maxTexelBufferElements)};
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    const VkResult result = buffer.view.make(*this, vk.CreateBufferView, host.device, &info, host.allocationCallbacks);
    return result == VK_SUCCESS ? success() : Status(failure("vkCreateBufferView", result));
}

Result<GpuImage> Gpu::makeImage(const ImageDesc& desc, const char* what)
{
    const bool volume = desc.volume || desc.depth > 1;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, desc.depth};
    info.mipLevels = desc.mips;
    info.arrayLayers = desc.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = desc.usage | (scan ? VK_IMAGE_USAGE_TRANSFER_SRC_BIT : 0);
    const VkPhysicalDeviceLimits& limits = properties.limits;
    // Asked here because the driver need not: beyond its limits vkCreateImage is undefined, not refused.
    const uint32_t side = volume ? limits.maxImageDimension3D : limits.maxImageDimension2D;
    if (std::max({desc.width, desc.height, desc.depth}) > side || desc.layers > limits.maxImageArrayLayers)
        return Error{
            ErrorCode::missingFeature,
            fmt::format("{} needs an image of {} x {} x {} texels and {} layers; the device allows {} and {}; lower the resolution", what,
                        desc.width, desc.height, desc.depth, desc.layers, side, limits.maxImageArrayLayers)};
    GpuImage made;
    made.made = desc;
    made.name = what;
    VkResult result = made.image.make(*this, vk.CreateImage, host.device, &info, host.allocationCallbacks);
    if (result != VK_SUCCESS) return failure("vkCreateImage", result);
    VkMemoryRequirements needs;
    vk.GetImageMemoryRequirements(host.device, made.image.get(), &needs);
    auto piece = memory().allocate(needs, MemoryUse::device, false, what);
    if (!piece) return piece.error();
    made.memory = OwnedPiece(memory(), *piece);
    result = vk.BindImageMemory(host.device, made.image.get(), made.memory.piece().memory(), made.memory.piece().offset);
    if (result != VK_SUCCESS) return failure("vkBindImageMemory", result);
    if (scan) NanScan::note(made);
    const VkImageUsageFlags viewable = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    // An image that is only copied may have no view.
    if (!(desc.usage & viewable)) return made;
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = made.image.get();
    view.viewType = volume ? VK_IMAGE_VIEW_TYPE_3D : desc.array || desc.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    view.format = desc.format;
    view.subresourceRange = {made.aspect(), 0, desc.mips, 0, desc.layers};
    result = made.wholeView.make(*this, vk.CreateImageView, host.device, &view, host.allocationCallbacks);
    if (result != VK_SUCCESS) return failure("vkCreateImageView", result);
    if (!desc.array) return made;
    for (uint32_t layer = 0; layer < desc.layers; ++layer)
    {
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.subresourceRange = {made.aspect(), 0, 1, layer, 1};
        result = made.layerViews.emplace_back().make(*this, vk.CreateImageView, host.device, &view, host.allocationCallbacks);
        if (result != VK_SUCCESS) return failure("vkCreateImageView", result);
    }
    return made;
}

Result<VkDescriptorSetLayout> Gpu::setLayout(std::span<const VkDescriptorSetLayoutBinding> bindings)
{
    if (first) return first->setLayout(bindings);
    std::vector<std::array<uint32_t, 4>> key;
    for (const VkDescriptorSetLayoutBinding& one : bindings)
        key.push_back({one.binding, uint32_t(one.descriptorType), one.descriptorCount, one.stageFlags});
    const std::scoped_lock lock(common);
    if (const auto found = setLayouts.find(key); found != setLayouts.end()) return found->second.get();
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = uint32_t(bindings.size());
    info.pBindings = bindings.data();
    SetLayout made;
    const VkResult result = made.make(*this, vk.CreateDescriptorSetLayout, host.device, &info, host.allocationCallbacks);
    if (result != VK_SUCCESS) return failure("vkCreateDescriptorSetLayout", result);
    return setLayouts.emplace(std::move(key), std::move(made)).first->second.get();
}

Result<std::shared_ptr<const void>> Gpu::computePipeline(const std::vector<uint64_t>& key,
                                                         const std::function<Result<std::shared_ptr<const void>>(Gpu&)>& make)
{
    if (first) return first->computePipeline(key, make);
    const std::scoped_lock lock(common);
    std::shared_ptr<const void>& known = computePipelines[key];
    if (known) return known;
    auto made = make(*this);
    if (made) known = *made;
    return made;
}

Status Gpu::submit(const std::function<void(VkCommandBuffer)>& record)
{
    // One command buffer serves all submits: each is waited for, so that it is idle whenever this is called.
    VkResult result = vk.ResetCommandPool(host.device, commandPool.get(), 0);
    if (result != VK_SUCCESS) return failure("vkResetCommandPool", result);
    if (!fence) // here, not with the device: one that only compiles has none (pass_statistics)
    {
        const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        result = fence.make(*this, vk.CreateFence, host.device, &info, host.allocationCallbacks);
        if (result != VK_SUCCESS) return failure("vkCreateFence", result);
    }
    // Before, not after: a submit that failed half-way leaves its fence signalled, and the next would not wait.
    const VkFence done = fence.get();
    result = vk.ResetFences(host.device, 1, &done);
    if (result != VK_SUCCESS) return failure("vkResetFences", result);
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = vk.BeginCommandBuffer(commands, &begin);
    if (result != VK_SUCCESS) return failure("vkBeginCommandBuffer", result);
    record(commands);
    result = vk.EndCommandBuffer(commands);
    if (result != VK_SUCCESS) return failure("vkEndCommandBuffer", result);
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    const auto begun = std::chrono::steady_clock::now();
    result = host.submit ? host.submit(info, done) : vk.QueueSubmit(host.queue, 1, &info, done);
    if (result != VK_SUCCESS) return failure("vkQueueSubmit", result);
    const auto wait = [&] { return vk.WaitForFences(host.device, 1, &done, VK_TRUE, UINT64_MAX); };
    result = wait();
    // Short of memory it hasn't waited, and the device still uses what the caller would give back now; a lost device doesn't.
    if (result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST) result = wait();
    if (result != VK_SUCCESS) return failure("vkWaitForFences", result);
    longestSeconds = std::max(longestSeconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
    // Read after the fence: only now have the scans run.
    return nanFindings();
}

Status Gpu::nanFindings()
{
    return scan ? scan->findings() : success();
}

Status Gpu::ensureStaging()
{
    if (staging) return success();
    auto made = makeBuffer(kStagingBytes, 0, MemoryUse::readback, "The staging buffer");
    if (!made) return made.error();
    staging = std::move(*made);
    return success();
}

Status Gpu::upload(const Buffer& target, VkDeviceSize offset, std::span<const std::byte> bytes)
{
    assert(offset + bytes.size() <= target.size());
    if (bytes.empty()) return success();
    if (target.mapped())
    {
        std::memcpy(target.mapped() + offset, bytes.data(), bytes.size());
        return success();
    }
    if (auto status = ensureStaging(); !status) return status;
    for (VkDeviceSize done = 0; done < bytes.size(); done += kStagingBytes)
    {
        const VkDeviceSize part = std::min<VkDeviceSize>(kStagingBytes, bytes.size() - done);
        std::memcpy(staging.mapped(), bytes.data() + done, part);
        auto status = submit(
            [&](VkCommandBuffer cmd)
            {
                const VkBufferCopy copy{0, offset + done, part};
                vk.CmdCopyBuffer(cmd, staging.handle(), target.handle(), 1, &copy);
                // Whoever uses the target next, in whatever stage, and in later submits to the queue, which a barrier reaches too: they
                // need none for uploads.
                memoryBarrier(*this, cmd, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
            });
        if (!status) return status;
    }
    return success();
}

Status Gpu::download(const Buffer& source, VkDeviceSize offset, std::span<std::byte> bytes)
{
    assert(offset + bytes.size() <= source.size());
    if (auto status = ensureStaging(); !status) return status;
    for (VkDeviceSize done = 0; done < bytes.size(); done += kStagingBytes)
    {
        const VkDeviceSize part = std::min<VkDeviceSize>(kStagingBytes, bytes.size() - done);
        auto status = submit(
            [&](VkCommandBuffer cmd)
            {
                // Read after write: what filled the source, in an earlier submit, is not known here.
                memoryBarrier(*this, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
                const VkBufferCopy copy{offset + done, 0, part};
                vk.CmdCopyBuffer(cmd, source.handle(), staging.handle(), 1, &copy);
                // For the host's reads, which the fence alone doesn't cover.
                memoryBarrier(*this, cmd, VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                              VK_ACCESS_2_HOST_READ_BIT);
            });
        if (!status) return status;
        std::memcpy(bytes.data() + done, staging.mapped(), part);
    }
    return success();
}

void memoryBarrier(const Gpu& gpu, VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkAccessFlags2 written, VkPipelineStageFlags2 to,
                   VkAccessFlags2 used)
{
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = from;
    barrier.srcAccessMask = written;
    barrier.dstStageMask = to;
    barrier.dstAccessMask = used;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    gpu.vk.CmdPipelineBarrier2(cmd, &info);
}

void transition(const Gpu& gpu, VkCommandBuffer cmd, const GpuImage& image, const ImageTransition& change)
{
    const GpuImage* const one[] = {&image};
    transition(gpu, cmd, one, change);
}

void transition(const Gpu& gpu, VkCommandBuffer cmd, std::span<const GpuImage* const> images, const ImageTransition& change)
{
    std::array<VkImageMemoryBarrier2, 8> barriers{};
    assert(images.size() <= barriers.size());
    for (size_t i = 0; i < images.size(); ++i)
    {
        VkImageMemoryBarrier2& barrier = barriers[i];
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
        barrier.srcStageMask = change.fromStage;
        barrier.srcAccessMask = change.written;
        barrier.dstStageMask = change.toStage;
        barrier.dstAccessMask = change.used;
        barrier.oldLayout = change.from;
        barrier.newLayout = change.to;
        barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = images[i]->handle();
        barrier.subresourceRange = {images[i]->aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    }
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = uint32_t(images.size());
    info.pImageMemoryBarriers = barriers.data();
    gpu.vk.CmdPipelineBarrier2(cmd, &info);
}

} // namespace sconce
