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

    GpuTimer(GpuTimer&&) noexcept;
    GpuTimer& operator=(GpuTimer&&) noexcept;
    ~GpuTimer();

    void reset(VkCommandBuffer cmd); // first in a command buffer, outside rendering
    void begin(VkCommandBuffer cmd, const char* name);
    void end(VkCommandBuffer cmd);

    struct Scope
    {
        const char* name;
        double milliseconds;
    };
    /// After the command buffer has finished; empty when the queue has no timestamps, or a lost device doesn't give them.
    std::vector<Scope> read() const;

private:
    struct State;
    explicit GpuTimer(std::unique_ptr<State> made);
    std::unique_ptr<State> state;
};

} // namespace sconce
