// Loaded before the loader of Vulkan (LD_PRELOAD), it makes a call of a command fail. The environment's SCONCE_VULKAN_FAULT says
// FUNCTION:N:ERROR, as VulkanFault has them, and :lost where the device stays lost.
#include <cstdlib>
#include <string>

#include "tests/support/vulkan_faults.h"

namespace
{

__attribute__((constructor)) void watchFromTheStart()
{
    const char* text = std::getenv("SCONCE_VULKAN_FAULT");
    if (text == nullptr) return;
    static const std::string all = text;
    const size_t first = all.find(':'), second = all.find(':', first + 1);
    sconce::testing_support::VulkanFault fault;
    fault.function = std::string_view(all).substr(0, first);
    fault.call = std::strtoul(all.c_str() + first + 1, nullptr, 10);
    fault.error = std::strtoul(all.c_str() + second + 1, nullptr, 10);
    fault.lost = all.ends_with(":lost");
    sconce::testing_support::watchVulkan(fault);
}

} // namespace
