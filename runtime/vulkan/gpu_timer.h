#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/result.h"

namespace sconce
{

class Device;
class Gpu;

/// Milliseconds on the GPU of named stretches of a command buffer. Names must be literals. Recording never allocates.
class GpuTimer
{
public:
    /// Without timestamps in the queue it is made all the same, and read() gives nothing. Errors: deviceFailure, outOfMemory.
    static Result<GpuTimer> create(const Device& device, uint32_t maxScopes);
    static Result<GpuTimer> create(Gpu& gpu, uint32_t maxScopes);
    GpuTimer(GpuTimer&& other) noexcept;
    GpuTimer& operator=(GpuTimer&&) = delete;
    ~GpuTimer();

    void reset(VkCommandBuffer cmd); // first in a command buffer, outside rendering
    void begin(VkCommandBuffer cmd, const char* name);
    void end(VkCommandBuffer cmd);

    struct Scope
    {
        const char* name;
        double milliseconds;
    };
    /// After the command buffer has finished; empty when the queue has no timestamps.
    std::vector<Scope> read() const;

private:
    GpuTimer() = default;
    Gpu* gpu = nullptr;
    std::shared_ptr<Gpu> keptAlive; // where it was made from a Device
    VkQueryPool queries = VK_NULL_HANDLE;
    std::vector<const char*> names; // sized once
    uint32_t used = 0;
};

} // namespace sconce
