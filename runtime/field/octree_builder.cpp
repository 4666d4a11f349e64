#include "runtime/field/octree_builder.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "runtime/vulkan/pipeline.h"
#include "svo/octree_plan.h"
#include "svo/pack_octree.h"

#include "spirv/octree_collapse_comp.h"
#include "spirv/octree_fill_comp.h"
#include "spirv/octree_rank_comp.h"
#include "spirv/octree_sight_comp.h"
#include "spirv/octree_surfels_comp.h"

namespace sconce
{
namespace
{

using glm::ivec3;

constexpr uint64_t kJudgesASubmit = 1u << 26; // visibility tests: about a second of software Vulkan on two cores at most
constexpr uint32_t kSamplesASubmit = 1u << 21, kBlocksASubmit = 1u << 15;

class Builder
{
public:
    Builder(Gpu& device, const OctreePlan& made) : gpu(device), plan(made) {}

    Status create(const ProbeMaps& maps)
    {
        const ShaderConstant without[] = {{gpu::kWithSurfelsId, VK_FALSE}};
        for (const auto& [pipeline, code, constants] :
             {std::tuple<Pipeline*, Spirv, std::span<const ShaderConstant>>{&surfelPass, octree_surfels_comp, {}},
              {&sightPass, octree_sight_comp, {}},
              {&rankPass, octree_rank_comp, {}},
              {&openRankPass, octree_rank_comp, without},
              {&fillPass, octree_fill_comp, {}},
              {&collapsePass, octree_collapse_comp, {}}})
        {
            auto compiled = Pipeline::compute(gpu, code, {}, sizeof(gpu::OctreePush), constants);
            if (!compiled) return compiled.error();
            *pipeline = std::move(*compiled);
        }
        auto uploaded = gpu.makeBufferWith(maps.distance, 0, "The octree's maps");
        if (!uploaded) return uploaded.error();
        distance = std::move(*uploaded);
        uploaded = gpu.makeBufferWith(maps.probes, 0, "The octree's probes");
        if (!uploaded) return uploaded.error();
        probes = std::move(*uploaded);
        uploaded = gpu.makeBufferWith<glm::uvec2>(plan.candidates, 0, "The octree's candidates");
        if (!uploaded) return uploaded.error();
        candidates = std::move(*uploaded);
        const gpu::OctreeInputs values[] = {{plan.build, distance.address(), probes.address(), candidates.address()}};
        uploaded = gpu.makeBufferWith<gpu::OctreeInputs>(values, 0, "The octree's settings");
        if (!uploaded) return uploaded.error();
        inputs = std::move(*uploaded);
        auto made =
            gpu.makeBuffer(plan.voxels() * gpu::kSurfelSlots * sizeof(uint32_t), 0, MemoryUse::device, "The octree's surface samples");
        if (!made) return made.error();
        surfels = std::move(*made);
        made = gpu.makeBuffer(blockCount() * sizeof(uint32_t), 0, MemoryUse::device, "The octree's blocks with surfaces");
        if (!made) return made.error();
        blocks = std::move(*made);
        const size_t words = std::min<size_t>(blockCount(), kBlocksASubmit) * (plan.build.candidates + 1);
        made = gpu.makeBuffer(words * sizeof(uint32_t), 0, MemoryUse::device, "What the octree's blocks may ask");
        if (!made) return made.error();
        sights = std::move(*made);
        for (Buffer& list : lists)
        {
            made = gpu.makeBuffer(plan.voxels() * sizeof(glm::uvec2), 0, MemoryUse::device, "The octree's lists");
            if (!made) return made.error();
            list = std::move(*made);
        }
        return success();
    }

    Status collectSurfels()
    {
        auto status = gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                gpu.vk.CmdFillBuffer(cmd, surfels.handle(), 0, VK_WHOLE_SIZE, gpu::kNoSurfel);
                gpu.vk.CmdFillBuffer(cmd, blocks.handle(), 0, VK_WHOLE_SIZE, 0);
                // The samples enter by atomic minima, which read the fill and write over it, and mark their blocks.
                memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
            });
        for (uint32_t first = 0; status && first < plan.samples; first += kSamplesASubmit)
        {
            const uint32_t count = std::min(kSamplesASubmit, plan.samples - first);
            status = dispatch(surfelPass, first, count, {}, {(count + 63) / 64, 1, 1});
        }
        return status;
    }

    /// Lists of all voxels, into lists[0]: first of the blocks with surfaces, then of the others.
    Status rank(const Progress& progress)
    {
        std::vector<uint32_t> numbers(blockCount());
        std::vector<uint32_t> holds(blockCount());
        if (auto status = gpu.download(blocks, 0, std::as_writable_bytes(std::span(holds))); !status) return status;
        std::iota(numbers.begin(), numbers.end(), 0u);
        const auto open = std::ranges::stable_partition(numbers, [&](uint32_t block) { return holds[block] != 0; }).begin();
        auto uploaded = gpu.makeBufferWith<uint32_t>(numbers, 0, "The octree's blocks");
        if (!uploaded) return uploaded.error();
        blocks = std::move(*uploaded);
        const auto dense = uint32_t(open - numbers.begin());
        if (auto status = rankBlocks(rankPass, 0, dense, gpu::kFreeSamples + gpu::kSurfelSlots, progress); !status) return status;
        return rankBlocks(openRankPass, dense, uint32_t(numbers.size()), gpu::kFreeSamples, progress);
    }

    /// Spreads lists into what has none, then joins them level by level.
    Result<LevelLists> collapse()
    {
        LevelLists levels(size_t(plan.tree.topShift) + 1);
        for (int step = 0; step < kFillSteps; ++step)
            if (auto status = dispatchNodes(fillPass, plan.build.count); !status) return status.error();
        for (size_t level = 0; level < levels.size(); ++level)
        {
            const ivec3 size = plan.build.count >> int(level);
            if (level > 0)
                if (auto status = dispatchNodes(collapsePass, size); !status) return status.error();
            levels[level].resize(size_t(size.x) * size_t(size.y) * size_t(size.z));
            if (auto status = gpu.download(lists[0], 0, std::as_writable_bytes(std::span(levels[level]))); !status) return status.error();
        }
        return levels;
    }

private:
    size_t blockCount() const
    {
        const ivec3 count = (plan.build.count + gpu::kBlock - 1) / gpu::kBlock;
        return size_t(count.x) * size_t(count.y) * size_t(count.z);
    }

    /// @param points  that are judged in a voxel, at most
    Status rankBlocks(const Pipeline& pass, uint32_t first, uint32_t end, uint32_t points, const Progress& progress)
    {
        // A submit must end soon: drivers stop one that hangs, and progress and cancellation come between submits.
        const uint64_t judgesABlock = uint64_t(gpu::kBlock * gpu::kBlock * gpu::kBlock) * plan.build.candidates * points;
        const uint32_t together = uint32_t(std::clamp<uint64_t>(kJudgesASubmit / judgesABlock, 1, kBlocksASubmit));
        for (; first < end; first += together)
        {
            if (!report(progress, "octree", double(first) / double(blockCount())))
                return Error{ErrorCode::cancelled, "cancelled while building the octree"};
            const uint32_t count = std::min(together, end - first);
            const auto status = gpu.submit(
                [&](VkCommandBuffer cmd)
                {
                    record(cmd, sightPass, first, count, {}, {(count + 63) / 64, 1, 1});
                    record(cmd, pass, first, count, {}, {count, 1, 1});
                });
            if (!status) return status;
        }
        return success();
    }

    Status dispatch(const Pipeline& pipeline, uint32_t first, uint32_t count, ivec3 size, glm::uvec3 groups)
    {
        return gpu.submit([&](VkCommandBuffer cmd) { record(cmd, pipeline, first, count, size, groups); });
    }

    void record(VkCommandBuffer cmd, const Pipeline& pipeline, uint32_t first, uint32_t count, ivec3 size, glm::uvec3 groups)
    {
        // What an earlier submit wrote is visible: its fence was waited for, and only device memory access is left to order.
        // From all commands: that was an upload's copy, the fill or another pass.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        pipeline.bind(cmd);
        pipeline.push(cmd, gpu::OctreePush{inputs.address(), surfels.address(), lists[1].address(), lists[0].address(), blocks.address(),
                                           sights.address(), first, count, size, 0});
        gpu.vk.CmdDispatch(cmd, groups.x, groups.y, groups.z);
    }

    /// A pass from lists[0] to lists[1], which change names: the result is lists[0] again.
    Status dispatchNodes(const Pipeline& pipeline, ivec3 size)
    {
        std::swap(lists[0], lists[1]);
        return dispatch(pipeline, 0, 0, size, glm::uvec3((size + 3) / 4));
    }

    Gpu& gpu;
    const OctreePlan& plan;
    Pipeline surfelPass, sightPass, rankPass, openRankPass, fillPass, collapsePass;
    Buffer distance, probes, candidates, inputs, surfels, blocks, sights;
    Buffer lists[2]; // read: [1], written: [0]
};

} // namespace

Result<Octree> buildOctreeOnDevice(Gpu& gpu, const ProbeMaps& maps, const OctreeSettings& settings, const Progress& progress)
{
    auto plan = planOctree(maps, settings);
    if (!plan) return plan.error();
    Builder builder(gpu, *plan);
    if (auto status = builder.create(maps); !status) return status.error();
    if (auto status = builder.collectSurfels(); !status) return status.error();
    if (auto status = builder.rank(progress); !status) return status.error();
    auto levels = builder.collapse();
    if (!levels) return levels.error();
    Octree tree = packOctree(*plan, *levels);
    report(progress, "octree", 1.0);
    return tree;
}

} // namespace sconce
