#include "allocator.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

VkResult DeviceMemory::allocate(const VkMemoryAllocateInfo& info, VkDeviceMemory& memory)
{
    const VkResult result = vkAllocateMemory(owner, &info, nullptr, &memory);
    if (result != VK_SUCCESS) return result;
    sizes[memory] = info.allocationSize;
    now += info.allocationSize;
    most = std::max(most, now);
    return VK_SUCCESS;
}

void DeviceMemory::free(VkDeviceMemory memory)
{
    const auto block = sizes.find(memory);
    if (block == sizes.end()) return;
    now -= block->second;
    sizes.erase(block);
    vkFreeMemory(owner, memory, nullptr);
}

namespace
{

/// Lies right before every block: a driver gives neither back when it frees.
struct Front
{
    size_t size;   // bytes that were asked for
    size_t offset; // from the start of the block
};

Front& frontOf(void* memory)
{
    return *(static_cast<Front*>(memory) - 1);
}

} // namespace

HostMemory::HostMemory()
{
    functions.pUserData = this;
    functions.pfnAllocation = allocate;
    functions.pfnReallocation = reallocate;
    functions.pfnFree = free;
}

void* HostMemory::allocate(void* self, size_t size, size_t alignment, VkSystemAllocationScope)
{
    if (size == 0) return nullptr;
    const size_t offset = std::max(alignment, sizeof(Front)); // both are powers of two
    void* block = std::aligned_alloc(offset, (offset + size + offset - 1) / offset * offset);
    if (!block) return nullptr;
    void* memory = static_cast<char*>(block) + offset;
    frontOf(memory) = {size, offset};
    ++static_cast<HostMemory*>(self)->out;
    ++static_cast<HostMemory*>(self)->made;
    return memory;
}

void* HostMemory::reallocate(void* self, void* original, size_t size, size_t alignment, VkSystemAllocationScope scope)
{
    void* memory = allocate(self, size, alignment, scope);
    if (memory && original) std::memcpy(memory, original, std::min(size, frontOf(original).size));
    if (memory || size == 0) free(self, original); // where there is no memory, the original stays as it was
    return memory;
}

void HostMemory::free(void* self, void* memory)
{
    if (!memory) return;
    --static_cast<HostMemory*>(self)->out;
    std::free(static_cast<char*>(memory) - frontOf(memory).offset);
}
