#pragma once

#include "runtime/frame/g_buffer.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce
{

/// Of light that passes hand on, at most gpu::kMostLight (shaders/stored_light.glsl): half the bytes of 32 bits a number, and rounding by a
/// 2048th at most is far below what rays and maps get wrong.
inline constexpr VkFormat kLightFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

/// What shaders/gbuffer_read.glsl declares: depth, normals, base colour and the frame's block at bindings 0 to 3; then images of the pass.
Result<DescriptorSet> makeFrameSet(Gpu& gpu, const Buffer& frame, std::span<const DescriptorSet::Binding> passBindings);
void writeInputs(DescriptorSet& set, const FrameInputs& inputs);

/// A storage image of the passes, in VK_IMAGE_LAYOUT_GENERAL, all 0.
Result<GpuImage> makeLightImage(Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, const char* what);

} // namespace sconce
