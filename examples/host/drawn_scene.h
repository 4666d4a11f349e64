#pragma once

#include "gltf_mesh.h"
#include "vulkan_base.h"

/// A model on the device: its vertices and indices, and for each material a set of its four textures.
class DrawnScene
{
public:
    DrawnScene(const Vulkan& vulkan, Model loaded);

    const Model& model() const { return source; }
    void bindVertices(vk::CommandBuffer cmd) const;
    /// Of pipelines that draw(): sets of materials, and what gbuffer_push.glsl declares.
    vk::raii::PipelineLayout drawLayout() const;
    /// All of it with its materials, as seen from a place. @param clip  takes (position - eye, 1)
    void draw(vk::CommandBuffer cmd, vk::PipelineLayout layout, const glm::mat4& clip, glm::vec3 eye, float fieldsZ = 1.0f) const;
    /// Pipeline state that goes with it: position, normal and uv at locations 0, 1, 2; or the first of them.
    static vk::PipelineVertexInputStateCreateInfo vertexInput(uint32_t attributes = 3);

private:
    Image texture(const Picture& picture, vk::Format format) const;

    const Vulkan& gpu;
    Model source;
    Buffer vertices, indices;
    std::vector<Image> textures;
    vk::raii::Sampler sampler = nullptr;
    DescriptorSets materials;
};
