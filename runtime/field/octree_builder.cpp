#include "runtime/field/octree_builder.h"

#include <algorithm>
#include <utility>

#include "runtime/vulkan/pipeline.h"
#include "svo/octree_plan.h"
#include "svo/pack_octree.h"

#include "spirv/octree_collapse_comp.h"
#include "spirv/octree_fill_comp.h"
#include "spirv/octree_rank_comp.h"
#include "spirv/octree_surfels_comp.h"

namespace sconce
{
namespace
{

using glm::ivec3;

constexpr uint64_t kJudgesASubmit = 1u << 26; // visibility tests: about a second of software Vulkan on two cores at most
constexpr uint32_t kSamplesASubmit = 1u << 21;

class Builder
{
public:
    Builder(Gpu& device, const OctreePlan& made) : gpu(device), plan(made) {}

    Status create(const ProbeMaps& maps)
    {
        for (const auto& [pipeline, code] : {std::pair<Pipeline*, Spirv>{&surfelPass, octree_surfels_comp},
                                             {&rankPass, octree_rank_comp},
                                             {&fillPass, octree_fill_comp},
                                             {&collapsePass, octree_collapse_comp}})
        {
            auto compiled = Pipeline::compute(gpu, code, {}, sizeof(gpu::OctreePush));
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
                // The samples enter by atomic minima, which read the fill and write over it.
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

    /// Lists of all voxels, into lists[0].
    Status rank(const Progress& progress)
    {
        const ivec3 blocks = (plan.build.count + gpu::kBlock - 1) / gpu::kBlock;
        const uint32_t count = uint32_t(blocks.x) * uint32_t(blocks.y) * uint32_t(blocks.z);
        // A submit must end soon: drivers stop one that hangs, and progress and cancellation come between submits.
        const uint64_t judgesABlock = 64ull * plan.build.candidates * 25;
        const uint32_t together = uint32_t(std::clamp<uint64_t>(kJudgesASubmit / judgesABlock, 1, 32768));
        for (uint32_t first = 0; first < count; first += together)
        {
            if (!report(progress, "octree", double(first) / count))
                return Error{ErrorCode::cancelled, "cancelled while building the octree"};
            if (auto status = dispatch(rankPass, first, 0, {}, {std::min(together, count - first), 1, 1}); !status) return status;
        }
        return success();
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
    Status dispatch(const Pipeline& pipeline, uint32_t first, uint32_t count, ivec3 size, glm::uvec3 groups)
    {
        return gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                // What an earlier submit wrote is visible: its fence was waited for, and only device memory access is left to order.
                // From all commands: that was an upload's copy, the fill or another pass.
                memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
                pipeline.bind(cmd);
                pipeline.push(cmd, gpu::OctreePush{inputs.address(), surfels.address(), lists[1].address(), lists[0].address(), first,
                                                   count, size, 0});
                gpu.vk.CmdDispatch(cmd, groups.x, groups.y, groups.z);
            });
    }

    /// A pass from lists[0] to lists[1], which change names: the result is lists[0] again.
    Status dispatchNodes(const Pipeline& pipeline, ivec3 size)
    {
        std::swap(lists[0], lists[1]);
        return dispatch(pipeline, 0, 0, size, glm::uvec3((size + 3) / 4));
    }

    Gpu& gpu;
    const OctreePlan& plan;
    Pipeline surfelPass, rankPass, fillPass, collapsePass;
    Buffer distance, probes, candidates, inputs, surfels;
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
