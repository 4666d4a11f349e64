#pragma once

#include "gltf_mesh.h"
#include "vulkan_base.h"

/// A model on the device: its vertices and indices, and for each material a set of its four textures.
class DrawnScene
{
public:
    DrawnScene(const Vulkan& vulkan, Model loaded);

    const Model& model() const { return source; }
    vk::DescriptorSetLayout materialLayout() const { return *materials.layout; }
    vk::DescriptorSet material(uint32_t index) const { return *materials.sets[index]; }
    void bindVertices(vk::CommandBuffer cmd) const;
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
