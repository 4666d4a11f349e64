#pragma once

#include <set>
#include <string_view>
#include <vector>

#include "runtime/vulkan/pipeline.h"
#include "shaders/shared/nan_scan.h"

namespace sconce
{

/// Debugging: scans what a pass has written for numbers that are NaN or infinite and names the first: pass, buffer, place. A Gpu has one
/// where the environment says SCONCE_NAN_SCAN=1, and Gpu::submit then fails with what it found; who submits command buffers of its own
/// asks findings(). Costs a copy and a read of everything written.
class NanScan
{
public:
    static Result<std::unique_ptr<NanScan>> create(Gpu& gpu);

    struct Words
    {
        uint32_t kind = gpu::kScanFloats;
        VkDeviceSize first = 0; // word
        VkDeviceSize count = 0; // words; 0: to the buffer's end
        uint32_t stride = 1;    // words an item, at most 32
        uint32_t mask = ~0u;    // bit i: word i of an item is looked at
    };
    /// Records a scan; `pass` must be a literal. Outside rendering only.
    void buffer(VkCommandBuffer cmd, const char* pass, const Buffer& buffer, const Words& words);
    /// The same for all layers of an image's first mip. Images of integers have nothing to find.
    void image(VkCommandBuffer cmd, const char* pass, const GpuImage& image, VkImageLayout layout);

    /// After the command buffers have finished: deviceFailure with the sentence of the first bad number, in the order of recording.
    Status findings();

    /// Names of all buffers and all images of floats that scanning Gpus of this process have made since the last call, and of those that
    /// were scanned: what is in the one set and not in the other must have a reason (tests/runtime/vulkan/nan_scan_test.cpp holds the
    /// list).
    struct Coverage
    {
        std::set<std::string_view> made, scanned;
    };
    static Coverage takeCoverage();
    static void note(const Buffer& made);
    static void note(const GpuImage& made);

private:
    explicit NanScan(Gpu& owner) : gpu(owner) {}
    struct Scan
    {
        const char* pass;
        const char* what;
        uint32_t wordsAPixel, width, height, layers; // width 0: a buffer
    };
    bool takeSlot(const Scan& scan);
    void dispatch(VkCommandBuffer cmd, VkDeviceAddress words, uint32_t count, uint32_t before, const Words& how);

    Gpu& gpu;
    Pipeline pipeline;
    Buffer scratch; // a piece of an image
    Buffer places;  // mapped: least bad word of each scan
    std::vector<Scan> scans;
    bool tooMany = false;
};

// What passes call: nothing where the Gpu doesn't scan.
void scanBuffer(Gpu& gpu, VkCommandBuffer cmd, const char* pass, const Buffer& buffer, const NanScan::Words& words);
void scanImage(Gpu& gpu, VkCommandBuffer cmd, const char* pass, const GpuImage& image, VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL);

} // namespace sconce
