#pragma once

#include "runtime/frame_inputs.h"
#include "shaders/shared/frame.h"

namespace sconce
{

/// Which tiles of a frame need which term (shaders/shared/frame.h): classified on the device from the G-buffer, so that each pass runs only
/// where it is called for. Cost: one read of the G-buffer a pixel. Without it passes run over the whole picture, with the same pixels.
class TileList
{
public:
    /// @param frame     the gpu::FrameView
    /// @param everyLog  log2 of the tiles that a workgroup of a sparse pass takes
    static Result<TileList> create(Gpu& gpu, const Buffer& frame, uint32_t width, uint32_t height, uint32_t everyLog);
    void setInputs(const FrameInputs& inputs) { writeInputs(set, inputs); }
    /// Ends with the barrier that lets passes run by the lists.
    void record(VkCommandBuffer cmd) const;
    /// Dispatches the bound pass over a list's tiles; a sparse pass by as many fewer workgroups.
    void dispatch(VkCommandBuffer cmd, uint32_t list, bool sparse) const;

    const Buffer& buffer() const { return lists; } // binding kTileBinding of shaders/tiles.glsl
    explicit operator bool() const { return bool(pipeline); }

private:
    Gpu* gpu = nullptr;
    uint32_t across = 0, down = 0; // tiles
    Buffer lists;
    DescriptorSet set;
    Pipeline pipeline;
};

inline constexpr uint32_t kTileBinding = 8;

/// Dispatches the bound pass over a list's tiles, or over the whole picture where there is no list.
/// @param everyLog  log2 of the tiles that a workgroup takes; 0, or what the list was made with
void dispatchTiles(Gpu& gpu, VkCommandBuffer cmd, const TileList* tiles, uint32_t list, uint32_t width, uint32_t height,
                   uint32_t everyLog = 0);

} // namespace sconce
