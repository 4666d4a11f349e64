#include "runtime/vulkan/gpu_memory.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include <fmt/format.h>

namespace sconce
{

namespace
{

constexpr VkDeviceSize kBlockBytes = VkDeviceSize(64) << 20;
constexpr VkDeviceSize kLargeBytes = kBlockBytes / 4; // from here on a resource gets a block of its own

std::string mebibytes(uint64_t bytes)
{
    return fmt::format("{} MiB", (bytes + (1u << 20) - 1) >> 20);
}

} // namespace

struct GpuMemory::Block
{
    struct Range
    {
        VkDeviceSize offset, size;
    };

    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    uint32_t type = 0;
    bool linear = false; // buffers and images don't share a block, so bufferImageGranularity never matters
    std::byte* mapped = nullptr;
    std::vector<Range> free; // by offset, never adjacent

    std::optional<VkDeviceSize> take(VkDeviceSize wanted, VkDeviceSize alignment)
    {
        for (size_t i = 0; i < free.size(); ++i)
        {
            const Range range = free[i];
            const VkDeviceSize start = (range.offset + alignment - 1) / alignment * alignment;
            const VkDeviceSize end = range.offset + range.size;
            if (start + wanted > end) continue;
            free.erase(free.begin() + std::ptrdiff_t(i));
            if (start + wanted < end) free.insert(free.begin() + std::ptrdiff_t(i), {start + wanted, end - start - wanted});
            // What alignment skips stays free: a smaller piece may fit there.
            if (start > range.offset) free.insert(free.begin() + std::ptrdiff_t(i), {range.offset, start - range.offset});
            return start;
        }
        return std::nullopt;
    }

    void give(VkDeviceSize offset, VkDeviceSize bytes)
    {
        auto next = std::lower_bound(free.begin(), free.end(), offset, [](const Range& r, VkDeviceSize o) { return r.offset < o; });
        next = free.insert(next, {offset, bytes});
        // Joined with its neighbours, so that a block whose pieces are all back is one range and can be told to be empty.
        if (next + 1 != free.end() && next->offset + next->size == (next + 1)->offset)
        {
            next->size += (next + 1)->size;
            free.erase(next + 1);
        }
        if (next != free.begin() && (next - 1)->offset + (next - 1)->size == next->offset)
        {
            (next - 1)->size += next->size;
            free.erase(next);
        }
    }

    bool empty() const { return free.size() == 1 && free[0].size == size; }
};

VkDeviceMemory GpuMemory::Piece::memory() const
{
    return block->memory;
}
std::byte* GpuMemory::Piece::mapped() const
{
    return block->mapped ? block->mapped + offset : nullptr;
}

GpuMemory::GpuMemory(const HostVulkan& hostVulkan, const VulkanFunctions& functions) : host(hostVulkan), vk(functions)
{
    reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        host.getInstanceProcAddr(host.instance, "vkGetPhysicalDeviceMemoryProperties"))(host.physicalDevice, &types);
    budgetBytes = host.memoryBudget;
    if (budgetBytes == 0)
        for (uint32_t i = 0; i < types.memoryHeapCount; ++i)
            if (types.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
                budgetBytes = std::max<uint64_t>(budgetBytes, types.memoryHeaps[i].size / 5 * 4);
}

GpuMemory::~GpuMemory()
{
    assert(blocks.empty() && "a buffer or an image outlives its Gpu");
}

int GpuMemory::memoryType(uint32_t allowed, MemoryUse use) const
{
    const VkMemoryPropertyFlags hostFlags = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags needed = use == MemoryUse::device ? 0 : hostFlags;
    const VkMemoryPropertyFlags liked = use == MemoryUse::device     ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                                        : use == MemoryUse::readback ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                                                                     : 0;
    int fallback = -1;
    for (uint32_t i = 0; i < types.memoryTypeCount; ++i)
    {
        const VkMemoryPropertyFlags flags = types.memoryTypes[i].propertyFlags;
        if (!(allowed >> i & 1) || (flags & needed) != needed) continue;
        if ((flags & liked) == liked) return int(i);
        if (fallback < 0) fallback = int(i);
    }
    return fallback;
}

Result<GpuMemory::Block*> GpuMemory::addBlock(VkDeviceSize size, uint32_t type, bool linear, bool mapped, VkDeviceSize asked,
                                              const char* what)
{
    const auto refused = [&](const char* by)
    {
        return Error{
            ErrorCode::outOfMemory,
            fmt::format(
                "{} needs {} of device memory; {} of {} are in use and {} refused more; lower the resolution or raise the memory budget",
                what, mebibytes(asked), mebibytes(heldBytes), mebibytes(budgetBytes), by)};
    };
    if (heldBytes + size > budgetBytes) return refused("the budget");
    // Every buffer has a device address, and its memory must have been allocated for that; images need none.
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, linear ? &flags : nullptr};
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    Block block;
    const VkResult result = host.allocateMemory ? host.allocateMemory(info, block.memory)
                                                : vk.AllocateMemory(host.device, &info, host.allocationCallbacks, &block.memory);
    if (result != VK_SUCCESS) return refused("the device");
    block.size = size;
    block.type = type;
    block.linear = linear;
    block.free = {{0, size}};
    heldBytes += size;
    peakBytes = std::max<uint64_t>(peakBytes, heldBytes);
    blocks.push_back(std::move(block));
    Block* added = &blocks.back();
    if (mapped)
    {
        void* pointer = nullptr;
        if (vk.MapMemory(host.device, added->memory, 0, VK_WHOLE_SIZE, 0, &pointer) != VK_SUCCESS)
        {
            // The block is given back as if one piece of its whole size were, so that the budget is right again.
            Piece whole{added, 0, size};
            added->free.clear();
            giveBack(whole);
            return refused("mapping");
        }
        added->mapped = static_cast<std::byte*>(pointer);
    }
    return added;
}

Result<GpuMemory::Piece> GpuMemory::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear, const char* what)
{
    const int type = memoryType(needs.memoryTypeBits, use);
    if (type < 0) return Error{ErrorCode::missingFeature, fmt::format("The device has no memory type for {}; choose another device", what)};
    const bool mapped = use != MemoryUse::device;
    const std::scoped_lock lock(mutex);
    // Memory types, buffers or images, mapped or not: blocks are kept apart by all three.
    if (needs.size < kLargeBytes)
    {
        for (Block& block : blocks)
        {
            if (block.type != uint32_t(type) || block.linear != linear || (block.mapped != nullptr) != mapped) continue;
            if (const auto offset = block.take(needs.size, needs.alignment)) return Piece{&block, *offset, needs.size};
        }
    }
    // Near the end of the budget a small resource gets a block of its own size: a shared one would be refused for room that nobody asked
    // for.
    const bool shared = needs.size < kLargeBytes && heldBytes + kBlockBytes <= budgetBytes;
    auto block = addBlock(shared ? kBlockBytes : needs.size, uint32_t(type), linear, mapped, needs.size, what);
    if (!block) return block.error();
    return Piece{*block, *(*block)->take(needs.size, needs.alignment), needs.size};
}

void GpuMemory::release(Piece& piece)
{
    if (!piece.block) return;
    const std::scoped_lock lock(mutex);
    giveBack(piece);
}

void GpuMemory::giveBack(Piece& piece)
{
    piece.block->give(piece.offset, piece.size);
    if (piece.block->empty())
    {
        heldBytes -= piece.block->size;
        if (host.freeMemory)
            host.freeMemory(piece.block->memory);
        else
            vk.FreeMemory(host.device, piece.block->memory, host.allocationCallbacks);
        blocks.remove_if([&](const Block& block) { return &block == piece.block; });
    }
    piece = {};
}

} // namespace sconce
