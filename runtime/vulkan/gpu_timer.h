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

/// Scopes of one record of each of the library's objects, and as many again of the host's own.
inline constexpr uint32_t kScopesOfAFrame = 48;

/// Milliseconds on the GPU of named stretches of a command buffer, one after the other. Names must be literals. Recording never allocates.
class GpuTimer
{
public:
    /// Without timestamps in the queue it is made all the same, and read() gives nothing. Errors: badArgument, deviceFailure, outOfMemory.
    /// @param maxScopes  between two resets, above 0; further ones are not timed
    static Result<GpuTimer> create(const Device& device, uint32_t maxScopes = kScopesOfAFrame);
    static Result<GpuTimer> create(Gpu& gpu, uint32_t maxScopes = kScopesOfAFrame);

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
