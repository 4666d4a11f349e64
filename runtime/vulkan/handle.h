#pragma once

#include <utility>

#include <vulkan/vulkan.h>

namespace sconce
{

class Gpu;

/// Owns what a device made and gives it back to it; move-only. Whatever was made must go before its Gpu, after the GPU has finished with
/// it.
/// @tparam Destroy  the function of VulkanFunctions that gives it back
template <class T, auto Destroy> class Handle
{
public:
    Handle() = default;
    Handle(Handle&& other) noexcept : gpu(std::exchange(other.gpu, nullptr)), value(std::exchange(other.value, T{})) {}
    Handle& operator=(Handle&& other) noexcept
    {
        Handle taken(std::move(other));
        std::swap(gpu, taken.gpu);
        std::swap(value, taken.value);
        return *this;
    }
    ~Handle(); // defined where Gpu is: runtime/vulkan/gpu.h

    T get() const { return value; }
    /// Holds what a function of the device makes; what was held before is given back. Of one that fails nothing is held: Vulkan doesn't say
    /// what such a function leaves in its output.
    /// @param arguments  of the function, without the output, its last
    template <class Function, class... Arguments> VkResult make(const Gpu& maker, Function function, const Arguments&... arguments)
    {
        *this = Handle();
        T made = {};
        const VkResult result = function(arguments..., &made);
        if (result == VK_SUCCESS) gpu = &maker, value = made;
        return result;
    }
    explicit operator bool() const { return value != T{}; }

private:
    const Gpu* gpu = nullptr;
    T value = {};
};

} // namespace sconce
