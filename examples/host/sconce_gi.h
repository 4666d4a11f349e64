#pragma once

// Sconce in this renderer. With sconce_gi.cpp and sconce_gi.glsl it is all that a host writes: but for sconce_bake.*, by which it
// bakes, no other file knows the library.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sconce/sconce.h>

#include "camera.h"
#include "vulkan_base.h"

class SconceGi
{
public:
    struct GBuffer // in layout ShaderReadOnlyOptimal
    {
        VkImageView depth, normalRoughness, baseColorMetallic;
    };

    /// What a device lacks to run the library.
    static std::vector<std::string> missing(VkInstance instance, VkPhysicalDevice device);
    static constexpr auto addFeatures = sconce::requireFeatures;
    static sconce::Device deviceOf(const Vulkan& vulkan, Allocators& lent);
    /// Goes once the GPU is done. @param lent  outlives it. @param temporal  filter over frames that follow one another
    SconceGi(const Vulkan& vulkan, Allocators& lent, const std::filesystem::path& field, VkExtent2D size, bool temporal);

    void setGBuffer(const GBuffer& buffer)
    {
        inputs = {buffer.depth, buffer.normalRoughness, buffer.baseColorMetallic};
        light->setInputs(inputs);
    }
    /// After the G-buffer, before composition; records alone.
    void record(VkCommandBuffer cmd, const Camera& camera, Convention convention, uint32_t seed);
    /// Diffuse, rough, glossy and mirror, in layout General, as sconce_gi.glsl binds them. @param nothing  in place of what is not made
    std::array<VkImageView, 4> terms(VkImageView nothing) const;
    uint32_t made() const { return light->made(); } // bits of those that are
    float raysBelow = sconce::gpu::kRaysBelow;      // roughness below which reflections are traced; quality levels have their own
    glm::vec3 sky() const { return field->info().sky; }
    /// Whether diffuse light has emitters and sky in it; else they are the host's to draw, as the sun is.
    bool hasAllDiffuse() const { return field->holdsSurfaceLight(); }
    /// What is wrong with the G-buffer and the view of the frame recorded last, a sentence each; waits for the GPU.
    std::vector<std::string> faults() const;
    uint64_t bytes() const { return device->bytes(); } // of device memory, by the library's own count

private:
    VkExtent2D size;
    std::optional<sconce::Device> device;
    std::optional<sconce::LightField> field;
    std::optional<sconce::IndirectLight> light;
    std::optional<Camera> before;
    sconce::FrameInputs inputs;
    sconce::gpu::FrameView view{};
};
