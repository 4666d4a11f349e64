#include "sconce_gi.h"

#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>

namespace
{

template <class T> T valueOf(sconce::Result<T> result)
{
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

} // namespace

std::vector<std::string> SconceGi::missing(VkInstance instance, VkPhysicalDevice device)
{
    return sconce::missingFeatures(vkGetInstanceProcAddr, instance, device);
}

sconce::Device SconceGi::deviceOf(const Vulkan& vulkan, Allocators& lent)
{
    sconce::HostVulkan host;
    host.instance = *vulkan.instance;
    host.physicalDevice = *vulkan.physicalDevice;
    host.device = *vulkan.device;
    host.queueFamily = vulkan.family;
    host.queue = *vulkan.queue;
    host.getInstanceProcAddr = vkGetInstanceProcAddr;
    host.allocationCallbacks = lent.main.callbacks();
    host.allocateMemory = [&lent](const VkMemoryAllocateInfo& info, VkDeviceMemory& got) { return lent.device.allocate(info, got); };
    host.freeMemory = [&lent](VkDeviceMemory back) { lent.device.free(back); };
    return valueOf(sconce::Device::create(host));
}

SconceGi::SconceGi(const Vulkan& vulkan, Allocators& lent, const std::filesystem::path& file, VkExtent2D wanted, bool temporal)
    : size(wanted), device(deviceOf(vulkan, lent))
{
    field = valueOf(sconce::LightField::load(*device, file));
    sconce::IndirectLight::Desc desc{.width = size.width, .height = size.height, .effects = field->effectsOfFrames()};
    desc.effects.temporal = temporal;
    light = valueOf(sconce::IndirectLight::create(*device, *field, desc));
}

void SconceGi::record(VkCommandBuffer cmd, const Camera& camera, Convention convention, uint32_t seed)
{
    const auto clipFrom = [&](const Camera& c) { return clipFromWorld(c, convention, double(size.width) / size.height); };
    sconce::gpu::FrameView own = field->frameView(size.width, size.height); // in this host's world, as its normals are
    own.worldFromClip = glm::inverse(clipFrom(camera));
    own.eye = camera.eye;
    own.seed = seed;
    own.raysBelow = raysBelow;
    if (before)
    {
        own.follows = 1;
        own.eyeBefore = before->eye;
        own.clipFromWorldBefore = clipFrom(*before);
    }
    view = valueOf(sconce::inFieldsWorld(own, glm::scale(glm::mat4(1.0f), convention.axes()))); // the field's world is glTF's
    before = camera;
    light->record(cmd, view);
}

std::vector<std::string> SconceGi::faults() const
{
    return valueOf(sconce::validateInputs(*device, *field, inputs, view));
}

std::array<VkImageView, 4> SconceGi::terms(VkImageView nothing) const
{
    std::array<VkImageView, 4> views{light->diffuse().view, light->rough().view, light->glossy().view, light->mirror().view};
    for (VkImageView& view : views)
        if (!view) view = nothing;
    return views;
}
