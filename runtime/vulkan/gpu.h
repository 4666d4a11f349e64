#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "runtime/vulkan/gpu_memory.h"
#include "runtime/vulkan/gpu_timer.h"
#include "runtime/vulkan/handle.h"

namespace sconce
{

class Gpu;
class NanScan;

/// A buffer with a device address; move-only. Destroy it after the GPU has finished with it and before its Gpu.
class Buffer
{
public:
    VkBuffer handle() const { return buffer.get(); }
    VkDeviceAddress address() const { return deviceAddress; }
    VkDeviceSize size() const { return bytes; }
    std::byte* mapped() const { return memory.mapped(); } // null for device memory
    const char* what() const { return name; }             // as it was made with
    VkBufferView texels() const { return view.get(); }    // null unless made by makeTexelBuffer
    explicit operator bool() const { return bool(buffer); }

private:
    friend class Gpu;
    OwnedPiece memory; // released after what is bound to it
    Handle<VkBuffer, &VulkanFunctions::DestroyBuffer> buffer;
    Handle<VkBufferView, &VulkanFunctions::DestroyBufferView> view;
    VkDeviceAddress deviceAddress = 0;
    VkDeviceSize bytes = 0;
    const char* name = "";
};

struct ImageDesc
{
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    uint32_t width = 1, height = 1, depth = 1; // texels; depth > 1, or volume: a 3D image
    uint32_t layers = 1;
    uint32_t mips = 1;
    bool volume = false; // 3D even when depth is 1
    bool array = false;  // the view is a 2D array even when there is one layer
    VkImageUsageFlags usage = 0;
};

/// Bytes of a texel in the formats that frames and bakes are made of; of another an assertion fails.
uint32_t texelBytes(VkFormat format);

/// An image with one view of all of it; move-only, as Buffer.
class GpuImage
{
public:
    VkImage handle() const { return image.get(); }
    VkImageView view() const { return wholeView.get(); }
    /// A view of one layer, for rendering into it; made with ImageDesc::array.
    VkImageView layerView(uint32_t layer) const { return layerViews[layer].get(); }
    const ImageDesc& desc() const { return made; }
    const char* what() const { return name; }
    /// Of its first level, without what the device adds.
    uint64_t bytes() const { return uint64_t(texelBytes(made.format)) * made.width * made.height * made.depth * made.layers; }
    VkImageAspectFlags aspect() const;
    explicit operator bool() const { return bool(image); }

private:
    friend class Gpu;
    using View = Handle<VkImageView, &VulkanFunctions::DestroyImageView>;
    OwnedPiece memory; // released after what is bound to it
    Handle<VkImage, &VulkanFunctions::DestroyImage> image;
    View wholeView;
    std::vector<View> layerViews;
    ImageDesc made;
    const char* name = "";
};

/// A host's device with its functions, the memory seam and one-shot submits. Everything made from it must go before it. For one thread at a
/// time; forThread() makes one for another.
class Gpu : public std::enable_shared_from_this<Gpu>
{
public:
    static Result<std::shared_ptr<Gpu>> create(const HostVulkan& host);
    /// With memory, layouts and compiled passes in common, which stay for as long as any of them. Errors: outOfMemory, deviceFailure.
    Result<std::shared_ptr<Gpu>> forThread();
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    const HostVulkan host;
    VulkanFunctions vk;
    VkPhysicalDeviceProperties properties{};
    bool timestamps = false; // the queue counts time
    uint32_t raysALane = 1;  // of passes over lists that are made from now on, see raysALane()

    GpuMemory& memory() { return *home().pool; }

    /// Null unless the environment says SCONCE_NAN_SCAN=1, see runtime/vulkan/nan_scan.h.
    NanScan* nanScan() { return scan.get(); }

    /// Storage, transfer and device address usage are always there. `what` names it in messages and must be a literal. Errors: outOfMemory,
    /// deviceFailure.
    Result<Buffer> makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags extraUsage, MemoryUse use, const char* what);
    Result<GpuImage> makeImage(const ImageDesc& desc, const char* what);

    /// Records into a command buffer of our own, submits it to the host's queue and waits. With SCONCE_NAN_SCAN=1: fails with what was
    /// found.
    Status submit(const std::function<void(VkCommandBuffer)>& record);
    /// Seconds from submission to end of the longest submit() since this was restarted, with what it waited for others.
    double longest() const { return longestSeconds; }
    void restartLongest() { longestSeconds = 0.0; }
    /// Copies through a staging buffer of at most 16 MiB, which stays for the next copy.
    Status upload(const Buffer& target, VkDeviceSize offset, std::span<const std::byte> bytes);
    Status download(const Buffer& source, VkDeviceSize offset, std::span<std::byte> bytes);
    template <class T> Result<Buffer> makeBufferWith(std::span<const T> values, VkBufferUsageFlags extraUsage, const char* what)
    {
        auto buffer = makeBuffer(std::max<size_t>(values.size_bytes(), 16), extraUsage, MemoryUse::device, what);
        if (!buffer) return buffer.error();
        if (auto status = upload(*buffer, 0, std::as_bytes(values)); !status) return status.error();
        return buffer;
    }
    /// @param format  R32_UINT, or one of 16 bytes; read-only to shaders. A missingFeature error where the device allows fewer.
    template <class T> Result<Buffer> makeTexelBuffer(std::span<const T> values, VkFormat format, const char* what)
    {
        auto buffer = makeBufferWith(values, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, what);
        if (!buffer) return buffer.error();
        if (auto status = makeTexelView(*buffer, format); !status) return status.error();
        return buffer;
    }
    /// The same, to be written by the device.
    Result<Buffer> makeTexelBuffer(VkDeviceSize bytes, VkFormat format, const char* what)
    {
        auto buffer = makeBuffer(std::max<VkDeviceSize>(bytes, 16), VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, MemoryUse::device, what);
        if (!buffer) return buffer.error();
        if (auto status = makeTexelView(*buffer, format); !status) return status.error();
        return buffer;
    }
    void releaseStaging() { staging = Buffer(); }
    /// The one layout of such bindings, which lives as long as this: a pipeline must not outlive the layouts that it was made with, and one
    /// that was made with a light field's is used with the next field's.
    Result<VkDescriptorSetLayout> setLayout(std::span<const VkDescriptorSetLayoutBinding> bindings);

    /// What Pipeline::compute() makes, once for all that is asked for alike, for a driver takes longest for that; it lives as long as this.
    /// @param make  of what is to live so long, where there is none yet; other threads that ask wait for it
    Result<std::shared_ptr<const void>> computePipeline(const std::vector<uint64_t>& key,
                                                        const std::function<Result<std::shared_ptr<const void>>(Gpu&)>& make);

    Error failure(const char* call, VkResult result) const;
    Status nanFindings(); // NanScan::findings(), where there is one

private:
    explicit Gpu(const HostVulkan& lent);
    Gpu& home() { return first ? *first : *this; } // that has what is in common
    Status makeCommands();
    Status ensureStaging();
    Status makeTexelView(Buffer& buffer, VkFormat format);
    // These go last: staging buffer and scan give their memory back to them.
    std::shared_ptr<Gpu> first; // of those that have all in common; null: this is the first
    std::unique_ptr<GpuMemory> pool;
    Handle<VkCommandPool, &VulkanFunctions::DestroyCommandPool> commandPool;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    Handle<VkFence, &VulkanFunctions::DestroyFence> fence;
    Buffer staging;
    double longestSeconds = 0.0;
    using SetLayout = Handle<VkDescriptorSetLayout, &VulkanFunctions::DestroyDescriptorSetLayout>;
    std::mutex common;                                                             // of the next two
    std::map<std::vector<std::array<uint32_t, 4>>, SetLayout> setLayouts;          // by binding, type, count and stages of each
    std::map<std::vector<uint64_t>, std::shared_ptr<const void>> computePipelines; // after the layouts that they must not outlive
    std::unique_ptr<NanScan> scan;
};

template <class T, auto Destroy> Handle<T, Destroy>::~Handle()
{
    if (value != T{}) (gpu->vk.*Destroy)(gpu->host.device, value, gpu->host.allocationCallbacks);
}

/// All memory writes of the first stages are visible to the second; enough wherever a pass follows a pass.
void memoryBarrier(const Gpu& gpu, VkCommandBuffer cmd, VkPipelineStageFlags2 from, VkAccessFlags2 written, VkPipelineStageFlags2 to,
                   VkAccessFlags2 used);

struct ImageTransition
{
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED, to = VK_IMAGE_LAYOUT_GENERAL;
    VkPipelineStageFlags2 fromStage = VK_PIPELINE_STAGE_2_NONE, toStage = VK_PIPELINE_STAGE_2_NONE;
    VkAccessFlags2 written = 0, used = 0;
};
void transition(const Gpu& gpu, VkCommandBuffer cmd, const GpuImage& image, const ImageTransition& change);
/// The same of several images, at most 8, by one barrier.
void transition(const Gpu& gpu, VkCommandBuffer cmd, std::span<const GpuImage* const> images, const ImageTransition& change);

} // namespace sconce
