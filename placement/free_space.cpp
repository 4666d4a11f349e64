#include "placement/free_space.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/random.h"

namespace sconce
{
namespace
{

constexpr uint32_t kNoRegion = 0xffffffffu;
constexpr size_t kNoCell = ~size_t(0);

/// What the rays from one point meet.
struct Surroundings
{
    float around = 0.0f; // share of the rays between the horizon and 60 degrees up that hit
    float below = 0.0f;  // share of the rays within 45 degrees of straight down that hit
    float all = 0.0f;    // share of all rays that hit
    float backs = 0.0f;  // share of the hits that are on the backs of single-sided surfaces
};

/// Directions evenly spread on the sphere: the Fibonacci lattice.
const std::array<vec3, 96>& sphereDirections()
{
    static const std::array<vec3, 96> directions = []
    {
        std::array<vec3, 96> made;
        for (size_t i = 0; i < made.size(); ++i)
        {
            const double y = 1.0 - 2.0 * (double(i) + 0.5) / double(made.size());
            const double angle = 2.0 * std::numbers::pi * double(i) / std::numbers::phi;
            const double radius = std::sqrt(1.0 - y * y);
            made[i] = vec3(glm::dvec3(radius * std::cos(angle), y, radius * std::sin(angle)));
        }
        return made;
    }();
    return directions;
}

Surroundings lookAround(const Visibility& visibility, vec3 point)
{
    int hits = 0, backs = 0, around = 0, aroundHits = 0, below = 0, belowHits = 0;
    for (const vec3& direction : sphereDirections())
    {
        RayHit hit;
        const bool met = visibility.cast(point, direction, hit);
        const bool isAround = direction.y > 0.0f && direction.y < 0.8660254f;
        const bool isBelow = direction.y < -0.7071068f;
        hits += met;
        backs += met && hit.back;
        around += isAround;
        aroundHits += isAround && met;
        below += isBelow;
        belowHits += isBelow && met;
    }
    return {float(aroundHits) / float(around), float(belowHits) / float(below), float(hits) / float(sphereDirections().size()),
            hits ? float(backs) / float(hits) : 0.0f};
}

/// Rule 3 for one point.
struct Enclosure
{
    float leastAround = kEnclosedShare;
    bool mindBacks = true;

    bool keeps(const Surroundings& seen) const
    {
        return seen.around >= leastAround && seen.below >= kGroundShare && (!mindBacks || seen.backs <= 0.5f);
    }
};

/// The scene's box, raised so that low scenes have air above them.
Bounds fillBox(const Bounds& scene)
{
    Bounds box = scene;
    const vec3 size = scene.size();
    const float across = std::max(size.x, size.z);
    box.high.y += std::clamp(0.25f * size.y, 0.02f * across, 0.1f * across);
    // A scene that is flat along an axis still needs cells there.
    const float least = 1e-3f * std::max({size.x, size.y, size.z});
    for (int axis = 0; axis < 3; ++axis)
        if (box.high[axis] - box.low[axis] < least) box.low[axis] -= 0.5f * least, box.high[axis] += 0.5f * least;
    return box;
}

template <class Visit> void forNeighbours(const DistanceField& field, size_t at, const Visit& visit)
{
    const size_t stride[3] = {1, size_t(field.size.x), size_t(field.size.x) * size_t(field.size.y)};
    const glm::ivec3 cell = field.cell(at);
    for (int axis = 0; axis < 3; ++axis)
    {
        if (cell[axis] > 0) visit(at - stride[axis]);
        if (cell[axis] + 1 < field.size[axis]) visit(at + stride[axis]);
    }
}

/// Visits the cells joined through faces to those given, of those that `enters` lets in, a run of cells along x at a time (Smith 1979,
/// "Tint Fill"); `enters` has to mark what it lets in.
/// @param from  cells that are marked
template <class Enters> void flood(const DistanceField& field, std::span<const uint32_t> from, const Enters& enters)
{
    struct Run
    {
        uint32_t first, count;
    };
    const auto row = uint32_t(field.size.x), layer = row * uint32_t(field.size.y);
    // A cell that was let in, `before` cells after its row's first, with all that follow it and that it follows.
    const auto runOf = [&](uint32_t at, uint32_t before)
    {
        uint32_t first = at, end = at + 1;
        while (at - first < before && enters(first - 1)) --first;
        while (before + (end - at) < row && enters(end)) ++end;
        return Run{first, end - first};
    };
    std::vector<Run> open;
    for (const uint32_t at : from) open.push_back(runOf(at, uint32_t(field.cell(at).x)));
    while (!open.empty())
    {
        const Run run = open.back();
        open.pop_back();
        const glm::ivec3 cell = field.cell(run.first);
        const auto visit = [&](uint32_t beside)
        {
            for (uint32_t at = beside; at < beside + run.count; ++at)
            {
                if (!enters(at)) continue;
                open.push_back(runOf(at, uint32_t(cell.x) + at - beside));
                at = open.back().first + open.back().count; // which was not let in
            }
        };
        if (cell.y > 0) visit(run.first - row);
        if (cell.y + 1 < field.size.y) visit(run.first + row);
        if (cell.z > 0) visit(run.first - layer);
        if (cell.z + 1 < field.size.z) visit(run.first + layer);
    }
}

struct Regions
{
    std::vector<uint32_t> of;   // [cells] region, or kNoRegion where not free
    std::vector<size_t> volume; // [regions] cells
};

/// Free cells joined through faces.
Regions joinFreeCells(const DistanceField& field)
{
    const float blocked = kBlocked * field.voxel;
    Regions regions;
    regions.of.assign(field.cells(), kNoRegion);
    for (size_t first = 0; first < field.cells(); ++first)
    {
        if (regions.of[first] != kNoRegion || field.distance[first] <= blocked) continue;
        const uint32_t region = uint32_t(regions.volume.size());
        size_t volume = 1;
        regions.of[first] = region;
        const auto seed = uint32_t(first);
        flood(field, std::span(&seed, 1),
              [&](size_t at)
              {
                  if (regions.of[at] != kNoRegion || field.distance[at] <= blocked) return false;
                  regions.of[at] = region;
                  ++volume;
                  return true;
              });
        regions.volume.push_back(volume);
    }
    return regions;
}

/// The free cell nearest to a point of those that it sees, for a thin wall has free cells on both sides; of all when it sees none, as from
/// within a surface. Looks at most `reach` cells around it; kNoCell when there is none.
size_t freeCellNear(const DistanceField& field, const Regions& regions, const Visibility& visibility, vec3 point, int reach)
{
    const glm::ivec3 centre = field.cellAt(point);
    std::vector<std::pair<float, size_t>> near; // distance, cell
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x)
            {
                const glm::ivec3 cell = centre + glm::ivec3(x, y, z);
                if (!field.inside(cell) || regions.of[field.index(cell)] == kNoRegion) continue;
                near.emplace_back(glm::distance(field.centre(cell), point), field.index(cell));
            }
    std::ranges::sort(near);
    for (const auto& [distance, cell] : near)
        if (visibility.unoccluded(point, field.centre(field.cell(cell)))) return cell;
    return near.empty() ? kNoCell : near.front().second;
}

/// The free cell a camera stands in. It may stand outside the box, before the missing or culled front wall of what it looks at: then the
/// first free cell on its axis.
size_t cellOfCamera(const DistanceField& field, const Regions& regions, const Visibility& visibility, const Camera& camera)
{
    if (field.inside(field.cellAt(camera.eye)))
        if (const size_t cell = freeCellNear(field, regions, visibility, camera.eye, 2); cell != kNoCell) return cell;
    const float farthest = glm::length(vec3(field.size)) * field.voxel + glm::distance(camera.eye, field.origin);
    const int steps = int(std::min(1e6f, farthest / (0.5f * field.voxel)));
    for (int step = 0; step < steps; ++step)
    {
        const glm::ivec3 cell = field.cellAt(camera.eye + 0.5f * field.voxel * float(step) * camera.forward);
        if (field.inside(cell) && regions.of[field.index(cell)] != kNoRegion) return field.index(cell);
    }
    return kNoCell;
}

/// The region with the most volume that is enclosed: the inside of a building rather than the air around it. Enclosed volume is estimated
/// from 256 random cells of each of the largest regions.
uint32_t mostEnclosedRegion(const DistanceField& field, const Regions& regions, const Visibility& visibility)
{
    constexpr size_t kTried = 12, kSamples = 256;
    std::vector<uint32_t> largest(regions.volume.size());
    for (uint32_t region = 0; region < largest.size(); ++region) largest[region] = region;
    std::stable_sort(largest.begin(), largest.end(), [&](uint32_t a, uint32_t b) { return regions.volume[a] > regions.volume[b]; });
    if (largest.size() > kTried) largest.resize(kTried);
    std::vector<std::vector<uint32_t>> cellsOf(largest.size());
    std::vector<uint32_t> slot(regions.volume.size(), kNoRegion);
    for (uint32_t i = 0; i < largest.size(); ++i) slot[largest[i]] = i;
    for (size_t at = 0; at < field.cells(); ++at)
        if (regions.of[at] != kNoRegion && slot[regions.of[at]] != kNoRegion) cellsOf[slot[regions.of[at]]].push_back(uint32_t(at));

    uint32_t best = kNoRegion;
    double bestScore = -1.0;
    for (size_t i = 0; i < largest.size(); ++i)
    {
        std::vector<float> value(kSamples);
        tbb::parallel_for(size_t(0), kSamples,
                          [&](size_t sample)
                          {
                              Random random(largest[i], sample);
                              const uint32_t at = cellsOf[i][random.below(cellsOf[i].size())];
                              const Surroundings seen = lookAround(visibility, field.centre(field.cell(at)));
                              value[sample] = Enclosure{}.keeps(seen) ? seen.all * (1.0f - seen.backs) : 0.0f;
                          });
        double mean = 0.0;
        for (float one : value) mean += double(one) / double(kSamples);
        // The tiny share of the bare volume ranks regions of scenes where nothing is enclosed.
        const double score = double(cellsOf[i].size()) * (mean + 1e-6);
        if (score > bestScore) bestScore = score, best = largest[i];
    }
    return best;
}

/// The reached cells in pieces: those of a block of cells that are joined within it. A wall through a block parts it, so that the void
/// behind a wall is never judged by the room before it.
struct Pieces
{
    std::vector<uint32_t> of;     // [cells] piece, or kNoRegion where not reached
    std::vector<uint32_t> widest; // [pieces] the cell farthest from surfaces
};

Pieces piecesOf(const FreeSpace& space)
{
    constexpr size_t kBlocks = 24000;
    const DistanceField& field = space.field;
    const size_t reached = size_t(std::count(space.reachable.begin(), space.reachable.end(), uint8_t(1)));
    const int side = std::max(1, int(std::ceil(std::cbrt(double(reached) / double(kBlocks)))));
    const size_t stride[3] = {1, size_t(field.size.x), size_t(field.size.x) * size_t(field.size.y)};
    Pieces pieces;
    pieces.of.assign(field.cells(), kNoRegion);
    std::vector<uint32_t> open;
    for (size_t first = 0; first < field.cells(); ++first)
    {
        if (!space.reachable[first] || pieces.of[first] != kNoRegion) continue;
        const uint32_t piece = uint32_t(pieces.widest.size());
        const glm::ivec3 low = field.cell(first) / side * side, high = glm::min(low + side, field.size);
        uint32_t widest = uint32_t(first);
        pieces.of[first] = piece;
        open.assign(1, uint32_t(first));
        while (!open.empty())
        {
            const size_t at = open.back();
            open.pop_back();
            if (field.distance[at] > field.distance[widest]) widest = uint32_t(at);
            const glm::ivec3 cell = field.cell(at);
            for (int axis = 0; axis < 3; ++axis)
                for (int step = -1; step <= 1; step += 2)
                {
                    if (cell[axis] + step < low[axis] || cell[axis] + step >= high[axis]) continue;
                    const size_t next = step < 0 ? at - stride[axis] : at + stride[axis];
                    if (!space.reachable[next] || pieces.of[next] != kNoRegion) continue;
                    pieces.of[next] = piece;
                    open.push_back(uint32_t(next));
                }
        }
        pieces.widest.push_back(widest);
    }
    return pieces;
}

/// Rule 3: keeps what is enclosed of the reached cells, judged per piece.
void keepEnclosed(FreeSpace& space, float leastAround, const Visibility& visibility)
{
    const DistanceField& field = space.field;
    const Pieces pieces = piecesOf(space);
    std::vector<Surroundings> seen(pieces.widest.size());
    tbb::parallel_for(size_t(0), seen.size(),
                      [&](size_t piece) { seen[piece] = lookAround(visibility, field.centre(field.cell(pieces.widest[piece]))); });
    for (const bool mindBacks : {true, false}) // a scene whose winding is all reversed shows backs everywhere: then winding says nothing
    {
        const Enclosure enclosure{leastAround, mindBacks};
        size_t kept = 0, around = 0; // cells, so that slivers count for little
        for (const uint32_t piece : pieces.of)
        {
            if (piece == kNoRegion) continue;
            around += Enclosure{leastAround, false}.keeps(seen[piece]);
            kept += enclosure.keeps(seen[piece]);
        }
        if (kept == 0 || 5 * kept < around) continue;
        for (size_t at = 0; at < field.cells(); ++at)
            if (space.reachable[at] && !enclosure.keeps(seen[pieces.of[at]])) space.reachable[at] = 0;
        return;
    }
}

void finish(FreeSpace& space)
{
    const DistanceField& field = space.field;
    space.cells.clear();
    space.cells.reserve(size_t(std::count(space.reachable.begin(), space.reachable.end(), uint8_t(1))));
    glm::ivec3 low = field.size, high(-1);
    uint32_t at = 0;
    for (int z = 0; z < field.size.z; ++z)
        for (int y = 0; y < field.size.y; ++y)
            for (int x = 0; x < field.size.x; ++x, ++at)
            {
                if (!space.reachable[at]) continue;
                space.cells.push_back(at);
                low = glm::min(low, glm::ivec3(x, y, z));
                high = glm::max(high, glm::ivec3(x, y, z));
            }
    space.bounds = {};
    if (!space.cells.empty())
    {
        space.bounds.add(field.centre(low) - 0.5f * field.voxel);
        space.bounds.add(field.centre(high) + 0.5f * field.voxel);
    }
    space.volume = double(space.cells.size()) * std::pow(double(field.voxel), 3.0);
}

struct Seeds
{
    std::vector<uint32_t> cells;   // those of the given points and cameras
    std::vector<uint32_t> regions; // where they lie, or the chosen region
    bool indoors = false;          // all of them are
};

/// The regions that the seeds lie in: `inside` points, else cameras, else the most enclosed region.
Result<Seeds> findSeeds(const Scene& scene, const Visibility& visibility, const DistanceField& field, const Regions& regions,
                        std::span<const vec3> inside)
{
    std::vector<size_t> cells;
    for (const vec3& point : inside)
    {
        cells.push_back(freeCellNear(field, regions, visibility, point, 3));
        if (cells.back() != kNoCell) continue;
        const vec3 high = field.origin + field.voxel * vec3(field.size);
        return Error{
            ErrorCode::badArgument,
            fmt::format("The inside point ({}, {}, {}) lies in solid or outside scene '{}', whose box is ({}, {}, {}) to ({}, {}, {}); "
                        "give a point in free space, at least {} m from surfaces.",
                        point.x, point.y, point.z, scene.name, field.origin.x, field.origin.y, field.origin.z, high.x, high.y, high.z,
                        field.voxel)};
    }
    if (cells.empty())
        for (const Camera& camera : scene.cameras)
            if (const size_t cell = cellOfCamera(field, regions, visibility, camera); cell != kNoCell) cells.push_back(cell);

    Seeds seeds;
    seeds.indoors = !cells.empty();
    for (size_t cell : cells)
    {
        seeds.cells.push_back(uint32_t(cell));
        seeds.regions.push_back(regions.of[cell]);
        seeds.indoors = seeds.indoors && lookAround(visibility, field.centre(field.cell(cell))).all >= kIndoors;
    }
    if (cells.empty() && !regions.volume.empty()) seeds.regions.push_back(mostEnclosedRegion(field, regions, visibility));
    return seeds;
}

/// Of the reached cells, those that a ball gets to from a seed, and what lies around its way. Hollow walls and floors of two-sided surfaces
/// are joined to rooms through the cracks that modellers leave, and look as enclosed as a room.
void keepPassable(const DistanceField& field, std::vector<uint8_t>& reached, const std::vector<uint32_t>& seeds, float radius)
{
    constexpr uint8_t kPassed = 2;
    std::vector<uint32_t> open, around;
    for (uint32_t at : seeds)
        if (reached[at] == 1 && field.distance[at] >= radius) reached[at] = kPassed, around.push_back(at);
    flood(field, std::vector(around),
          [&](size_t at)
          {
              if (reached[at] != 1 || field.distance[at] < radius) return false;
              reached[at] = kPassed;
              around.push_back(uint32_t(at));
              return true;
          });
    // Steps through faces: three radii reach into the corner of three walls.
    for (int step = int(std::ceil(3.0f * radius / field.voxel)); step > 0; --step)
    {
        open.clear();
        for (uint32_t at : around)
            forNeighbours(field, at,
                          [&](size_t next)
                          {
                              if (reached[next] != 1) return;
                              reached[next] = kPassed;
                              open.push_back(uint32_t(next));
                          });
        std::swap(around, open);
    }
    for (uint8_t& kept : reached) kept = kept == kPassed;
}

/// Half the width of the least way from the seeds, but no more than lets a seed out of its place.
float passageRadius(const FreeSpace& space, const std::vector<uint32_t>& seeds)
{
    double sum = 0.0;
    size_t cells = 0;
    for (size_t at = 0; at < space.field.cells(); ++at)
        if (space.reachable[at]) sum += double(space.field.distance[at]), ++cells;
    float widest = 0.0f;
    for (uint32_t at : seeds) widest = std::max(widest, space.field.distance[at]);
    return cells ? std::min({kPassage * float(sum / double(cells)), kWidestPassage, 0.9f * widest}) : 0.0f;
}

/// Whether one can stand below a point, no more than some metres down.
bool standsOn(const Visibility& visibility, vec3 point, const OpenSpace& open, float height)
{
    constexpr vec3 kDown(0.0f, -1.0f, 0.0f);
    RayHit hit, walk;
    const bool met = visibility.cast(point, kDown, hit);
    if (!open.walk) return met && hit.t <= height && !hit.back && hit.normal.y >= kWalkable;
    return open.walk->cast(point, kDown, walk) && walk.t <= height && !(met && hit.t < walk.t - kUnderGround);
}

/// Share of the ground that was reached, by its area, above which nothing is kept.
float groundLeftOut(const FreeSpace& space, const std::vector<uint8_t>& reached, const Visibility& visibility)
{
    const DistanceField& field = space.field;
    const float above = 1.5f * field.voxel; // the lowest cells that are free, and at times those above them
    std::atomic<size_t> all = 0, left = 0;  // relaxed: sums that parallel_for's end orders
    tbb::parallel_for(size_t(0), field.cells(),
                      [&](size_t at)
                      {
                          if (!reached[at] || field.distance[at] > above || !standsOn(visibility, field.centre(field.cell(at)), {}, above))
                              return;
                          all.fetch_add(1, std::memory_order_relaxed);
                          if (!space.reachable[at]) left.fetch_add(1, std::memory_order_relaxed);
                      });
    return all > 0 ? float(double(left) / double(all)) : 0.0f;
}

/// Whether a seed is where only open ground would make it count, and hardly any ground is enclosed.
bool callsForGround(const FreeSpace& space, const std::vector<uint8_t>& reached, const Seeds& seeds, const Visibility& visibility)
{
    const auto outside = [&](uint32_t at)
    { return !space.reachable[at] && standsOn(visibility, space.field.centre(space.field.cell(at)), {}, kStanding); };
    return std::ranges::any_of(seeds.cells, outside) && groundLeftOut(space, reached, visibility) > kMostGroundLeftOut;
}

/// Rule 4: adds what was reached near the ground, or takes what was reached in the box.
void addOpen(FreeSpace& space, const std::vector<uint8_t>& reached, const OpenSpace& open, const Visibility& visibility)
{
    const DistanceField& field = space.field;
    const auto inBox = [&](vec3 p)
    { return glm::all(glm::lessThanEqual(open.box->low, p)) && glm::all(glm::lessThanEqual(p, open.box->high)); };
    tbb::parallel_for(size_t(0), field.cells(),
                      [&](size_t at)
                      {
                          const vec3 centre = field.centre(field.cell(at));
                          if (open.box)
                              space.reachable[at] = reached[at] && inBox(centre);
                          else if (!space.reachable[at] && reached[at])
                              space.reachable[at] = standsOn(visibility, centre, open, space.ground);
                      });
}

/// Marks the cells of the given regions and keeps the enclosed ones.
void fill(FreeSpace& space, const Regions& regions, const Seeds& seeds, const Visibility& visibility, const OpenSpace& open)
{
    std::vector<uint8_t> chosen(regions.volume.size(), 0);
    for (uint32_t region : seeds.regions) chosen[region] = 1;
    space.reachable.assign(space.field.cells(), 0);
    for (size_t at = 0; at < space.field.cells(); ++at)
        if (regions.of[at] != kNoRegion) space.reachable[at] = chosen[regions.of[at]];
    std::vector<uint8_t> reached = space.reachable;
    keepEnclosed(space, seeds.indoors ? kIndoorEnclosedShare : kEnclosedShare, visibility);
    if (!open.box) space.ground = open.ground.value_or(callsForGround(space, reached, seeds, visibility) ? kStanding : 0.0f);
    if (open.box || space.ground > 0.0f) addOpen(space, reached, open, visibility);
    if (seeds.indoors && !open.box) reached = space.reachable; // only through kept cells: alcoves of the roof are as enclosed as a room
    if (const float radius = passageRadius(space, seeds.cells); radius > 0.0f)
    {
        keepPassable(space.field, reached, seeds.cells, radius);
        for (size_t at = 0; at < reached.size(); ++at) space.reachable[at] = space.reachable[at] && reached[at];
    }
    finish(space);
}

} // namespace

vec3 FreeSpace::randomPoint(Random& random) const
{
    const uint32_t at = cells[random.below(cells.size())];
    // Within the cell, and no farther from its centre than the nearest surface.
    const float reach = std::min(1.0f, field.distance[at] / (0.8661f * field.voxel));
    const vec3 jitter(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    return field.centre(field.cell(at)) + 0.999f * reach * field.voxel * jitter;
}

Result<FreeSpace> findFreeSpace(const Scene& scene, const Visibility& visibility, std::span<const vec3> inside, uint32_t voxels,
                                const Progress& progress, const OpenSpace& open)
{
    const Error cancelled{ErrorCode::cancelled, "The search for free space was cancelled."};
    const Error nothing{ErrorCode::badInput,
                        fmt::format("Scene '{}' has no free space to put probes in: every cell of its box touches a surface. "
                                    "Check the scene's scale, or raise the number of voxels (now {}).",
                                    scene.name, voxels)};
    FreeSpace space;
    const Bounds box = fillBox(visibility.bounds());
    if (!report(progress, "distance field", 0.0)) return cancelled;
    space.field = buildDistanceField(scene, visibility.presence(), box, voxels);
    if (!report(progress, "free space", 0.0)) return cancelled;
    // The regions are as large as the field: they go, with their block, before a finer one is made.
    bool indoors = false;
    {
        const Regions regions = joinFreeCells(space.field);
        const Result<Seeds> seeds = findSeeds(scene, visibility, space.field, regions, inside);
        if (!seeds) return seeds.error();
        if (seeds->regions.empty()) return nothing;
        indoors = seeds->indoors;
        fill(space, regions, *seeds, visibility, open);
    }
    if (space.cells.empty()) return nothing;

    // One room on a wide plane: spend the cells on the room. What was reached coarsely seeds the finer fill.
    Bounds room = space.bounds;
    room.low = glm::max(room.low - 3.0f * space.field.voxel, box.low);
    room.high = glm::min(room.high + 3.0f * space.field.voxel, box.high);
    const auto volumeOf = [](const Bounds& of) { return double(of.size().x) * double(of.size().y) * double(of.size().z); };
    if (volumeOf(room) < 0.4 * volumeOf(box))
    {
        if (!report(progress, "distance field", 0.5)) return cancelled;
        const FreeSpace coarse = std::move(space);
        space = FreeSpace{};
        space.field = buildDistanceField(scene, visibility.presence(), room, voxels);
        if (!report(progress, "free space", 0.5)) return cancelled;
        const Regions regions = joinFreeCells(space.field);
        Seeds seeds{{}, {}, indoors};
        for (uint32_t at : coarse.cells)
        {
            const glm::ivec3 cell = space.field.cellAt(coarse.field.centre(coarse.field.cell(at)));
            if (!space.field.inside(cell) || regions.of[space.field.index(cell)] == kNoRegion) continue;
            seeds.cells.push_back(uint32_t(space.field.index(cell)));
            seeds.regions.push_back(regions.of[seeds.cells.back()]);
        }
        OpenSpace same = open;
        if (!open.box) same.ground = coarse.ground;
        fill(space, regions, seeds, visibility, same);
        if (space.cells.empty()) return nothing;
    }
    if (!report(progress, "free space", 1.0)) return cancelled;
    return space;
}

} // namespace sconce
