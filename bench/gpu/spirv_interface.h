#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/result.h"

namespace sconce
{

/// What a compute shader is bound to, as its code says.
struct SpirvInterface
{
    struct Binding
    {
        uint32_t set, binding;
        VkDescriptorType type;
    };
    std::vector<Binding> bindings; // in the order of set and binding
    bool pushes = false;           // has push constants
};

/// Reads the sets, bindings and kinds of what a compute shader declares (SPIR-V Specification, Khronos, 1.6, sections 3.42.6 to 3.42.8).
/// Errors: badInput where it is no SPIR-V, is no compute shader, or declares what none of ours does (arrays of resources).
Result<SpirvInterface> spirvInterface(std::span<const uint32_t> code);

} // namespace sconce
