#include "svo/pack_octree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::uvec2;
using Texel = std::array<uint16_t, gpu::kRanked>;
using Brick = std::array<Texel, 8>;

bool isLeaf(uvec2 list)
{
    return list.x != gpu::kNoList;
}

ivec3 childOf(ivec3 node, int child)
{
    return 2 * node + ivec3(child & 1, (child >> 1) & 1, child >> 2);
}

/// A leaf's texel: missing ranks repeat the first.
Texel leafTexel(uvec2 list)
{
    Texel texel = {uint16_t(list.x), uint16_t(list.x >> 16), uint16_t(list.y), uint16_t(list.y >> 16)};
    for (uint16_t& probe : texel)
        if (probe == 0xffff) probe = texel[0];
    return texel;
}

class Packer
{
public:
    Packer(const OctreePlan& plan, const LevelLists& lists) : tree(plan.tree), levels(lists), count(plan.build.count) {}

    Octree run()
    {
        const ivec3 cells = tree.topCells, topBricks = (cells + 1) / 2;
        const std::vector<uvec2> fills = topFills();
        bricks.resize(size_t(topBricks.x) * size_t(topBricks.y) * size_t(topBricks.z));
        for (int z = 0; z < cells.z; ++z)
            for (int y = 0; y < cells.y; ++y)
                for (int x = 0; x < cells.x; ++x)
                {
                    const size_t brick = size_t(x >> 1) + size_t(topBricks.x) * (size_t(y >> 1) + size_t(topBricks.y) * size_t(z >> 1));
                    const Texel texel = node({x, y, z}, tree.topShift, fills[topIndex({x, y, z})]);
                    bricks[brick][size_t((x & 1) + 2 * (y & 1) + 4 * (z & 1))] = texel;
                }
        layOut();
        return std::move(tree);
    }

private:
    uvec2 listAt(ivec3 at, int level) const
    {
        const ivec3 size = count >> level;
        return levels[size_t(level)][size_t(at.x) + size_t(size.x) * (size_t(at.y) + size_t(size.y) * size_t(at.z))];
    }

    size_t topIndex(ivec3 cell) const
    {
        return size_t(cell.x) + size_t(tree.topCells.x) * (size_t(cell.y) + size_t(tree.topCells.y) * size_t(cell.z));
    }

    /// The first list below a node, in child order; kNoList when there is none.
    uvec2 anyList(ivec3 at, int level) const
    {
        uvec2 list = listAt(at, level);
        if (isLeaf(list) || list.y == gpu::kNoList) return list;
        for (int child = 0; child < 8; ++child)
        {
            list = anyList(childOf(at, child), level - 1);
            if (isLeaf(list)) break;
        }
        return list;
    }

    /// For every top cell a list for what in it has none: its own, or breadth first that of a nearest cell.
    std::vector<uvec2> topFills() const
    {
        const ivec3 cells = tree.topCells;
        std::vector<uvec2> fills(size_t(cells.x) * size_t(cells.y) * size_t(cells.z));
        std::vector<ivec3> frontier;
        for (int z = 0; z < cells.z; ++z)
            for (int y = 0; y < cells.y; ++y)
                for (int x = 0; x < cells.x; ++x)
                {
                    uvec2& fill = fills[topIndex({x, y, z})];
                    fill = anyList({x, y, z}, tree.topShift);
                    if (isLeaf(fill)) frontier.emplace_back(x, y, z);
                }
        if (frontier.empty()) fills.assign(fills.size(), uvec2(0)); // no probe sees any voxel: all ask the first probe
        while (!frontier.empty())
        {
            std::vector<ivec3> next;
            for (ivec3 cell : frontier)
                for (int side = 0; side < 6; ++side)
                {
                    ivec3 n = cell;
                    n[side >> 1] += (side & 1) ? 1 : -1;
                    if (n[side >> 1] < 0 || n[side >> 1] >= cells[side >> 1] || isLeaf(fills[topIndex(n)])) continue;
                    fills[topIndex(n)] = fills[topIndex(cell)];
                    next.push_back(n);
                }
            frontier = std::move(next);
        }
        return fills;
    }

    Texel node(ivec3 at, int level, uvec2 fill)
    {
        const uvec2 list = listAt(at, level);
        if (isLeaf(list) || list.y == gpu::kNoList)
        {
            ++tree.leaves;
            return leafTexel(isLeaf(list) ? list : fill);
        }
        ++tree.nodes;
        for (int child = 7; child >= 0; --child)
            if (const uvec2 sibling = listAt(childOf(at, child), level - 1); isLeaf(sibling)) fill = sibling;
        Brick brick;
        for (int child = 0; child < 8; ++child) brick[size_t(child)] = node(childOf(at, child), level - 1, fill);
        const auto [known, added] = numbers.try_emplace(brick, uint32_t(bricks.size()));
        if (added) bricks.push_back(brick);
        const uint32_t number = known->second;
        if (tree.marker == 255) return {uint16_t(number & 255), uint16_t((number >> 8) & 255), uint16_t((number >> 16) & 255), 255};
        return {uint16_t(number & 65535), uint16_t(number >> 16), 0, 65535};
    }

    /// Bricks in order, in a nearly cubic box: its last layer is what it wastes.
    void layOut()
    {
        const uint32_t used = uint32_t(bricks.size());
        const uint32_t side = std::max(1u, uint32_t(std::cbrt(double(used))));
        const uint32_t rows = (used + side * side - 1) / (side * side);
        tree.bricks = {side, side, rows};
        const glm::uvec3 size = tree.textureSize();
        tree.texels.assign(size_t(4) * size.x * size.y * size.z, 0);
        for (uint32_t b = 0; b < used; ++b)
            for (uint32_t child = 0; child < 8; ++child)
            {
                const uint32_t x = 2 * (b % side) + (child & 1), y = 2 * (b / side % side) + ((child >> 1) & 1),
                               z = 2 * (b / side / side) + (child >> 2);
                std::copy_n(bricks[b][child].begin(), 4, tree.texels.begin() + 4 * ptrdiff_t(x + size.x * (y + size_t(size.y) * z)));
            }
    }

    Octree tree;
    const LevelLists& levels;
    const ivec3 count;
    std::vector<Brick> bricks;
    std::map<Brick, uint32_t> numbers;
};

} // namespace

Octree packOctree(const OctreePlan& plan, const LevelLists& levels)
{
    return Packer(plan, levels).run();
}

} // namespace sconce
