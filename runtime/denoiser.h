#pragma once

#include "runtime/frame_inputs.h"

namespace sconce
{

/// The cross-bilateral filter: steps of shaders/denoise.comp that read and write two images in turn. Made for one G-buffer and one pair.
class Denoiser
{
public:
    /// @param noisy, filtered  RGBA32F in VK_IMAGE_LAYOUT_GENERAL; the result is in `filtered`, `noisy` is overwritten
    /// @param firstSet         layout of whatever lies in descriptor set 0
    static Result<Denoiser> create(Gpu& gpu, VkDescriptorSetLayout firstSet, const Buffer& frame, const GpuImage& noisy,
                                   const GpuImage& filtered);
    void setInputs(const FrameInputs& inputs);
    /// @param followRoughness  a pixel's reach shrinks with its roughness, to nothing for a mirror: for the glossy term
    void record(VkCommandBuffer cmd, VkDescriptorSet firstSet, uint32_t width, uint32_t height, bool followRoughness) const;
    explicit operator bool() const { return bool(pipeline); }

private:
    Gpu* gpu = nullptr;
    DescriptorSet forth, back;
    Pipeline pipeline;
};

} // namespace sconce
