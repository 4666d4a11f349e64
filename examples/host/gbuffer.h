#pragma once

#include "camera.h"
#include "drawn_scene.h"
#include "vulkan_base.h"

/// What is seen of the scene, a pixel each: reversed depth; the normal and the roughness; base colour and metallic; emission.
class GBuffer
{
public:
    GBuffer(const Vulkan& vulkan, const DrawnScene& drawn, vk::Extent2D size);
    /// Ends with all four images readable by compute shaders, in layout ShaderReadOnlyOptimal.
    void record(vk::CommandBuffer cmd, const Camera& camera, Convention convention) const;

    Image depth, normalRoughness, baseColorMetallic, emission;

private:
    const DrawnScene& scene;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};
