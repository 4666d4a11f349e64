#pragma once

#include <array>

#include "runtime/frame/tile_list.h"

namespace sconce
{

/// The filters of a term's noise: over the G-buffer (shaders/denoise.comp), and over time (shaders/temporal.comp) where that is wanted.
class Denoiser
{
public:
    struct Desc
    {
        VkDescriptorSetLayout firstSet = VK_NULL_HANDLE; // of whatever lies in descriptor set 0
        uint32_t term = gpu::kTermGlossy;                // only its pixels are read and written
        bool followRoughness = false;    // a pixel's reach shrinks with its roughness, to nothing for a mirror: for the glossy term
        bool temporal = false;           // blend with the frames before, as FrameView::follows allows; 24 bytes more a pixel
        bool moving = false;             // what the term's light shows may move while the eye is still: its history is short
        const TileList* tiles = nullptr; // needed
        uint32_t width = 0, height = 0;
    };
    /// @param light    of kLightFormat, in VK_IMAGE_LAYOUT_GENERAL, noisy; filtered in place. The glossy term is given before its surfaces'
    ///                 tint (gpu::kUntintedId), and has it in the end
    /// @param scratch  another one
    static Result<Denoiser> create(Gpu& gpu, const Desc& desc, const Buffer& frame, const GpuImage& light, const GpuImage& scratch);
    void setInputs(const FrameInputs& inputs);
    /// Record frames in the order in which they are shown: each is the history of the next.
    void record(VkCommandBuffer cmd, VkDescriptorSet firstSet);
    explicit operator bool() const { return bool(pipeline); }
    uint64_t deviceBytes() const;

private:
    struct History // of one frame
    {
        GpuImage light, points;
        DescriptorSet blend; // reads the other frame's
        DescriptorSet first; // the first step of the filter, which reads this frame's
    };
    Result<DescriptorSet> makeStep(const Buffer& frame, const GpuImage& from, const GpuImage& to);
    Status makeHistory(const Buffer& frame, const GpuImage& light, const GpuImage& scratch);
    void blend(VkCommandBuffer cmd, VkDescriptorSet firstSet);
    Gpu* gpu = nullptr;
    Desc desc;
    DescriptorSet forth, back;
    Pipeline pipeline, temporal;
    std::array<History, 2> histories;
    uint32_t now = 0; // whose turn it is
};

} // namespace sconce
