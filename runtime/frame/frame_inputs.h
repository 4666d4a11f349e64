#pragma once

#include "runtime/frame/g_buffer.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// What shaders/gbuffer_read.glsl declares: depth, normals, base colour and the frame's block at bindings 0 to 3; then images of the pass.
Result<DescriptorSet> makeFrameSet(Gpu& gpu, const Buffer& frame, std::span<const DescriptorSet::Binding> passBindings);
void writeInputs(DescriptorSet& set, const FrameInputs& inputs);

/// A storage image of the passes, in VK_IMAGE_LAYOUT_GENERAL, all 0.
Result<GpuImage> makeLightImage(Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, const char* what);

} // namespace sconce
