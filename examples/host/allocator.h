#pragma once

#include <atomic>
#include <cstdint>
#include <map>

#include <vulkan/vulkan.h>

/// This host's allocator of device memory: it counts what is out and what was out at most. One for the host's own images and buffers, one
/// that is lent, so that each can be asked what it holds. Used from one thread.
class DeviceMemory
{
public:
    explicit DeviceMemory(VkDevice device) : owner(device) {}
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    VkResult allocate(const VkMemoryAllocateInfo& info, VkDeviceMemory& memory);
    void free(VkDeviceMemory memory); // null is nothing, as in Vulkan
    uint64_t bytes() const { return now; }
    uint64_t mostBytes() const { return most; }
    size_t blocks() const { return sizes.size(); }

private:
    VkDevice owner;
    std::map<VkDeviceMemory, uint64_t> sizes; // of what is out
    uint64_t now = 0, most = 0;
};

/// What a driver takes of main memory for the objects that are made with these callbacks, counted. Any thread may call them.
class HostMemory
{
public:
    HostMemory();
    HostMemory(const HostMemory&) = delete; // the callbacks point here
    HostMemory& operator=(const HostMemory&) = delete;

    const VkAllocationCallbacks* callbacks() const { return &functions; }
    int64_t blocks() const { return out; }
    int64_t calls() const { return made; }

private:
    static void* VKAPI_PTR allocate(void* self, size_t size, size_t alignment, VkSystemAllocationScope);
    static void* VKAPI_PTR reallocate(void* self, void* original, size_t size, size_t alignment, VkSystemAllocationScope);
    static void VKAPI_PTR free(void* self, void* memory);

    VkAllocationCallbacks functions{};
    std::atomic<int64_t> out = 0, made = 0;
};

/// What is lent to a library.
struct Allocators
{
    explicit Allocators(VkDevice owner) : device(owner) {}
    DeviceMemory device;
    HostMemory main;
};
