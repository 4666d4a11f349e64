#pragma once

#include "runtime/frame/frame_inputs.h"
#include "shaders/shared/frame.h"
#include "shaders/shared/frame_passes.h"

namespace sconce
{

/// Which tiles of a frame need which term, which terms each pixel has, and what passes look up (shaders/shared/frame.h): classified on the
/// device from the G-buffer, so that each pass runs only where it is called for; and what filters ask of a pixel, in one word pair
/// (shaders/packed_pixel.glsl). Cost: one read of the G-buffer a pixel.
class TileList
{
public:
    /// A list of look-ups (shaders/lookups.glsl).
    struct LookUps
    {
        uint32_t terms; // bits, any of which makes a pixel one of the list
        uint32_t kind;  // gpu::kLookUpsPerPixel...
    };
    struct Desc
    {
        uint32_t width = 0, height = 0;    // pixels
        uint32_t everyLog = 0;             // log2 of the tiles that a workgroup of a sparse pass takes
        bool tiled = true;                 // false: passes run over the whole picture, with the same pixels
        std::vector<LookUps> lookUps = {}; // at most gpu::kMostLookUpLists
    };
    /// @param frame  the gpu::FrameView, a uniform buffer
    static Result<TileList> create(Gpu& gpu, const Buffer& frame, const Desc& desc);
    void setInputs(const FrameInputs& inputs) { writeInputs(set, inputs); }
    /// Empties the lists, by a transfer: the caller orders it after the frame before, which ran by them, and before record().
    void clear(VkCommandBuffer cmd) const;
    /// Ends with the barrier that lets passes run by the lists.
    void record(VkCommandBuffer cmd) const;
    /// Dispatches the bound pass over a list's tiles, or over the whole picture.
    /// @param everyLog  log2 of the tiles that a workgroup takes: 0, or Desc's
    void dispatch(VkCommandBuffer cmd, uint32_t list, uint32_t everyLog = 0) const;
    /// Dispatches the bound pass, which includes shaders/lookups.glsl, over a list of look-ups.
    void dispatchLookUps(VkCommandBuffer cmd, uint32_t list) const;
    ShaderConstant constant() const { return {gpu::kTiledId, desc.tiled ? 1u : 0u}; } // of passes that include shaders/tiles.glsl

    const Buffer& buffer() const { return lists; }          // their gpu::kTileBinding
    const GpuImage& packedPixels() const { return packed; } // their gpu::kPackedBinding
    uint64_t deviceBytes() const { return lists.size() + packed.bytes(); }
    explicit operator bool() const { return bool(pipeline); }

private:
    Gpu* gpu = nullptr;
    Desc desc;
    uint32_t across = 0, down = 0; // tiles
    Buffer lists;
    GpuImage packed;
    DescriptorSet set;
    Pipeline pipeline;
};

} // namespace sconce
