#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/vulkan/gpu.h"
#include "runtime/vulkan/made_device.h"

struct GLFWwindow;

namespace sconce::tools
{

/// 8 bits a channel, row 0 at the top.
struct WindowPicture
{
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb; // sRGB
};

/// A window of the desktop with a device that draws into it: instance, device, swapchain, and the render pass in which a panel is drawn.
/// One a process, used from the main thread.
class Window
{
public:
    struct Desc
    {
        std::string title;
        uint32_t width = 0, height = 0; // pixels
        bool fixed = false;             // can't be resized
        std::string device;             // as OwnDevice::Desc
    };
    /// Errors: missingFeature (no display, a device that can't draw into it), deviceFailure, badArgument (the device).
    static Result<std::unique_ptr<Window>> create(const Desc& desc);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    Gpu& gpu() { return *shared; }
    std::string deviceName() const { return made->name(); }
    size_t validationMessages() const;
    GLFWwindow* handle() const { return window; }
    VkRenderPass renderPass() const { return pass; }
    uint32_t imageCount() const { return uint32_t(images.size()); }
    VkExtent2D extent() const { return size; } // of the swapchain, pixels

    void poll();               // the desktop's events
    void wait(double seconds); // for one, at most so long
    bool closed() const;
    bool minimised() const; // nothing can be shown
    /// Shows a picture, stretched to the window where it has another size, and what `overlay` draws on it in the render pass.
    /// @param picture  in VK_IMAGE_LAYOUT_GENERAL, visible to copies; null: black
    /// @param grab  out: what the window then shows; null: not asked for
    /// Errors: deviceFailure, outOfMemory; missingFeature: the surface can't be read.
    Status present(const GpuImage* picture, const std::function<void(VkCommandBuffer)>& overlay, WindowPicture* grab = nullptr);
    void waitIdle(); // before what a frame reads goes

private:
    struct Target
    {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkSemaphore drawn = VK_NULL_HANDLE; // of each image: a present may still wait for it when another image is drawn
    };
    Window() = default;
    Status makeDeviceAndSurface(const Desc& desc);
    Status makePass();
    Status makeCommands();
    Result<VkSwapchainCreateInfoKHR> wantedSwapchain();
    Status makeSwapchain();
    Status addTarget(VkImage image);
    void dropSwapchain();
    Result<std::optional<uint32_t>> acquire();
    Status record(const Target& target, const GpuImage* picture, const std::function<void(VkCommandBuffer)>& overlay,
                  const Buffer& grabbed);
    Status show(uint32_t index);
    void recordPicture(VkCommandBuffer cmd, const Target& target, const GpuImage* picture);
    void recordGrab(VkCommandBuffer cmd, const Target& target, const Buffer& to);
    void readGrab(const Buffer& from, WindowPicture& grab) const;

    GLFWwindow* window = nullptr;
    std::unique_ptr<MadeDevice> made;
    std::shared_ptr<Gpu> shared;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format{};
    VkRenderPass pass = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain = VK_NULL_HANDLE;
    VkExtent2D size{};
    bool readable = false, stale = false; // the swapchain's images may be copied from; it no longer fits
    std::vector<Target> images;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkSemaphore acquired = VK_NULL_HANDLE;
};

} // namespace sconce::tools
