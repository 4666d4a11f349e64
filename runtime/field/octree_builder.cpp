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

constexpr uint32_t kSamplesAUnit = 1u << 14, kSamplesADispatch = 1u << 21, kBlocksADispatch = 1u << 15; // of work; at most

class Builder
{
public:
    Builder(Gpu& device, const OctreePlan& made, PacedWork& paced) : gpu(device), plan(made), work(paced) {}

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
            auto compiled = Pipeline::compute(gpu, code, {}, sizeof(gpu::OctreePush), constants, VK_PIPELINE_CREATE_DISPATCH_BASE_BIT);
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
        const size_t words = std::min<size_t>(blockCount(), kBlocksADispatch) * (plan.build.candidates + 1);
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
        if (!status) return status;
        for (uint32_t start = 0; start < plan.samples; start += kSamplesADispatch)
        {
            const uint32_t some = std::min(kSamplesADispatch, plan.samples - start);
            work.add("octree surfels", (some + kSamplesAUnit - 1) / kSamplesAUnit,
                     [=, this](VkCommandBuffer cmd, uint32_t first, uint32_t count)
                     {
                         const uint32_t samples = std::min(kSamplesAUnit * count, some - kSamplesAUnit * first);
                         record(cmd, surfelPass, start + kSamplesAUnit * first, samples, {}, {(samples + 63) / 64, 1, 1});
                     });
        }
        return work.run();
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
        if (auto status = rankBlocks(rankPass, "octree of surfaces", 0, dense, progress); !status) return status;
        return rankBlocks(openRankPass, "octree of the open", dense, uint32_t(numbers.size()), progress);
    }

    /// Spreads lists into what has none, then joins them level by level.
    Result<LevelLists> collapse()
    {
        LevelLists levels(size_t(plan.tree.topShift) + 1);
        for (int step = 0; step < kFillSteps; ++step)
            if (auto status = dispatchNodes(fillPass, "octree fill", plan.build.count); !status) return status.error();
        for (size_t level = 0; level < levels.size(); ++level)
        {
            const ivec3 size = plan.build.count >> int(level);
            if (level > 0)
                if (auto status = dispatchNodes(collapsePass, "octree collapse", size); !status) return status.error();
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

    Status rankBlocks(const Pipeline& pass, const char* name, uint32_t first, uint32_t end, const Progress& progress)
    {
        // As many as the room for what they ask takes; how many of them at once is the pace's choice.
        for (; first < end; first += kBlocksADispatch)
        {
            const uint32_t some = std::min(kBlocksADispatch, end - first);
            work.add(name, some,
                     [&, first](VkCommandBuffer cmd, uint32_t from, uint32_t count)
                     {
                         record(cmd, sightPass, first + from, count, {}, {(count + 63) / 64, 1, 1});
                         record(cmd, pass, first + from, count, {}, {count, 1, 1});
                     });
            if (auto status =
                    work.run([&](double done) { return report(progress, "octree", (first + done * some) / double(blockCount())); });
                !status)
                return status;
        }
        return success();
    }

    void prepare(VkCommandBuffer cmd, const Pipeline& pipeline, uint32_t first, uint32_t count, ivec3 size)
    {
        // What an earlier submit wrote is visible: its fence was waited for, and only device memory access is left to order.
        // From all commands: that was an upload's copy, the fill or another pass.
        memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        pipeline.bind(cmd);
        pipeline.push(cmd, gpu::OctreePush{inputs.address(), surfels.address(), lists[1].address(), lists[0].address(), blocks.address(),
                                           sights.address(), first, count, size, 0});
    }
    void record(VkCommandBuffer cmd, const Pipeline& pipeline, uint32_t first, uint32_t count, ivec3 size, glm::uvec3 groups)
    {
        prepare(cmd, pipeline, first, count, size);
        gpu.vk.CmdDispatch(cmd, groups.x, groups.y, groups.z);
    }

    /// A pass from lists[0] to lists[1], which change names: the result is lists[0] again.
    Status dispatchNodes(const Pipeline& pipeline, const char* name, ivec3 size)
    {
        std::swap(lists[0], lists[1]);
        const glm::uvec3 groups((size + 3) / 4);
        work.add(name, groups.y * groups.z,
                 [&, size](VkCommandBuffer cmd, uint32_t first, uint32_t count)
                 {
                     prepare(cmd, pipeline, 0, 0, size);
                     dispatchRows(gpu, cmd, groups, first, count);
                 });
        return work.run();
    }

    Gpu& gpu;
    const OctreePlan& plan;
    PacedWork& work;
    Pipeline surfelPass, sightPass, rankPass, openRankPass, fillPass, collapsePass;
    Buffer distance, probes, candidates, inputs, surfels, blocks, sights;
    Buffer lists[2]; // read: [1], written: [0]
};

} // namespace

Result<Octree> buildOctreeOnDevice(Gpu& gpu, PacedWork& work, const ProbeMaps& maps, const OctreeSettings& settings,
                                   const Progress& progress)
{
    auto plan = planOctree(maps, settings);
    if (!plan) return plan.error();
    Builder builder(gpu, *plan, work);
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
