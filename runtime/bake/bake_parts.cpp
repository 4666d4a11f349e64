#include "runtime/bake/bake_parts.h"

#include <algorithm>

namespace sconce
{
namespace
{

/// An octree but for its texels.
struct IndexHead
{
    glm::vec3 boundsLow, boundsHigh;
    float voxel;
    glm::ivec3 topCells;
    int32_t topShift;
    glm::uvec3 bricks;
    uint32_t marker, leaves, nodes, onDevice;
};
static_assert(sizeof(IndexHead) == 18 * 4, "no padding: it is stored as it is");

size_t texelCount(glm::uvec3 bricks)
{
    const glm::u64vec3 size = uint64_t(2) * glm::u64vec3(bricks);
    return 4 * size.x * size.y * size.z;
}

} // namespace

bool BakeParts::take(BakeStage stage, uint32_t index, std::initializer_list<std::span<std::byte>> arrays) const
{
    if (!journal) return false;
    const auto found = journal->find({bake, stage, index});
    size_t wanted = 0;
    for (const auto array : arrays) wanted += array.size();
    if (!found || found->size() != wanted) return false;
    auto from = found->begin();
    for (const auto array : arrays)
    {
        std::copy_n(from, array.size(), array.begin());
        from += std::ptrdiff_t(array.size());
    }
    return true;
}

Status BakeParts::keep(BakeStage stage, uint32_t index, std::initializer_list<std::span<const std::byte>> arrays) const
{
    if (!journal) return success();
    return journal->keep({bake, stage, index}, std::span(arrays.begin(), arrays.size()));
}

std::optional<BakeParts::Index> BakeParts::takeIndex(std::span<gpu::ProbeHeader> probes) const
{
    if (!journal) return std::nullopt;
    const auto found = journal->find({bake, BakeStage::octree, 0});
    if (!found || found->size() < sizeof(IndexHead) + probes.size_bytes()) return std::nullopt;
    IndexHead head;
    std::copy_n(found->begin(), sizeof head, std::as_writable_bytes(std::span(&head, 1)).begin());
    Index index{
        {head.boundsLow, head.boundsHigh, head.voxel, head.topCells, head.topShift, head.bricks, head.marker, {}, head.leaves, head.nodes},
        head.onDevice != 0};
    const size_t rest = found->size() - sizeof head - probes.size_bytes();
    if (rest != texelCount(head.bricks) * sizeof(uint16_t)) return std::nullopt;
    index.octree.texels.resize(rest / sizeof(uint16_t));
    const auto texels = found->begin() + std::ptrdiff_t(sizeof head);
    std::copy_n(texels, rest, asWritableBytes(index.octree.texels).begin());
    std::copy_n(texels + std::ptrdiff_t(rest), probes.size_bytes(), asWritableBytes(probes).begin());
    return index;
}

Status BakeParts::keepIndex(const Octree& octree, bool onDevice, std::span<const gpu::ProbeHeader> probes) const
{
    const IndexHead head{octree.boundsLow, octree.boundsHigh, octree.voxel,  octree.topCells, octree.topShift,
                         octree.bricks,    octree.marker,     octree.leaves, octree.nodes,    onDevice ? 1u : 0u};
    return keep(BakeStage::octree, 0, {asBytes(std::span(&head, 1)), asBytes(octree.texels), asBytes(probes)});
}

std::optional<TriangleGather::Cells> BakeParts::takeCells(size_t cells, uint32_t rays) const
{
    TriangleGather::Cells found{std::vector<uint32_t>(cells), std::vector<uint32_t>(6 * cells * rays), std::vector<vec3>(6 * cells)};
    const bool taken =
        take(BakeStage::cells, 0, {asWritableBytes(found.places), asWritableBytes(found.links), asWritableBytes(found.straight)});
    return taken ? std::optional(std::move(found)) : std::nullopt;
}

Status BakeParts::keepCells(const TriangleGather::Cells& cells) const
{
    return keep(BakeStage::cells, 0, {asBytes(cells.places), asBytes(cells.links), asBytes(cells.straight)});
}

} // namespace sconce
