#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "allocator.h"

/// Memory that goes back to its allocator.
class Memory
{
public:
    Memory() = default;
    Memory(DeviceMemory& from, const VkMemoryAllocateInfo& info);
    Memory(Memory&& other) noexcept
        : allocator(std::exchange(other.allocator, nullptr)), memory(std::exchange(other.memory, VK_NULL_HANDLE))
    {
    }
    Memory& operator=(Memory&& other) noexcept
    {
        std::swap(allocator, other.allocator);
        std::swap(memory, other.memory);
        return *this;
    }
    ~Memory()
    {
        if (allocator) allocator->free(memory);
    }
    vk::DeviceMemory handle() const { return memory; }

private:
    DeviceMemory* allocator = nullptr;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

// Memory is declared first: it goes last.
struct Image
{
    Memory memory;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr; // of all mips
    vk::Format format = vk::Format::eUndefined;
    vk::Extent2D size;
    uint32_t mips = 1;

    vk::ImageAspectFlags aspect() const
    {
        return format == vk::Format::eD32Sfloat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
    }
};

struct Buffer
{
    Memory memory;
    vk::raii::Buffer buffer = nullptr;
    size_t bytes = 0;
    std::byte* mapped = nullptr;   // null unless made for both sides
    vk::DeviceAddress address = 0; // 0 unless made with eShaderDeviceAddress
};

/// From one use of an image to the next.
struct Use
{
    vk::ImageLayout layout;
    vk::PipelineStageFlags2 stages;
    vk::AccessFlags2 access;
};

/// Instance, device, queue and memory of a program without a window. Failures throw std::exception with a sentence.
class Vulkan
{
public:
    using Missing = std::function<std::vector<std::string>(VkInstance, VkPhysicalDevice)>;
    using Features = std::function<void(VkPhysicalDeviceVulkan12Features&, VkPhysicalDeviceVulkan13Features&)>;
    /// @param missing     names what a device lacks of what the program's libraries need: then it is passed over
    /// @param add         switches on what they need beside what this host does
    /// @param validation  core and synchronization validation, where the layer is installed; messages go to stderr and are counted
    Vulkan(const Missing& missing, const Features& add, bool validation);

    Image makeImage(vk::Format format, vk::Extent2D size, vk::ImageUsageFlags usage, uint32_t mips = 1) const;
    /// @param shared  the processor sees it, at Buffer::mapped
    Buffer makeBuffer(size_t bytes, vk::BufferUsageFlags usage, bool shared) const;
    Buffer upload(std::span<const std::byte> bytes, vk::BufferUsageFlags usage) const;
    /// Records, submits and waits.
    void run(const std::function<void(vk::CommandBuffer)>& record) const;
    vk::raii::ShaderModule shader(std::span<const uint32_t> words) const;
    vk::raii::Pipeline computePipeline(std::span<const uint32_t> words, vk::PipelineLayout layout,
                                       const vk::SpecializationInfo* constants = nullptr) const;
    size_t validationMessages() const { return *messages; }

private:
    void makeInstance(bool validation);
    void chooseDevice(const Missing& missing);
    void makeDevice(const Features& add);
    Memory allocate(const vk::MemoryRequirements& needs, vk::MemoryPropertyFlags wanted, bool addressed) const;

    std::unique_ptr<size_t> messages = std::make_unique<size_t>(0); // outlives the instance, whose messenger counts here
    vk::raii::Context context;

public:
    vk::raii::Instance instance = nullptr;

private:
    vk::raii::DebugUtilsMessengerEXT messenger = nullptr;

public:
    vk::raii::PhysicalDevice physicalDevice = nullptr;
    uint32_t family = 0;
    vk::raii::Device device = nullptr;
    vk::raii::Queue queue = nullptr;

private:
    vk::raii::CommandPool pool = nullptr;
    std::unique_ptr<DeviceMemory> own;
};

struct Mips
{
    uint32_t first = 0, count = VK_REMAINING_MIP_LEVELS;
};
/// Waits for the use before, and makes what it wrote visible to the next.
void transition(vk::CommandBuffer cmd, const Image& image, const Use& from, const Use& to, Mips mips = {});

struct DescriptorSets
{
    vk::raii::DescriptorSetLayout layout = nullptr;
    vk::raii::DescriptorPool pool = nullptr;
    std::vector<vk::raii::DescriptorSet> sets;
};
/// `count` sets of one layout, whose binding i is of kinds[i].
DescriptorSets makeSets(const Vulkan& vulkan, std::span<const vk::DescriptorType> kinds, vk::ShaderStageFlags stages, uint32_t count);
