#include "svo/build_octree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "svo/parallel.h"

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::vec3;
using Ranks = std::array<uint16_t, gpu::kRanked>;
constexpr uint16_t kNone = 0xffff;
constexpr Ranks kUnseen = {kNone, kNone, kNone, kNone};

namespace maps_text
{
using namespace glm;
struct Text // the shared chart and texel functions, in float
{
    using real = float;
    using uint = uint32_t;
    using vec2f = glm::vec2;
#include "shaders/shared/texel.h"

#include "shaders/shared/chart.h"
};
} // namespace maps_text

/// One probe's map, asked whether it sees a point.
struct ProbeView
{
    const ProbeMaps& maps;
    maps_text::Text text;

    /// Distance of the surfel seen through a texel, along the face's axis: q of its plane at the point's pixel; 0 for sky.
    bool sees(uint32_t probe, vec3 point)
    {
        const vec3 p = point - maps.probes[probe].centre;
        const int face = text.dominantFace(p);
        const vec3 f = text.faceCoordinates(face, p);
        if (!(f.z > 0.0f)) return true; // the centre itself
        const int size = int(maps.info.faceSize);
        const float q = 1.0f / f.z;
        const float x = 0.5f * float(size) * (f.x * q + 1.0f), y = 0.5f * float(size) * (f.y * q + 1.0f);
        const int ix = std::clamp(int(x), 0, size - 1), iy = std::clamp(int(y), 0, size - 1);
        const uint32_t word =
            maps.distance[size_t(probe) * maps.info.wordsPerProbe + size_t(face) * (maps.info.wordsPerProbe / 6) + size_t(iy) * size + ix];
        const float centre = text.halfToReal(word);
        if (centre == 0.0f) return true;
        const float plane = centre * (1.0f + text.unpackGradient(word >> 16) * (x - float(ix) - 0.5f) +
                                      text.unpackGradient(word >> 24) * (y - float(iy) - 0.5f));
        return q >= plane * (1.0f - 1.0f / float(size));
    }
};

/// World box of what the probes see, its outermost share cut off on each side.
void seenBounds(const ProbeMaps& maps, vec3& low, vec3& high)
{
    constexpr size_t kSamples = 24; // a side of a face
    constexpr double kCut = 0.01;
    maps_text::Text text;
    const size_t size = maps.info.faceSize, probes = maps.probes.size();
    std::array<std::vector<float>, 3> seen;
    for (size_t probe = 0; probe < probes; ++probe)
        for (size_t face = 0; face < 6; ++face)
            for (size_t y = 0; y < kSamples; ++y)
                for (size_t x = 0; x < kSamples; ++x)
                {
                    const size_t px = (2 * x + 1) * size / (2 * kSamples), py = (2 * y + 1) * size / (2 * kSamples);
                    const float q = text.halfToReal(
                        maps.distance[probe * maps.info.wordsPerProbe + face * (maps.info.wordsPerProbe / 6) + py * size + px]);
                    if (q == 0.0f) continue;
                    const float u = 2.0f * (float(px) + 0.5f) / float(size) - 1.0f, v = 2.0f * (float(py) + 0.5f) / float(size) - 1.0f;
                    const vec3 point = maps.probes[probe].centre + text.faceDirection(int(face), vec3(u, v, 1.0f) / q);
                    for (int a = 0; a < 3; ++a) seen[a].push_back(point[a]);
                }
    low = high = maps.probes[0].centre;
    for (const gpu::ProbeHeader& probe : maps.probes)
    {
        low = glm::min(low, vec3(probe.centre));
        high = glm::max(high, vec3(probe.centre));
    }
    for (int a = 0; a < 3; ++a)
    {
        if (seen[a].empty()) continue;
        std::sort(seen[a].begin(), seen[a].end());
        const size_t cut = size_t(kCut * double(seen[a].size()));
        low[a] = std::min(low[a], seen[a][cut]);
        high[a] = std::max(high[a], seen[a][seen[a].size() - 1 - cut]);
    }
    const vec3 margin = 0.01f * (high - low) + vec3(1e-3f);
    low = glm::max(low - margin, vec3(maps.info.sceneLow) - vec3(1e-3f));
    high = glm::min(high + margin, vec3(maps.info.sceneHigh) + vec3(1e-3f));
    high = glm::max(high, low + vec3(1e-3f));
}

struct VoxelGrid
{
    ivec3 count{0};
    std::vector<Ranks> ranks;

    size_t index(ivec3 v) const { return size_t(v.x) + size_t(count.x) * (size_t(v.y) + size_t(count.y) * size_t(v.z)); }
};

struct Candidate
{
    uint16_t probe;
    uint32_t seen; // bit per sample point
    float distance;
};

/// The best four of the candidates: each time the one that sees most, what the earlier ones miss counting fourfold, per distance.
Ranks rank(const std::vector<Candidate>& candidates)
{
    Ranks ranks = kUnseen;
    uint32_t covered = 0;
    for (int k = 0; k < gpu::kRanked; ++k)
    {
        float best = 0.0f;
        const Candidate* chosen = nullptr;
        for (const Candidate& c : candidates)
        {
            if (std::find(ranks.begin(), ranks.begin() + k, c.probe) != ranks.begin() + k) continue;
            const float score = float(std::popcount(c.seen) + 4 * std::popcount(c.seen & ~covered)) / c.distance;
            if (score > best) best = score, chosen = &c;
        }
        if (!chosen) break;
        ranks[k] = chosen->probe;
        covered |= chosen->seen;
    }
    return ranks;
}

/// Ranks of all voxels of one top cell. Probes are tried from near to far, and enough fully seeing ones end the search.
void rankCell(const ProbeMaps& maps, const Octree& tree, ivec3 cell, VoxelGrid& grid)
{
    constexpr int kEnough = 12; // probes that see a whole voxel: farther ones can't rank among the first four
    const int side = 1 << tree.topShift;
    ProbeView view{maps, {}};
    const vec3 cellCentre = tree.boundsLow + tree.voxel * (float(side) * (vec3(cell) + 0.5f));
    std::vector<std::pair<float, uint16_t>> order(maps.probes.size());
    // Distances are those of the cell, not of each voxel: voxels that see alike then rank alike, and collapse.
    const float nearest = 0.5f * tree.voxel * float(side);
    for (size_t i = 0; i < order.size(); ++i)
        order[i] = {std::max(glm::distance(cellCentre, vec3(maps.probes[i].centre)), nearest), uint16_t(i)};
    std::sort(order.begin(), order.end());
    std::vector<Candidate> candidates;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
            {
                const ivec3 voxel = side * cell + ivec3(x, y, z);
                const vec3 centre = tree.boundsLow + tree.voxel * (vec3(voxel) + 0.5f);
                candidates.clear();
                int full = 0;
                for (const auto& [distance, probe] : order)
                {
                    uint32_t seen = view.sees(probe, centre) ? 1u : 0u;
                    for (uint32_t corner = 0; corner < 8; ++corner)
                    {
                        const vec3 offset = vec3(corner & 1, (corner >> 1) & 1, corner >> 2) - 0.5f;
                        if (view.sees(probe, centre + 0.75f * tree.voxel * offset)) seen |= 2u << corner;
                    }
                    if (!seen) continue;
                    candidates.push_back({probe, seen, distance});
                    if (std::popcount(seen) == 9 && ++full == kEnough) break;
                }
                grid.ranks[grid.index(voxel)] = rank(candidates);
            }
}

/// Gives each unseen voxel the list of a nearest seen one, breadth first.
void fillUnseen(VoxelGrid& grid)
{
    std::vector<size_t> frontier;
    for (size_t i = 0; i < grid.ranks.size(); ++i)
        if (grid.ranks[i] != kUnseen) frontier.push_back(i);
    while (!frontier.empty())
    {
        std::vector<size_t> next;
        for (size_t i : frontier)
        {
            const ivec3 v(int(i % grid.count.x), int(i / grid.count.x % grid.count.y), int(i / grid.count.x / grid.count.y));
            for (int side = 0; side < 6; ++side)
            {
                ivec3 n = v;
                n[side >> 1] += (side & 1) ? -1 : 1;
                if (n[side >> 1] < 0 || n[side >> 1] >= grid.count[side >> 1]) continue;
                Ranks& ranks = grid.ranks[grid.index(n)];
                if (ranks != kUnseen) continue;
                ranks = grid.ranks[i];
                next.push_back(grid.index(n));
            }
        }
        frontier = std::move(next);
    }
}

/// Writes bricks; a node whose voxels all agree becomes a leaf.
class Packer
{
public:
    Packer(Octree& octree, const VoxelGrid& voxels) : tree(octree), grid(voxels) {}

    void run()
    {
        const ivec3 topBricks = (tree.topCells + 1) / 2;
        bricks.resize(size_t(topBricks.x) * topBricks.y * topBricks.z);
        for (int z = 0; z < tree.topCells.z; ++z)
            for (int y = 0; y < tree.topCells.y; ++y)
                for (int x = 0; x < tree.topCells.x; ++x)
                {
                    const size_t brick = size_t(x >> 1) + size_t(topBricks.x) * ((y >> 1) + size_t(topBricks.y) * (z >> 1));
                    const Ranks texel = node(ivec3(x, y, z) << tree.topShift, tree.topShift);
                    bricks[brick][(x & 1) + 2 * (y & 1) + 4 * (z & 1)] = texel;
                }
        layOut();
    }

private:
    using Brick = std::array<Ranks, 8>;

    static Ranks leafTexel(const Ranks& ranks)
    {
        Ranks texel = ranks;
        for (int k = 1; k < gpu::kRanked; ++k)
            if (texel[k] == kNone) texel[k] = texel[0];
        return texel;
    }

    bool uniform(ivec3 low, int shift) const
    {
        const Ranks& first = grid.ranks[grid.index(low)];
        const int side = 1 << shift;
        for (int z = 0; z < side; ++z)
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x)
                    if (grid.ranks[grid.index(low + ivec3(x, y, z))] != first) return false;
        return true;
    }

    Ranks node(ivec3 low, int shift)
    {
        if (shift == 0 || uniform(low, shift))
        {
            ++tree.leaves;
            return leafTexel(grid.ranks[grid.index(low)]);
        }
        ++tree.nodes;
        const size_t brick = bricks.size();
        bricks.emplace_back();
        for (int child = 0; child < 8; ++child)
        {
            const ivec3 at = low + (ivec3(child & 1, (child >> 1) & 1, child >> 2) << (shift - 1));
            const Ranks texel = node(at, shift - 1);
            bricks[brick][child] = texel;
        }
        if (tree.marker == 255) return {uint16_t(brick & 255), uint16_t((brick >> 8) & 255), uint16_t((brick >> 16) & 255), 255};
        return {uint16_t(brick & 65535), uint16_t(brick >> 16), 0, 65535};
    }

    void layOut()
    {
        const uint32_t count = uint32_t(bricks.size());
        const uint32_t side = std::max(1u, uint32_t(std::ceil(std::cbrt(double(count)))));
        tree.bricks = {side, side, (count + side * side - 1) / (side * side)};
        const glm::uvec3 size = tree.textureSize();
        tree.texels.assign(size_t(4) * size.x * size.y * size.z, 0);
        for (uint32_t b = 0; b < count; ++b)
            for (uint32_t child = 0; child < 8; ++child)
            {
                const uint32_t x = 2 * (b % side) + (child & 1), y = 2 * (b / side % side) + ((child >> 1) & 1),
                               z = 2 * (b / side / side) + (child >> 2);
                std::copy_n(bricks[b][child].begin(), 4, tree.texels.begin() + 4 * ptrdiff_t(x + size.x * (y + size_t(size.y) * z)));
            }
    }

    Octree& tree;
    const VoxelGrid& grid;
    std::vector<Brick> bricks;
};

} // namespace

Result<Octree> buildOctree(const ProbeMaps& maps, const OctreeSettings& settings, const Progress& progress)
{
    if (maps.probes.empty()) return Error{ErrorCode::badArgument, "an octree needs at least one probe; place some first"};
    if (maps.probes.size() > 65535)
        return Error{ErrorCode::badArgument,
                     std::to_string(maps.probes.size()) + " probes are more than the 65535 an octree can index; place fewer"};
    if (settings.voxels < 8 || settings.voxels > 1024 || settings.topShift < 1 || settings.topShift > 6)
        return Error{ErrorCode::badArgument, "octree settings: voxels " + std::to_string(settings.voxels) +
                                                 " must be 8..1024 and topShift " + std::to_string(settings.topShift) + " 1..6"};
    if (maps.info.chart != gpu::kChartCube)
        return Error{ErrorCode::badArgument, "the octree judges visibility by cube-face maps; bake with the cube chart"};

    Octree tree;
    seenBounds(maps, tree.boundsLow, tree.boundsHigh);
    const vec3 size = tree.boundsHigh - tree.boundsLow;
    tree.voxel = std::max({size.x, size.y, size.z}) / float(settings.voxels);
    tree.topShift = settings.topShift;
    tree.topCells = glm::max(ivec3(glm::ceil(size / (tree.voxel * float(1 << tree.topShift)) - 1e-4f)), ivec3(1));
    tree.boundsHigh = tree.boundsLow + tree.voxel * float(1 << tree.topShift) * vec3(tree.topCells);
    tree.marker = maps.probes.size() <= 255 ? 255 : 65535;

    VoxelGrid grid;
    grid.count = tree.topCells << tree.topShift;
    grid.ranks.assign(size_t(grid.count.x) * grid.count.y * grid.count.z, kUnseen);
    const size_t columns = size_t(tree.topCells.x) * tree.topCells.y;
    for (int z = 0; z < tree.topCells.z; ++z)
    {
        if (!report(progress, "octree", double(z) / tree.topCells.z))
            return Error{ErrorCode::cancelled, "cancelled while building the octree"};
        parallelFor(columns, [&](size_t i) { rankCell(maps, tree, ivec3(int(i % tree.topCells.x), int(i / tree.topCells.x), z), grid); });
    }
    fillUnseen(grid);
    if (grid.ranks[0] == kUnseen) // no probe sees any voxel: all ask the first probe
        std::fill(grid.ranks.begin(), grid.ranks.end(), Ranks{0, 0, 0, 0});
    Packer(tree, grid).run();
    report(progress, "octree", 1.0);
    return tree;
}

} // namespace sconce
