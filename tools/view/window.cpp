#include "tools/view/window.h"

#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

namespace sconce::tools
{

namespace
{

constexpr uint64_t kForever = ~uint64_t(0);

Error glfwError(const char* what, const char* remedy)
{
    const char* why = nullptr;
    glfwGetError(&why);
    return {ErrorCode::missingFeature, fmt::format("{}: {}; {}.", what, why ? why : "no reason is known", remedy)};
}

Error vulkanError(const char* call, VkResult result)
{
    return {
        result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? ErrorCode::outOfMemory
                                                                                         : ErrorCode::deviceFailure,
        fmt::format("{} failed with VkResult {}; close other programs that use the device, or start the viewer anew.", call, int(result))};
}

/// Whole-image barrier of the swapchain's images, which are no GpuImage.
void change(VkCommandBuffer cmd, VkImage image, VkImageLayout from, VkImageLayout to, VkPipelineStageFlags2 fromStage,
            VkAccessFlags2 written, VkPipelineStageFlags2 toStage, VkAccessFlags2 used)
{
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = fromStage;
    barrier.srcAccessMask = written;
    barrier.dstStageMask = toStage;
    barrier.dstAccessMask = used;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(cmd, &dependency);
}

} // namespace

Result<std::unique_ptr<Window>> Window::create(const Desc& desc)
{
    if (!glfwInit()) return glfwError("No window can be opened", "run the viewer on a desktop, or under xvfb-run");
    std::unique_ptr<Window> window(new Window());
    if (Status status = window->makeDeviceAndSurface(desc); !status) return status.error();
    if (Status status = window->makePass(); !status) return status.error();
    if (Status status = window->makeCommands(); !status) return status.error();
    if (Status status = window->makeSwapchain(); !status) return status.error();
    return window;
}

Status Window::makeDeviceAndSurface(const Desc& desc)
{
    uint32_t count = 0;
    const char** wanted = glfwVulkanSupported() ? glfwGetRequiredInstanceExtensions(&count) : nullptr;
    if (!wanted) return glfwError("Vulkan can't draw into windows here", "install a Vulkan driver that can (Mesa has a software one)");
    const char* deviceExtensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    auto device = makeDevice({.device = desc.device}, std::span(wanted, count), deviceExtensions);
    if (!device) return device.error();
    made = std::move(*device);
    auto gpu = Gpu::create(made->host);
    if (!gpu) return gpu.error();
    shared = std::move(*gpu);

    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, desc.fixed ? GLFW_FALSE : GLFW_TRUE);
    window = glfwCreateWindow(int(desc.width), int(desc.height), desc.title.c_str(), nullptr, nullptr);
    if (!window) return glfwError("The window can't be opened", "give a smaller --size");
    const VkResult result = glfwCreateWindowSurface(made->host.instance, window, nullptr, &surface);
    if (result != VK_SUCCESS) return vulkanError("glfwCreateWindowSurface", result);
    VkBool32 shows = VK_FALSE;
    vkGetPhysicalDeviceSurfaceSupportKHR(made->host.physicalDevice, made->host.queueFamily, surface, &shows);
    if (!shows)
        return Error{ErrorCode::missingFeature,
                     fmt::format("The device {} can't draw into this desktop's windows; choose another with --device.", made->name())};
    return success();
}

Status Window::makePass()
{
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(made->host.physicalDevice, surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(made->host.physicalDevice, surface, &count, formats.data());
    // Not one that encodes by itself: the viewer's picture and the panel are sRGB as they are.
    const auto plain = std::ranges::find_if(formats, [](const VkSurfaceFormatKHR& f)
                                            { return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM; });
    if (plain == formats.end())
        return Error{ErrorCode::missingFeature, "The window has no format of 8 bits a channel; choose another device with --device."};
    format = *plain;

    VkAttachmentDescription color{};
    color.format = format.format;
    color.samples = VK_SAMPLE_COUNT_1_BIT;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD; // the picture
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    color.initialLayout = color.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = 1;
    info.pAttachments = &color;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    const VkResult result = vkCreateRenderPass(made->host.device, &info, nullptr, &pass);
    return result == VK_SUCCESS ? success() : Status(vulkanError("vkCreateRenderPass", result));
}

Status Window::makeCommands()
{
    const VkDevice device = made->host.device;
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     made->host.queueFamily};
    if (VkResult result = vkCreateCommandPool(device, &poolInfo, nullptr, &pool); result != VK_SUCCESS)
        return vulkanError("vkCreateCommandPool", result);
    VkCommandBufferAllocateInfo one{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    if (VkResult result = vkAllocateCommandBuffers(device, &one, &commands); result != VK_SUCCESS)
        return vulkanError("vkAllocateCommandBuffers", result);
    const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
    if (VkResult result = vkCreateFence(device, &fenceInfo, nullptr, &fence); result != VK_SUCCESS)
        return vulkanError("vkCreateFence", result);
    const VkSemaphoreCreateInfo semaphoreInfo{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
    if (VkResult result = vkCreateSemaphore(device, &semaphoreInfo, nullptr, &acquired); result != VK_SUCCESS)
        return vulkanError("vkCreateSemaphore", result);
    return success();
}

/// What the swapchain is to be for the window as it is now. A width of 0: nothing can be shown.
Result<VkSwapchainCreateInfoKHR> Window::wantedSwapchain()
{
    VkSurfaceCapabilitiesKHR can{};
    if (VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(made->host.physicalDevice, surface, &can); result != VK_SUCCESS)
        return vulkanError("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", result);
    if (!(can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        return Error{ErrorCode::missingFeature, "The window's images can't be copied to; choose another device with --device."};
    readable = can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface;
    info.minImageCount = can.maxImageCount > 0 ? std::min(can.minImageCount + 1, can.maxImageCount) : can.minImageCount + 1;
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = can.currentExtent;
    // Where the surface leaves the size open it says so by its largest number.
    if (info.imageExtent.width == ~0u)
        info.imageExtent = {std::clamp(uint32_t(width), can.minImageExtent.width, can.maxImageExtent.width),
                            std::clamp(uint32_t(height), can.minImageExtent.height, can.maxImageExtent.height)};
    if (info.imageExtent.height == 0) info.imageExtent.width = 0;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (readable) info.imageUsage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                                                          : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // that every device has
    info.clipped = readable ? VK_FALSE : VK_TRUE; // what other windows hide is read, too
    info.oldSwapchain = swapchain;
    return info;
}

Status Window::makeSwapchain()
{
    waitIdle();
    stale = true;
    const auto info = wantedSwapchain();
    if (!info) return info.error();
    if (info->imageExtent.width == 0) return success(); // minimised
    VkSwapchainKHR next = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(made->host.device, &*info, nullptr, &next);
    dropSwapchain();
    if (result != VK_SUCCESS) return vulkanError("vkCreateSwapchainKHR", result);
    swapchain = next;
    size = info->imageExtent;
    stale = false;

    uint32_t count = 0;
    vkGetSwapchainImagesKHR(made->host.device, swapchain, &count, nullptr);
    std::vector<VkImage> held(count);
    vkGetSwapchainImagesKHR(made->host.device, swapchain, &count, held.data());
    for (VkImage image : held)
        if (Status added = addTarget(image); !added) return added;
    return success();
}

Status Window::addTarget(VkImage image)
{
    const VkDevice device = made->host.device;
    Target& target = images.emplace_back();
    target.image = image;
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    if (VkResult done = vkCreateImageView(device, &view, nullptr, &target.view); done != VK_SUCCESS)
        return vulkanError("vkCreateImageView", done);
    VkFramebufferCreateInfo frame{};
    frame.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    frame.renderPass = pass;
    frame.attachmentCount = 1;
    frame.pAttachments = &target.view;
    frame.width = size.width;
    frame.height = size.height;
    frame.layers = 1;
    if (VkResult done = vkCreateFramebuffer(device, &frame, nullptr, &target.framebuffer); done != VK_SUCCESS)
        return vulkanError("vkCreateFramebuffer", done);
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
    if (VkResult done = vkCreateSemaphore(device, &semaphore, nullptr, &target.drawn); done != VK_SUCCESS)
        return vulkanError("vkCreateSemaphore", done);
    return success();
}

void Window::dropSwapchain()
{
    const VkDevice device = made->host.device;
    for (const Target& target : images)
    {
        vkDestroySemaphore(device, target.drawn, nullptr);
        vkDestroyFramebuffer(device, target.framebuffer, nullptr);
        vkDestroyImageView(device, target.view, nullptr);
    }
    images.clear();
    vkDestroySwapchainKHR(device, swapchain, nullptr);
    swapchain = VK_NULL_HANDLE;
}

Window::~Window()
{
    if (made && made->host.device)
    {
        const VkDevice device = made->host.device;
        vkDeviceWaitIdle(device);
        dropSwapchain();
        vkDestroySemaphore(device, acquired, nullptr);
        vkDestroyFence(device, fence, nullptr);
        vkDestroyCommandPool(device, pool, nullptr);
        vkDestroyRenderPass(device, pass, nullptr);
        if (surface) vkDestroySurfaceKHR(made->host.instance, surface, nullptr);
    }
    if (window) glfwDestroyWindow(window);
    shared.reset();
    made.reset();
    glfwTerminate();
}

size_t Window::validationMessages() const
{
    std::scoped_lock lock(made->log.mutex);
    return made->log.messages.size();
}

void Window::poll()
{
    glfwPollEvents();
}

void Window::wait(double seconds)
{
    glfwWaitEventsTimeout(seconds);
}

bool Window::closed() const
{
    return glfwWindowShouldClose(window);
}

bool Window::minimised() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return width == 0 || height == 0;
}

void Window::waitIdle()
{
    vkDeviceWaitIdle(made->host.device);
}

/// None: nothing can be shown now.
Result<std::optional<uint32_t>> Window::acquire()
{
    // Twice: a swapchain that no longer fits is made anew, and may be out of date again only if the window changes just then.
    for (int attempt = 0; attempt < 2; ++attempt)
    {
        if (stale)
            if (Status status = makeSwapchain(); !status) return status.error();
        if (stale) return std::optional<uint32_t>();
        uint32_t index = 0;
        const VkResult result = vkAcquireNextImageKHR(made->host.device, swapchain, kForever, acquired, VK_NULL_HANDLE, &index);
        if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR)
        {
            stale = result == VK_SUBOPTIMAL_KHR;
            return std::optional(index);
        }
        if (result != VK_ERROR_OUT_OF_DATE_KHR) return vulkanError("vkAcquireNextImageKHR", result);
        stale = true;
    }
    return std::optional<uint32_t>();
}

void Window::recordPicture(VkCommandBuffer cmd, const Target& target, const GpuImage* picture)
{
    // From the stage that the submit waits at for the image.
    change(cmd, target.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0,
           VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    if (picture)
    {
        const VkImageSubresourceLayers layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        // Read after write: the pass that made it; and back to the layout that its descriptor names, write after read.
        transition(*shared, cmd, *picture,
                   {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
        VkImageBlit blit{};
        blit.srcSubresource = blit.dstSubresource = layer;
        blit.srcOffsets[1] = {int32_t(picture->desc().width), int32_t(picture->desc().height), 1};
        blit.dstOffsets[1] = {int32_t(size.width), int32_t(size.height), 1};
        vkCmdBlitImage(cmd, picture->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                       &blit, VK_FILTER_NEAREST);
        transition(*shared, cmd, *picture,
                   {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                    VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
    }
    else
    {
        const VkClearColorValue black{{0.0f, 0.0f, 0.0f, 1.0f}};
        vkCmdClearColorImage(cmd, target.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    }
    change(cmd, target.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
           VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
           VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
}

void Window::recordGrab(VkCommandBuffer cmd, const Target& target, const Buffer& to)
{
    change(cmd, target.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
           VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
           VK_ACCESS_2_TRANSFER_READ_BIT);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {size.width, size.height, 1};
    vkCmdCopyImageToBuffer(cmd, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1, &copy);
    change(cmd, target.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
           VK_ACCESS_2_TRANSFER_READ_BIT, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    // For the host's reads, which the fence alone doesn't cover.
    memoryBarrier(*shared, cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_HOST_READ_BIT);
}

void Window::readGrab(const Buffer& from, WindowPicture& grab) const
{
    grab.width = size.width;
    grab.height = size.height;
    grab.rgb.resize(size_t(size.width) * size.height * 3);
    const auto* bytes = reinterpret_cast<const uint8_t*>(from.mapped());
    const bool blueFirst = format.format == VK_FORMAT_B8G8R8A8_UNORM;
    for (size_t i = 0; i < grab.rgb.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c) grab.rgb[3 * i + c] = bytes[4 * i + (blueFirst ? 2 - c : c)];
}

Status Window::record(const Target& target, const GpuImage* picture, const std::function<void(VkCommandBuffer)>& overlay,
                      const Buffer& grabbed)
{
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                         nullptr};
    vkBeginCommandBuffer(commands, &begin);
    recordPicture(commands, target, picture);
    VkRenderPassBeginInfo into{};
    into.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    into.renderPass = pass;
    into.framebuffer = target.framebuffer;
    into.renderArea.extent = size;
    vkCmdBeginRenderPass(commands, &into, VK_SUBPASS_CONTENTS_INLINE);
    if (overlay) overlay(commands);
    vkCmdEndRenderPass(commands);
    if (grabbed) recordGrab(commands, target, grabbed);
    change(commands, target.image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
           VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE, 0);
    const VkResult result = vkEndCommandBuffer(commands);
    return result == VK_SUCCESS ? success() : Status(vulkanError("vkEndCommandBuffer", result));
}

/// Submits what was recorded, and shows the image.
Status Window::show(uint32_t index)
{
    const Target& target = images[index];
    const VkPipelineStageFlags waits = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.waitSemaphoreCount = 1;
    submit.pWaitSemaphores = &acquired;
    submit.pWaitDstStageMask = &waits;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &target.drawn;
    vkResetFences(made->host.device, 1, &fence);
    if (VkResult result = vkQueueSubmit(made->host.queue, 1, &submit, fence); result != VK_SUCCESS)
        return vulkanError("vkQueueSubmit", result);
    VkPresentInfoKHR shown{};
    shown.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    shown.waitSemaphoreCount = 1;
    shown.pWaitSemaphores = &target.drawn;
    shown.swapchainCount = 1;
    shown.pSwapchains = &swapchain;
    shown.pImageIndices = &index;
    const VkResult result = vkQueuePresentKHR(made->host.queue, &shown);
    stale = stale || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
    if (result != VK_SUCCESS && !stale) return vulkanError("vkQueuePresentKHR", result);
    return success();
}

Status Window::present(const GpuImage* picture, const std::function<void(VkCommandBuffer)>& overlay, WindowPicture* grab)
{
    if (grab && !readable)
        return Error{ErrorCode::missingFeature, "The window can't be read back on this device; take a picture with `shot` instead."};
    vkWaitForFences(made->host.device, 1, &fence, VK_TRUE, kForever);
    Buffer grabbed;
    auto index = acquire();
    if (!index) return index.error();
    if (!*index) return success();
    if (grab)
    {
        auto buffer = shared->makeBuffer(VkDeviceSize(size.width) * size.height * 4, 0, MemoryUse::readback, "the window's picture");
        if (!buffer) return buffer.error();
        grabbed = std::move(*buffer);
    }
    if (Status recorded = record(images[**index], picture, overlay, grabbed); !recorded) return recorded;
    if (Status shown = show(**index); !shown) return shown;
    if (!grab) return success();
    vkWaitForFences(made->host.device, 1, &fence, VK_TRUE, kForever);
    readGrab(grabbed, *grab);
    return success();
}

} // namespace sconce::tools
