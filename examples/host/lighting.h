#pragma once

#include <array>

#include "camera.h"
#include "gbuffer.h"
#include "sun_shadow.h"
#include "vulkan_base.h"

/// The frame's picture: emission, the sun with its shadows, the sky where nothing is, and indirect light.
class Lighting
{
public:
    /// What indirect light gives: see SconceGi.
    struct Indirect
    {
        std::array<VkImageView, 4> terms;
        uint32_t made = 0;
        float raysBelow = 0.0f;
        glm::vec3 sky{0.0f};
    };

    Lighting(const Vulkan& vulkan, vk::Extent2D size);
    void setInputs(const GBuffer& buffer, const SunShadow& shadow, const Indirect& light);
    /// After G-buffer, shadow map and indirect light. Ends with the pictures ready to be copied, in layout TransferSrcOptimal.
    void record(vk::CommandBuffer cmd, const Camera& camera, Convention convention, const Sun& sun, const SunShadow& shadow) const;

    /// Radiance to the eye, rgb: direct light with emission and sky; indirect light scattered by surfaces; reflected by them; the sum.
    std::array<Image, 4> pictures;
    vk::ImageView nothing() const { return *empty.view; } // to bind in place of a term that isn't made

private:
    const Vulkan& gpu;
    Image empty; // never read, but bound: it may be none that the pass writes
    Buffer block;
    Indirect indirect;
    vk::raii::Sampler comparing = nullptr;
    DescriptorSets set;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};
