#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <mutex>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "runtime/vulkan/host_vulkan.h"
#include "runtime/vulkan/vulkan_functions.h"

namespace sconce
{

/// Where a resource lives: on the device only, or mapped for the host to write or to read.
enum class MemoryUse
{
    device,
    upload,
    readback
};

/// The one seam through which all device memory is taken: blocks of 64 MiB cut first-fit, large resources alone. It keeps the budget
/// itself, since software drivers hand out more than they have and a refusal must come before the machine swaps. Safe from many threads:
/// what a thread loads another may let go of.
class GpuMemory
{
public:
    struct Block;
    struct Piece // empty when block is null
    {
        Block* block = nullptr;
        VkDeviceSize offset = 0;
        VkDeviceSize size = 0;
        VkDeviceMemory memory() const;
        std::byte* mapped() const; // null for device memory
    };

    GpuMemory(const HostVulkan& host, const VulkanFunctions& vk);
    ~GpuMemory();
    GpuMemory(const GpuMemory&) = delete;
    GpuMemory& operator=(const GpuMemory&) = delete;

    /// Errors: outOfMemory, which names what was asked for, what is held and the budget.
    Result<Piece> allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear, const char* what);
    void release(Piece& piece);

    uint64_t used() const { return heldBytes; } // bytes taken from the driver; a host's allocator may ask
    uint64_t peak() const { return peakBytes; } // held at a time, since the last restartPeak()
    /// @return  bytes held now
    uint64_t restartPeak() { return peakBytes = heldBytes.load(); }
    uint64_t budget() const { return budgetBytes; }

private:
    Result<Block*> addBlock(VkDeviceSize size, uint32_t type, bool linear, bool mapped, VkDeviceSize asked, const char* what);
    void giveBack(Piece& piece);
    int memoryType(uint32_t allowed, MemoryUse use) const;

    const HostVulkan& host;
    const VulkanFunctions& vk;
    VkPhysicalDeviceMemoryProperties types{};
    std::mutex mutex; // of who changes what follows
    std::list<Block> blocks;
    std::atomic<uint64_t> heldBytes = 0;
    std::atomic<uint64_t> peakBytes = 0;
    uint64_t budgetBytes = 0;
};

/// A piece that is given back; move-only. It must go before its GpuMemory.
class OwnedPiece
{
public:
    OwnedPiece() = default;
    OwnedPiece(GpuMemory& from, const GpuMemory::Piece& taken) : pool(&from), held(taken) {}
    OwnedPiece(OwnedPiece&& other) noexcept : pool(std::exchange(other.pool, nullptr)), held(std::exchange(other.held, {})) {}
    OwnedPiece& operator=(OwnedPiece&& other) noexcept
    {
        OwnedPiece taken(std::move(other));
        std::swap(pool, taken.pool);
        std::swap(held, taken.held);
        return *this;
    }
    ~OwnedPiece()
    {
        if (pool) pool->release(held);
    }
    const GpuMemory::Piece& piece() const { return held; }
    std::byte* mapped() const { return pool ? held.mapped() : nullptr; }

private:
    GpuMemory* pool = nullptr;
    GpuMemory::Piece held;
};

} // namespace sconce
