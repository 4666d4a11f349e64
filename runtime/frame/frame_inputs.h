#pragma once

#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// A host's G-buffer. All views are of 2D images in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL or GENERAL (say which), of one size. A pixel
/// with a number that is NaN, infinite or beyond all sense (over 1000), or a normal of no length, counts as one where nothing was drawn.
struct FrameInputs
{
    VkImageView depth = VK_NULL_HANDLE;             // reversed: 1 at the near plane, 0 where nothing was drawn
    VkImageView normalRoughness = VK_NULL_HANDLE;   // xyz shading normal, world, unit, on the viewer's side; w roughness [0,1]
    VkImageView baseColorMetallic = VK_NULL_HANDLE; // rgb linear, a metallic
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

/// What shaders/gbuffer_read.glsl declares: depth, normals, base colour and the frame's block at bindings 0 to 3; then images of the pass.
Result<DescriptorSet> makeFrameSet(Gpu& gpu, const Buffer& frame, std::span<const DescriptorSet::Binding> passBindings);
void writeInputs(DescriptorSet& set, const FrameInputs& inputs);

/// A storage image of the passes, in VK_IMAGE_LAYOUT_GENERAL, all 0.
Result<GpuImage> makeLightImage(Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, const char* what);

} // namespace sconce
