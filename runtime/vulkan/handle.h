#pragma once

#include <utility>

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
    /// Where a function of the device writes what it makes; what was held before is given back.
    T* fresh(const Gpu& maker)
    {
        *this = Handle();
        gpu = &maker;
        return &value;
    }
    explicit operator bool() const { return value != T{}; }

private:
    const Gpu* gpu = nullptr;
    T value = {};
};

} // namespace sconce
