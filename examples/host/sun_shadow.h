#pragma once

#include "drawn_scene.h"
#include "vulkan_base.h"

/// The sun's shadow map: depth of the whole scene along its light, 0 nearest to it.
class SunShadow
{
public:
    SunShadow(const Vulkan& vulkan, const DrawnScene& drawn, const Sun& sun);
    /// Ends with the map readable by compute shaders, in layout ShaderReadOnlyOptimal.
    void record(vk::CommandBuffer cmd) const;

    const Image& map() const { return depth; }
    /// x and y in [0,1] over the map, z its depth. Affine.
    const glm::mat4& mapFromWorld() const { return place; }
    float texel() const { return width; } // metres

private:
    const DrawnScene& scene;
    Image depth;
    glm::mat4 place{1.0f};
    float width = 0.0f;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};
