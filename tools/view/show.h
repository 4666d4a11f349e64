#pragma once

#include <array>
#include <string_view>

#include "runtime/scene/scene_renderer.h"
#include "runtime/vulkan/pipeline.h"

namespace sconce::tools
{

/// What the window shows of a frame, in the order of show.comp; the names are those of --aov.
inline constexpr std::array<std::string_view, 12> kViews = {"beauty",  "direct", "diffuse_indirect", "glossy_indirect", "normal",
                                                            "albedo",  "depth",  "roughness",        "probe",           "handoffs",
                                                            "fetches", "unknown"};
/// How the path-traced reference stands beside ours, in the order of show.comp.
inline constexpr std::array<std::string_view, 3> kCompares = {"off", "split", "difference"};

struct Shown
{
    uint32_t view = 0;    // index into kViews
    uint32_t compare = 0; // index into kCompares; of beauty alone
    float exposure = 1.0f;
    float split = 0.5f;       // share of the width: ours to the left of it
    float depthMiddle = 1.0f; // metres that depth shows as half of white
};

/// The pass that makes a picture of 8 bits a channel, sRGB, out of a frame: the tone map of --png, or a view's colours. Move-only.
class Show
{
public:
    /// @param pictures  of a renderer that outlives this; all of width x height
    /// Errors: outOfMemory, deviceFailure.
    static Result<Show> create(Gpu& gpu, const FramePictures& pictures, uint32_t width, uint32_t height);

    /// Puts a reference beside ours: linear radiance, rgb, of the same size. Submits and waits.
    Status setReference(std::span<const float> rgb);
    bool hasReference() const { return referenceHeld; }
    void dropReference() { referenceHeld = false; }
    /// Ends with the barrier that lets a copy read target(), in VK_IMAGE_LAYOUT_GENERAL.
    void record(VkCommandBuffer cmd, const Shown& shown);
    const GpuImage& target() const { return picture; }

private:
    explicit Show(Gpu& made) : gpu(&made) {}
    Status make(const FramePictures& pictures, uint32_t width, uint32_t height);

    Gpu* gpu;
    GpuImage picture, reference, noCounts;
    DescriptorSet set;
    Pipeline pass;
    uint32_t have = 0; // bit i: view i has an image
    float depthScale = 1.0f;
    bool referenceHeld = false;
};

} // namespace sconce::tools
