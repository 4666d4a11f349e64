#pragma once

#include "runtime/tile_list.h"

namespace sconce
{

/// The cross-bilateral filter: steps of shaders/denoise.comp that read and write two images in turn. Made for one G-buffer and one pair.
class Denoiser
{
public:
    /// @param noisy, filtered  RGBA32F in VK_IMAGE_LAYOUT_GENERAL; the result is in `filtered`, `noisy` is overwritten
    struct Desc
    {
        VkDescriptorSetLayout firstSet = VK_NULL_HANDLE; // of whatever lies in descriptor set 0
        uint32_t term = gpu::kTermGlossy;                // only its pixels are read and written
        bool followRoughness = false;    // a pixel's reach shrinks with its roughness, to nothing for a mirror: for the glossy term
        const TileList* tiles = nullptr; // null: over the whole picture
        uint32_t width = 0, height = 0;
    };
    static Result<Denoiser> create(Gpu& gpu, const Desc& desc, const Buffer& frame, const GpuImage& noisy, const GpuImage& filtered);
    void setInputs(const FrameInputs& inputs);
    void record(VkCommandBuffer cmd, VkDescriptorSet firstSet) const;
    explicit operator bool() const { return bool(pipeline); }

private:
    Gpu* gpu = nullptr;
    Desc desc;
    DescriptorSet forth, back;
    Pipeline pipeline;
};

} // namespace sconce
