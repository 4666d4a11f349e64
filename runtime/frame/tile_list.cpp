#include "runtime/frame/tile_list.h"

#include <cassert>

#include <fmt/format.h>

#include "spirv/classify_tiles_comp.h"

namespace sconce
{
namespace
{

constexpr uint32_t kRuns = 2 * gpu::kTermCount + gpu::kMostLookUpLists; // of passes, of sparse passes, of look-ups

} // namespace

Result<TileList> TileList::create(Gpu& gpu, const Buffer& frame, const Desc& desc)
{
    assert(desc.lookUps.size() <= gpu::kMostLookUpLists);
    TileList made;
    made.gpu = &gpu;
    made.desc = desc;
    made.across = (desc.width + gpu::kTileSide - 1) / gpu::kTileSide;
    made.down = (desc.height + gpu::kTileSide - 1) / gpu::kTileSide;
    const VkDeviceSize words = VkDeviceSize(gpu::kTermCount + gpu::kTileSide + 64 * desc.lookUps.size()) * made.across * made.down;
    const VkDeviceSize bytes = kRuns * sizeof(gpu::TileRuns) + 4 * words;
    if (bytes > gpu.properties.limits.maxStorageBufferRange)
        return Error{
            ErrorCode::badArgument,
            fmt::format("what a frame of {} x {} pixels looks up takes {} bytes, and {} reads at most {} of a buffer; draw it in parts or "
                        "smaller",
                        desc.width, desc.height, bytes, gpu.properties.deviceName, gpu.properties.limits.maxStorageBufferRange)};
    auto lists = gpu.makeBuffer(bytes, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, MemoryUse::device, "tile lists");
    if (!lists) return lists.error();
    made.lists = std::move(*lists);
    auto packed = makeLightImage(gpu, VK_FORMAT_R32G32_UINT, desc.width, desc.height, "packed pixels");
    if (!packed) return packed.error();
    made.packed = std::move(*packed);
    const DescriptorSet::Binding bindings[] = {{gpu::kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                               {gpu::kPackedBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    auto set = makeFrameSet(gpu, frame, bindings);
    if (!set) return set.error();
    made.set = std::move(*set);
    made.set.write(gpu::kTileBinding, made.lists);
    made.set.write(gpu::kPackedBinding, made.packed.view(), VK_IMAGE_LAYOUT_GENERAL);
    const VkDescriptorSetLayout layouts[] = {made.set.layout(), made.set.layout()}; // set 0 is not used
    std::vector<ShaderConstant> constants = {{gpu::kEveryLogId, desc.everyLog}, made.constant()};
    for (uint32_t list = 0; list < desc.lookUps.size(); ++list)
    {
        constants.push_back({gpu::kLookUpTermsId + list, desc.lookUps[list].terms});
        constants.push_back({gpu::kLookUpKindId + list, desc.lookUps[list].kind});
    }
    auto pipeline = Pipeline::compute(gpu, classify_tiles_comp, layouts, 0, constants);
    if (!pipeline) return pipeline.error();
    made.pipeline = std::move(*pipeline);
    return made;
}

void TileList::clear(VkCommandBuffer cmd) const
{
    gpu::TileRuns none[kRuns];
    for (gpu::TileRuns& runs : none) runs = {gpu::kTileRow, 0, 1, 0};
    gpu->vk.CmdUpdateBuffer(cmd, lists.handle(), 0, sizeof none, none);
}

void TileList::record(VkCommandBuffer cmd) const
{
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, indirect = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
    const VkDescriptorSet sets[] = {set.handle(), set.handle()};
    pipeline.bind(cmd, sets);
    gpu->vk.CmdDispatch(cmd, across, down, 1);
    // Read after write, in two ways: as sizes of dispatches (indirect) and by the passes themselves (compute); for every pass of the frame,
    // so that they need no barrier for the lists.
    memoryBarrier(*gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, compute | indirect,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
}

void TileList::dispatch(VkCommandBuffer cmd, uint32_t list, uint32_t everyLog) const
{
    if (desc.tiled)
        gpu->vk.CmdDispatchIndirect(cmd, lists.handle(), (list + (everyLog > 0 ? gpu::kTermCount : 0)) * sizeof(gpu::TileRuns));
    else
        gpu->vk.CmdDispatch(cmd, across, ((down - 1) >> everyLog) + 1, 1);
}

void TileList::dispatchLookUps(VkCommandBuffer cmd, uint32_t list) const
{
    gpu->vk.CmdDispatchIndirect(cmd, lists.handle(), (2 * gpu::kTermCount + list) * sizeof(gpu::TileRuns));
}

} // namespace sconce
