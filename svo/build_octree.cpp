#include "svo/build_octree.h"

#include <atomic>

#include "base/parallel.h"
#include "svo/octree_plan.h"
#include "svo/pack_octree.h"

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::uvec2;

namespace rank_text
{
using namespace glm;
/// The shaders' own text on the CPU.
struct Text
{
    using real = float;
    using uint = uint32_t;
    using vec2f = glm::vec2;
    static constexpr uint kNoSurfel = gpu::kNoSurfel;
    static constexpr uint kNoList = gpu::kNoList;
    static constexpr uint kSurfelSlots = gpu::kSurfelSlots;
    static constexpr uint kSeesAll = gpu::kSeesAll;
    static constexpr int kRanked = gpu::kRanked;
    static constexpr int kBlock = gpu::kBlock;
    static constexpr int kFreeSamples = gpu::kFreeSamples;

    const gpu::OctreeBuild& build;
    const ProbeMaps& maps;
    const OctreePlan& plan;
    const std::vector<uint32_t>& surfels;
    const std::vector<uvec2>& from;
    std::vector<uvec2> kept = {}; // candidates of the block

    uint distanceWord(uint index) const { return maps.distance[index]; }
    vec3 probeCentre(uint probe) const { return maps.probes[probe].centre; }
    bool holdsSurfels() const { return true; }
    uint candidateCount() const { return uint(kept.size()); }
    uvec2 candidateOf(uint i) const { return kept[i]; }
    uint surfelKey(uint slot) const { return surfels[slot]; }
    uvec2 listOf(ivec3 node, ivec3 size) const
    {
        return from[size_t(node.x) + size_t(size.x) * (size_t(node.y) + size_t(size.y) * size_t(node.z))];
    }

#include "shaders/shared/pure_text.h"

#include "shaders/shared/octree_rank.h"
};
} // namespace rank_text
using rank_text::Text;

void collectSurfels(const ProbeMaps& maps, const OctreePlan& plan, std::vector<uint32_t>& surfels)
{
    constexpr uint32_t kBatch = 4096;
    parallelFor((plan.samples + kBatch - 1) / kBatch,
                [&](size_t batch)
                {
                    Text text{plan.build, maps, plan, surfels, {}};
                    const uint32_t first = uint32_t(batch) * kBatch;
                    for (uint32_t number = first; number < std::min(first + kBatch, plan.samples); ++number)
                    {
                        glm::vec3 position, normal;
                        if (!text.surfelOf(number, position, normal)) continue;
                        const uint32_t slot = text.surfelSlot(position, normal);
                        if (slot == gpu::kNoSurfel) continue;
                        const uint32_t key = number * Text::kKeyFactor;
                        std::atomic_ref<uint32_t> kept(surfels[slot]);
                        for (uint32_t held = kept.load(); key < held && !kept.compare_exchange_weak(held, key);)
                        {
                        }
                    }
                });
}

/// Lists of a block's voxels, after culling its candidates together.
void rankBlock(Text& text, ivec3 block, std::vector<uvec2>& lists)
{
    const gpu::OctreeBuild& build = text.build;
    const size_t first = size_t(text.regionOf(gpu::kBlock * block)) * build.candidates;
    text.kept.clear();
    for (size_t i = first; i < first + build.candidates; ++i)
    {
        const glm::uvec2 candidate = text.plan.candidates[i];
        const int sight = text.sightOf(candidate.x, block);
        if (sight != Text::kSightNone) text.kept.push_back(candidate | uvec2(sight == Text::kSightAll ? Text::kSeesAll : 0u, 0u));
    }
    const ivec3 low = gpu::kBlock * block, high = glm::min(low + gpu::kBlock, ivec3(build.count));
    for (int z = low.z; z < high.z; ++z)
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                lists[size_t(x) + size_t(build.count.x) * (size_t(y) + size_t(build.count.y) * size_t(z))] = text.rankVoxel({x, y, z});
}

ivec3 nodeAt(size_t index, ivec3 size)
{
    return {int(index % size_t(size.x)), int(index / size_t(size.x) % size_t(size.y)), int(index / size_t(size.x) / size_t(size.y))};
}

/// Calls make(text, voxel) for all nodes of a level, row by row.
template <class Make> std::vector<uvec2> makeLevel(Text text, ivec3 size, const Make& make)
{
    std::vector<uvec2> made(size_t(size.x) * size_t(size.y) * size_t(size.z));
    parallelFor(size_t(size.y) * size_t(size.z),
                [&](size_t row)
                {
                    Text own = text;
                    for (size_t i = row * size_t(size.x); i < (row + 1) * size_t(size.x); ++i) made[i] = make(own, nodeAt(i, size));
                });
    return made;
}

} // namespace

Result<Octree> buildOctree(const ProbeMaps& maps, const OctreeSettings& settings, const Progress& progress)
{
    auto plan = planOctree(maps, settings);
    if (!plan) return plan.error();
    const Error cancelled{ErrorCode::cancelled, "cancelled while building the octree"};
    if (!report(progress, "octree", 0.0)) return cancelled;
    std::vector<uint32_t> surfels(plan->voxels() * gpu::kSurfelSlots, gpu::kNoSurfel);
    collectSurfels(maps, *plan, surfels);

    const ivec3 count = plan->build.count;
    std::vector<uvec2> lists(plan->voxels());
    const std::vector<uvec2> none;
    const ivec3 blocks = (count + gpu::kBlock - 1) / gpu::kBlock;
    for (int z = 0; z < blocks.z; ++z)
    {
        if (!report(progress, "octree", double(z) / blocks.z)) return cancelled;
        parallelFor(size_t(blocks.x) * size_t(blocks.y),
                    [&](size_t i)
                    {
                        Text text{plan->build, maps, *plan, surfels, none};
                        rankBlock(text, {int(i % size_t(blocks.x)), int(i / size_t(blocks.x)), z}, lists);
                    });
    }
    for (int step = 0; step < kFillSteps; ++step)
        lists = makeLevel({plan->build, maps, *plan, surfels, lists}, count,
                          [&](Text& text, ivec3 voxel) { return text.filledList(voxel, count); });
    LevelLists levels(size_t(plan->tree.topShift) + 1);
    levels[0] = std::move(lists);
    for (size_t level = 1; level < levels.size(); ++level)
    {
        const ivec3 size = count >> int(level);
        levels[level] = makeLevel({plan->build, maps, *plan, surfels, levels[level - 1]}, size,
                                  [&](Text& text, ivec3 node) { return text.joinedList(node, size); });
    }
    Octree tree = packOctree(*plan, levels);
    report(progress, "octree", 1.0);
    return tree;
}

} // namespace sconce
