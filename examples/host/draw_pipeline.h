#pragma once

#include "vulkan_base.h"

/// What the two passes that draw triangles differ in. Both sides of every triangle are drawn: real assets are not watertight.
struct DrawPipeline
{
    std::span<const uint32_t> vertex, fragment; // no fragment shader: depth alone
    std::span<const vk::Format> colors;
    vk::CompareOp nearer = vk::CompareOp::eGreaterOrEqual; // of depth, which is reversed unless said otherwise
    vk::PipelineVertexInputStateCreateInfo input;
    vk::PipelineLayout layout;
};
vk::raii::Pipeline makeDrawPipeline(const Vulkan& vulkan, const DrawPipeline& desc);
/// Begins drawing into targets of one size, which are cleared to 0. @param farDepth  that depth is cleared to
void beginDrawing(vk::CommandBuffer cmd, std::span<const Image* const> colors, const Image& depth, float farDepth);
