#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan.h>

namespace sconce::testing_support
{

// A program that links this has a vkGetInstanceProcAddr of its own before the loader's: calls that can fail are counted, one of them fails
// without being made, and what was made and not given back is known. Of a failed call's outputs Vulkan promises nothing: they get what no
// driver has made. All Vulkan calls of the program must come from one thread.

/// A call that can fail.
struct FallibleCall
{
    std::string_view function;
    size_t line;                      // of the program that calls, whoever called it there
    size_t site;                      // what called the function that the line is in, and so on: all of the stack but the line
    std::span<const VkResult> errors; // that it may return
};

struct VulkanFault
{
    size_t call = 0;                // of those since the watch began
    size_t error = 0;               // of FallibleCall::errors
    bool lost = false;              // the device is lost from that call on: all that may say so do, until the watch ends
    std::string_view function = {}; // whose calls are counted; empty: all
};

struct VulkanWatch
{
    std::vector<FallibleCall> calls;
    VkResult given = VK_SUCCESS;     // by the call that failed
    std::vector<std::string> wrongs; // a call that no program may make: of what isn't there, or what the device still uses
};

/// @param fault  none: nothing fails
void watchVulkan(std::optional<VulkanFault> fault = {});
VulkanWatch endVulkanWatch();

/// How many of each kind are there that were not given back: "Buffer", "Memory", "Device".
std::map<std::string_view, size_t> aliveInVulkan();

} // namespace sconce::testing_support
