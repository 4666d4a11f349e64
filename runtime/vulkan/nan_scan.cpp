#include "runtime/vulkan/nan_scan.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "spirv/nan_scan_comp.h"

namespace sconce
{
namespace
{

constexpr VkDeviceSize kScratchBytes = VkDeviceSize(4) << 20; // rows of the largest images are 256 KiB
constexpr uint32_t kScans = 4096;                             // a submit
constexpr uint32_t kNoPlace = ~0u;
constexpr uint32_t kGroups = 256; // at most

struct Layout
{
    uint32_t wordsAPixel = 0; // 0: integers
    uint32_t kind = gpu::kScanFloats;
};

Layout layoutOf(VkFormat format)
{
    switch (format)
    {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return {4, gpu::kScanFloats};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
        return {2, gpu::kScanHalves};
    case VK_FORMAT_D32_SFLOAT:
        return {1, gpu::kScanFloats};
    default:
        return {};
    }
}

std::mutex coverageMutex;
NanScan::Coverage coverage;

void noteName(std::set<std::string_view> NanScan::Coverage::*set, const char* name)
{
    const std::lock_guard lock(coverageMutex);
    (coverage.*set).insert(name);
}

void everythingBefore(const Gpu& gpu, VkCommandBuffer cmd)
{
    // Any pass may have written what is scanned, and any may use it next; scans share one scratch buffer besides. A diagnosis can afford to
    // let nothing overlap. The host reads the places after the fence, and ALL_COMMANDS is no stage of its own.
    memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

} // namespace

Result<std::unique_ptr<NanScan>> NanScan::create(Gpu& gpu)
{
    std::unique_ptr<NanScan> made(new NanScan(gpu));
    auto pipeline = Pipeline::compute(gpu, nan_scan_comp, {}, sizeof(gpu::NanScanPush));
    if (!pipeline) return pipeline.error();
    made->pipeline = std::move(*pipeline);
    auto scratch = gpu.makeBuffer(kScratchBytes, 0, MemoryUse::device, "scratch of the scan for NaN");
    if (!scratch) return scratch.error();
    made->scratch = std::move(*scratch);
    auto places = gpu.makeBuffer(kScans * sizeof(uint32_t), 0, MemoryUse::readback, "findings of the scan for NaN");
    if (!places) return places.error();
    made->places = std::move(*places);
    // A scan lowers its place by an atomic minimum: 'nothing found' is the largest number there is.
    std::memset(made->places.mapped(), 0xff, made->places.size());
    made->scans.reserve(kScans);
    return made;
}

bool NanScan::takeSlot(const Scan& scan)
{
    // Remembered rather than reported here, in the middle of recording; findings() tells.
    tooMany = tooMany || scans.size() == kScans;
    if (tooMany) return false;
    scans.push_back(scan);
    noteName(&NanScan::Coverage::scanned, scan.what);
    return true;
}

NanScan::Coverage NanScan::takeCoverage()
{
    const std::lock_guard lock(coverageMutex);
    return std::exchange(coverage, {});
}

void NanScan::note(const Buffer& made)
{
    noteName(&Coverage::made, made.what());
}

void NanScan::note(const GpuImage& made)
{
    if (layoutOf(made.desc().format).wordsAPixel > 0) noteName(&Coverage::made, made.what());
}

void NanScan::dispatch(VkCommandBuffer cmd, VkDeviceAddress words, uint32_t count, uint32_t before, const Words& how)
{
    const VkDeviceAddress found = places.address() + (scans.size() - 1) * sizeof(uint32_t);
    pipeline.bind(cmd);
    pipeline.push(cmd, gpu::NanScanPush{words, found, count, before, how.kind, how.stride, how.mask, 0});
    gpu.vk.CmdDispatch(cmd, std::min((count + 63) / 64, kGroups), 1, 1);
    everythingBefore(gpu, cmd);
}

void NanScan::buffer(VkCommandBuffer cmd, const char* pass, const Buffer& buffer, const Words& words)
{
    const VkDeviceSize count = words.count > 0 ? words.count : buffer.size() / 4 - words.first;
    if (!takeSlot({pass, buffer.what(), 0, 0, 0, 0})) return;
    everythingBefore(gpu, cmd);
    dispatch(cmd, buffer.address() + 4 * words.first, uint32_t(count), uint32_t(words.first), words);
}

void NanScan::image(VkCommandBuffer cmd, const char* pass, const GpuImage& image, VkImageLayout layout)
{
    const auto [wordsAPixel, kind] = layoutOf(image.desc().format);
    if (wordsAPixel == 0) return;
    const auto& [width, height, layers] = std::array{image.desc().width, image.desc().height, image.desc().layers};
    if (!takeSlot({pass, image.what(), wordsAPixel, width, height, layers})) return;
    constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    constexpr VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    const VkImageLayout source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    // As wide for the same reason: the writer may be a draw or a pass.
    transition(gpu, cmd, image, {layout, source, all, all, any, any});
    const uint32_t rows = uint32_t(kScratchBytes / 4 / (VkDeviceSize(wordsAPixel) * width));
    for (uint32_t layer = 0; layer < layers; ++layer)
        for (uint32_t y = 0; y < height; y += rows)
        {
            const uint32_t high = std::min(rows, height - y);
            VkBufferImageCopy copy{};
            copy.imageSubresource = {image.aspect(), 0, layer, 1};
            copy.imageOffset = {0, int32_t(y), 0};
            copy.imageExtent = {width, high, 1};
            gpu.vk.CmdCopyImageToBuffer(cmd, image.handle(), source, scratch.handle(), 1, &copy);
            everythingBefore(gpu, cmd);
            Words words;
            words.kind = kind;
            dispatch(cmd, scratch.address(), wordsAPixel * width * high, wordsAPixel * width * (layer * height + y), words);
        }
    // Back to what the frame's own barriers and descriptors take it to be in.
    transition(gpu, cmd, image, {source, layout, all, all, any, any});
}

Status NanScan::findings()
{
    std::string first;
    const auto* place = reinterpret_cast<const uint32_t*>(places.mapped());
    for (size_t i = 0; i < scans.size() && first.empty(); ++i)
    {
        if (place[i] == kNoPlace) continue;
        const Scan& scan = scans[i];
        first = fmt::format("The pass '{}' left a number that is NaN or infinite in '{}', first at ", scan.pass, scan.what);
        if (scan.width == 0)
            first += fmt::format("word {}", place[i]);
        else
        {
            const uint32_t pixel = place[i] / scan.wordsAPixel;
            const uint32_t row = pixel / scan.width;
            first += fmt::format("pixel ({}, {}){}, word {} of it", pixel % scan.width, row % scan.height,
                                 scan.layers > 1 ? fmt::format(" of layer {}", row / scan.height) : "", place[i] % scan.wordsAPixel);
        }
    }
    if (first.empty() && tooMany)
        first = fmt::format("More than {} scans for NaN were recorded since it was last asked what they found; the later ones were left "
                            "out. Ask Device::nanFindings() after each frame, or submit less at once",
                            kScans);
    std::memset(places.mapped(), 0xff, scans.size() * sizeof(uint32_t));
    scans.clear();
    tooMany = false;
    if (first.empty()) return success();
    return Error{ErrorCode::deviceFailure, first};
}

void scanBuffer(Gpu& gpu, VkCommandBuffer cmd, const char* pass, const Buffer& buffer, const NanScan::Words& words)
{
    if (gpu.nanScan()) gpu.nanScan()->buffer(cmd, pass, buffer, words);
}

void scanImage(Gpu& gpu, VkCommandBuffer cmd, const char* pass, const GpuImage& image, VkImageLayout layout)
{
    if (gpu.nanScan()) gpu.nanScan()->image(cmd, pass, image, layout);
}

} // namespace sconce
