#include "placement/place.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "base/numbers.h"
#include "base/random.h"
#include "placement/ball_shrinking.h"
#include "placement/grid.h"
#include "placement/optimise.h"
#include "placement/select.h"
#include "placement/skeleton.h"

namespace sconce
{
namespace
{

// Of the candidates: a proposal from the skeleton, random ones that fill what the skeleton leaves out, and those before gaps in the view.
constexpr double kRidgeShare = 0.43;
constexpr double kSpreadShare = 0.32;
constexpr double kGapShare = 0.25;
constexpr size_t kDraws = 8;      // samples drawn for each one that is kept
constexpr double kRayShare = 0.8; // of the surfels where rays hit; the rest evenly by area
constexpr float kComfort = 0.09f; // of the probes' spacing, metres from surfaces
// A pass of exchange reads candidates x surfels x probes bytes: beyond this many probes the greedy choice stands.
constexpr size_t kMostExchanged = 600;
constexpr size_t kFitPoints = 20000; // of the coverage that it is chosen by; the standard error at 95 % is 0.15 %
constexpr size_t kTableBytes = size_t(400) << 20;
static_assert(knobs::count.most == kMostProbes);
static_assert(knobs::method.is(knobs::kMethods[size_t(PlaceSettings::Method::sdf)]) && // the enums are in the choices' order
              knobs::refine.is(knobs::kRefines[size_t(Refine::gradient)]));

size_t numberOf(const std::vector<Pin>& pins, Pin::Kind kind)
{
    return size_t(std::count_if(pins.begin(), pins.end(), [kind](const Pin& pin) { return pin.kind == kind; }));
}

std::string faultOf(const PlaceSettings& settings)
{
    const bool ownGrid = settings.grid != glm::ivec3(0);
    const std::string fault =
        firstFault({faultOf(knobs::count, settings.count), faultOf(knobs::coverage, settings.coverage),
                    faultOf(knobs::clearance, settings.clearance), faultOf(knobs::distanceVoxels, settings.voxels),
                    faultOf(knobs::candidates, settings.candidates), faultOf(knobs::surfels, settings.surfels),
                    faultOf(knobs::refineRounds, settings.refineRounds), faultOf(knobs::refineSurfels, settings.refineSurfels)});
    if (!fault.empty()) return fmt::format("{}.", fault);
    const size_t kept = numberOf(settings.pins, Pin::Kind::keep), added = numberOf(settings.pins, Pin::Kind::add);
    if (settings.method == PlaceSettings::Method::grid && !settings.pins.empty()) return "pins are given but a grid has no free choice.";
    if (settings.count != 0 && kept > settings.count)
        return fmt::format("{} probes are kept but count is {}; raise it.", kept, settings.count);
    if (std::max(kept, size_t(settings.count)) + added > kMostProbes)
        return fmt::format("{} probes are asked for beside {} added ones; at most {} can be indexed.",
                           std::max(kept, size_t(settings.count)), added, kMostProbes);
    for (const Pin& pin : settings.pins)
        if (!std::isfinite(pin.position.x + pin.position.y + pin.position.z) || !(pin.kind != Pin::Kind::forbid || pin.radius > 0.0f))
            return fmt::format("the pin at ({}, {}, {}) with radius {} is not finite, or forbids nothing.", pin.position.x, pin.position.y,
                               pin.position.z, pin.radius);
    for (const vec3& point : settings.inside)
        if (!std::isfinite(point.x + point.y + point.z))
            return fmt::format("the inside point ({}, {}, {}) is not finite.", point.x, point.y, point.z);
    if (settings.open.ground && !(*settings.open.ground >= 0.0f && *settings.open.ground <= 1e6f))
        return fmt::format("open ground counts up to {} m; give 0 to 1e6.", *settings.open.ground);
    if (settings.open.walk && !(settings.open.ground.value_or(0.0f) > 0.0f))
        return "a mesh to walk on is given, but no height above it that counts; give open.ground.";
    if (settings.open.box && !(finite(settings.open.box->low) && finite(settings.open.box->high) && !settings.open.box->empty()))
        return "the box of the space that counts is empty or not finite; give its low corner, then its high one.";
    if (ownGrid && settings.method != PlaceSettings::Method::grid) return "grid is given but the method is not grid; choose one.";
    if (ownGrid && settings.count != 0) return "grid and count are both given; choose one.";
    if (ownGrid && (glm::any(glm::lessThan(settings.grid, glm::ivec3(1))) ||
                    int64_t(settings.grid.x) * settings.grid.y * int64_t(settings.grid.z) > int64_t(kMostProbes) ||
                    glm::any(glm::greaterThan(settings.grid, glm::ivec3(int(kMostProbes))))))
        return fmt::format("grid is {}x{}x{}; give at least 1 along each axis and at most {} in all.", settings.grid.x, settings.grid.y,
                           settings.grid.z, kMostProbes);
    return {};
}

ProbeSet gridSet(const FreeSpace& space, const ProbeGrid& grid)
{
    ProbeSet set;
    set.grid = grid;
    for (int z = 0; z < grid.count.z; ++z)
        for (int y = 0; y < grid.count.y; ++y)
            for (int x = 0; x < grid.count.x; ++x)
            {
                const vec3 position = grid.origin + grid.step * vec3(x, y, z);
                const bool reachable = space.contains(position);
                set.probes.push_back(
                    {position, fmt::format("grid point {},{},{}{}", x, y, z, reachable ? "" : ", outside the reachable space")});
            }
    return set;
}

std::vector<vec3> positionsOf(const ProbeSet& set)
{
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : set.probes) positions.push_back(probe.position);
    return positions;
}

/// The grids that a placement may choose among: one where nothing is to be fitted.
std::vector<ProbeGrid> gridsFor(const FreeSpace& space, const PlaceSettings& settings)
{
    const uint32_t count = settings.count ? settings.count : knobs::kGridCount;
    const size_t most = settings.fitGrid ? kGridShapes : 1;
    std::vector<glm::ivec3> shapes{settings.grid};
    if (settings.grid == glm::ivec3(0))
        shapes = settings.powersOfTwo ? powerOfTwoShapes(space.bounds, count, most) : gridShapes(space.bounds, count, most);
    std::vector<ProbeGrid> grids;
    for (const glm::ivec3& shape : shapes)
        for (const float margin : kGridMargins)
            if (settings.fitGrid || margin == kGridMargins[0]) grids.push_back(gridIn(space.bounds, shape, margin));
    return grids;
}

/// How well the corners of their cell see some points, in the mean of the best corner's viewQuality: what lights them, and where rays that
/// leave them begin. A grid that is fitted to what any of its points sees has larger cells, whose corners stand behind walls: on Sponza,
/// twice the wrong rays. One fitted to the share that corners see has them in the walls themselves.
double qualityOfCorners(const Visibility& visibility, const ProbeGrid& grid, std::span<const Surfel> points, float spacing)
{
    std::vector<float> best(points.size());
    tbb::parallel_for(size_t(0), points.size(),
                      [&](size_t s)
                      {
                          const vec3 place = (points[s].position - grid.origin) / grid.step;
                          for (int corner = 0; corner < 8; ++corner)
                          {
                              glm::ivec3 at;
                              for (int a = 0; a < 3; ++a)
                              {
                                  const int low = std::clamp(int(std::floor(place[a])), 0, std::max(grid.count[a] - 2, 0));
                                  at[a] = std::min(low + (corner >> a & 1), grid.count[a] - 1);
                              }
                              const vec3 probe = grid.origin + grid.step * vec3(at);
                              const float quality = viewQuality(points[s], probe, spacing);
                              if (quality > best[s] && visibility.sees(probe, points[s].position, points[s].normal)) best[s] = quality;
                          }
                      });
    return std::accumulate(best.begin(), best.end(), 0.0) / double(std::max<size_t>(best.size(), 1));
}

Result<ProbeSet> placeGrid(const Scene& scene, const Visibility& visibility, const FreeSpace& space, const PlaceSettings& settings,
                           PlaceReport& report, const Progress& progress)
{
    const std::vector<ProbeGrid> grids = settings.pose ? std::vector{*settings.pose} : gridsFor(space, settings);
    const ProbeGrid* chosen = &grids.front();
    if (grids.size() > 1)
    {
        // Fewer points than the report's, and others: it is a choice, and the report's would be fitted to.
        CoverageSettings check;
        check.points = kFitPoints;
        check.seed = settings.seed ^ 0x67726964ull;
        const Result<Coverage> sampled = measureCoverage(scene, visibility, space, {}, check, progress);
        if (!sampled) return sampled.error();
        const glm::ivec3 count = grids.front().count;
        const float spacing = probeSpacing(space, size_t(count.x) * size_t(count.y) * size_t(count.z)); // one measure for all of them
        double most = -1.0;
        for (const ProbeGrid& grid : grids)
            if (const double quality = qualityOfCorners(visibility, grid, sampled->points, spacing); quality > most)
                most = quality, chosen = &grid;
    }
    ProbeSet best = gridSet(space, *chosen);
    for (const PlacedProbe& probe : best.probes) report.gridOutside += space.contains(probe.position) ? 0 : 1;
    return best;
}

const char* nameOf(Candidate::Origin origin)
{
    switch (origin)
    {
    case Candidate::Origin::ridge:
        return "skeleton ridge";
    case Candidate::Origin::ball:
        return "skeleton ball";
    case Candidate::Origin::spread:
        return "free point";
    case Candidate::Origin::gap:
        return "gap in the view of others";
    case Candidate::Origin::kept:
        return "kept as pinned";
    case Candidate::Origin::added:
        return "added as pinned";
    }
    return "";
}

std::vector<vec3> positionsOf(const std::vector<Candidate>& candidates, std::span<const uint32_t> chosen)
{
    std::vector<vec3> positions;
    for (uint32_t candidate : chosen) positions.push_back(candidates[candidate].position);
    return positions;
}

/// What rays hit, and some evenly by area.
std::vector<Surfel> mixedSurfels(const Scene& scene, const Visibility& visibility, const FreeSpace& space, size_t count, uint64_t seed)
{
    std::vector<Surfel> surfels = raySurfels(visibility, space, size_t(double(count) * kRayShare), seed);
    for (const Surfel& surfel : areaSurfels(scene, visibility, space, size_t(double(count) * (1.0 - kRayShare)), seed))
        surfels.push_back(surfel);
    return surfels;
}

float shareSeen(std::span<const uint8_t> best, const SurfelWeights& weights)
{
    uint64_t seen = 0;
    for (size_t s = 0; s < best.size(); ++s)
        if (best[s] != 0) seen += weights.of(s);
    return float(double(seen) / double(weights.total(best.size())));
}

/// The probes with what each is good for, those that see most of what the earlier ones don't first.
Result<ProbeSet> explained(const Visibility& visibility, const ViewTargets& targets, const std::vector<Candidate>& probes,
                           PlaceReport& report)
{
    ViewTable table;
    if (const Status done = extendTable(table, visibility, targets, probes, {}); !done) return done.error();
    std::vector<uint32_t> order(probes.size());
    std::iota(order.begin(), order.end(), 0u);
    report.newlyCovered = orderByGain(table, order);
    report.alone = sharesAlone(table, order);
    ProbeSet set;
    for (size_t k = 0; k < order.size(); ++k)
    {
        const Candidate& probe = probes[order[k]];
        const double fresh = 100.0 * double(report.newlyCovered[k]), alone = 100.0 * double(report.alone[k]);
        std::string why = nameOf(probe.origin);
        why += fresh > 0.0 ? fmt::format(", covers {:.2f} % of the surface first", fresh) : ", sees better what others see badly";
        if (alone > 0.0) why += fmt::format(", {:.2f} % alone", alone);
        set.probes.push_back({probe.position, why});
    }
    return set;
}

/// The pinned probes; kept ones first.
std::vector<Candidate> pinnedCandidates(const std::vector<Pin>& pins)
{
    std::vector<Candidate> found;
    for (const auto& [kind, origin] :
         {std::pair{Pin::Kind::keep, Candidate::Origin::kept}, std::pair{Pin::Kind::add, Candidate::Origin::added}})
        for (const Pin& pin : pins)
            if (pin.kind == kind) found.push_back({pin.position, origin});
    return found;
}

/// Why a pinned probe may not be where it is; empty when all may.
std::string faultOfPins(const LegalSpace& legal, float clearance)
{
    for (const Candidate& pinned : pinnedCandidates({legal.pins.begin(), legal.pins.end()}))
    {
        const vec3 p = pinned.position;
        const std::string probe = fmt::format("Placement: the pinned probe at ({}, {}, {}) ", p.x, p.y, p.z);
        const float distance = legal.visibility.distance(p, 1.001f * clearance);
        if (!legal.space.contains(p))
            return fmt::format("{}lies in solid or outside the reachable space; move it, or name its space by --inside.", probe);
        if (distance < clearance)
            return fmt::format("{}is {} m from a surface, nearer than the clearance of {} m; move it or lower the clearance.", probe,
                               distance, clearance);
        if (!legal.allows(p, clearance)) return fmt::format("{}lies in a forbidden place or behind a thin wall; move it.", probe);
    }
    return {};
}

/// Probes among candidates on the skeleton of the free space, spread in it, and before gaps: chosen by what they see, then moved.
class SkeletonPlacement
{
public:
    SkeletonPlacement(const Scene& placedIn, const Visibility& seen, const FreeSpace& reachable, const PlaceSettings& asked,
                      PlaceReport& told, const Progress& heard)
        : scene(placedIn), visibility(seen), space(reachable), settings(asked), report(told),
          progress(heard), legal{seen, reachable, asked.pins}, clearance(asked.clearance > 0.0f ? asked.clearance : reachable.field.voxel),
          // Kept probes are among those asked for, added ones stand beside them.
          count(asked.count ? asked.count + uint32_t(numberOf(asked.pins, Pin::Kind::add)) : 0),
          spacing(probeSpacing(reachable, count ? count : knobs::kGridCount)),
          // Probes near a wall see the rest of it at a flat angle, so most keep away from walls; those before gaps may need to be near.
          comfort(std::max(clearance, kComfort * spacing)),
          planned(std::max(double(asked.candidates), 3.5 * double(count))) // many probes need many candidates
    {
    }

    Result<ProbeSet> run()
    {
        report.clearance = clearance;
        report.comfort = comfort;
        // Pinned probes are never moved, so a place that no probe may take is refused here rather than mended later.
        if (const std::string fault = faultOfPins(legal, clearance); !fault.empty()) return Error{ErrorCode::badArgument, fault};
        if (!sconce::report(progress, "skeleton", 0.0)) return cancelled();
        if (auto status = findCandidates(); !status) return status.error();
        if (auto status = see(); !status) return status.error();
        if (!sconce::report(progress, "choice", 0.0)) return cancelled();
        choose(settings.coverage);
        if (count == 0)
            if (auto status = meetTheCoverage(); !status) return status.error();
        return moved();
    }

private:
    static Error cancelled() { return Error{ErrorCode::cancelled, "The placement was cancelled."}; }

    Status findCandidates();
    /// What every candidate sees, with those before the gaps that a first choice leaves.
    Status see();
    void choose(float target);
    Status meetTheCoverage();
    Result<ProbeSet> moved();

    const Scene& scene;
    const Visibility& visibility;
    const FreeSpace& space;
    const PlaceSettings& settings;
    PlaceReport& report;
    const Progress& progress;
    const LegalSpace legal;
    const float clearance; // metres, as all lengths here
    const uint32_t count;  // 0: as many as the coverage takes
    const float spacing, comfort;
    const double planned; // candidates
    std::vector<Candidate> candidates;
    size_t pinned = 0; // of them, the first
    ViewTable table;
    std::vector<uint32_t> chosen;
    std::vector<Surfel> gaps;
};

Status SkeletonPlacement::findCandidates()
{
    // Ahead of all others: every step below takes the first so many candidates as chosen and leaves them where they are.
    candidates = pinnedCandidates(settings.pins);
    pinned = candidates.size();
    // Of both kinds: ridges are few and see far, spread ones are wherever ridges of small cells are missing. A seed of its own for each
    // step: no two draw the same places.
    const size_t onSkeleton = size_t(planned * kRidgeShare);
    for (const Candidate& candidate : settings.method == PlaceSettings::Method::balls
                                          ? ballCandidates(scene, legal, onSkeleton, comfort, settings.seed ^ 0x62616c6c73ull)
                                          : skeletonCandidates(legal, onSkeleton, comfort))
        candidates.push_back(candidate);
    for (const Candidate& candidate : spreadCandidates(legal, size_t(planned * kSpreadShare), comfort, settings.seed ^ 0x737072656164ull))
        candidates.push_back(candidate);
    if (!candidates.empty()) return success();
    return Error{ErrorCode::badInput,
                 fmt::format("Scene '{}' has no free position {} m away from all surfaces and outside forbidden places; lower the "
                             "clearance, forbid less, or raise the number of voxels (a cell is {} m).",
                             scene.name, clearance, space.field.voxel)};
}

Status SkeletonPlacement::see()
{
    // The table of views has a byte for each candidate and surfel: where candidates are many, surfels must be fewer.
    const size_t budget = size_t(std::min(double(settings.surfels), std::max(double(kTableBytes) / planned, 8000.0)));
    std::vector<Surfel> surfels = mixedSurfels(scene, visibility, space, budget / 4, settings.seed);
    if (surfels.empty())
        return Error{ErrorCode::badInput,
                     fmt::format("No ray from the free space of scene '{}' hits a surface; check --inside.", scene.name)};
    // A first choice by few samples tells which places few probes see; those decide the second, of many.
    const ViewTargets few(visibility, std::move(surfels), spacing);
    if (auto done = extendTable(table, visibility, few, candidates, progress); !done) return done;
    chosen = chooseGreedily(table, count, settings.coverage, pinned);
    const ViewTargets targets =
        stratifiedTargets(visibility, mixedSurfels(scene, visibility, space, kDraws * budget, settings.seed ^ 0x64726177ull),
                          positionsOf(candidates, chosen), budget / 2, spacing, gaps);
    for (const Candidate& candidate : gapCandidates(legal, gaps, size_t(planned * kGapShare), clearance, settings.seed ^ 0x676170ull))
        candidates.push_back(candidate);
    // Anew, not extended: the rows are of other surfels now.
    table = {};
    if (auto done = extendTable(table, visibility, targets, candidates, progress); !done) return done;

    // What all candidates together see bounds every choice among them; the search for a target below ends there.
    std::vector<uint32_t> all(candidates.size());
    for (uint32_t c = 0; c < all.size(); ++c) all[c] = c;
    report.candidates = candidates.size();
    report.bestPossible = shareSeen(bestValues(table, all), targets.weights);
    // Only now, since the candidates before gaps count, too.
    if (count <= candidates.size()) return success();
    return Error{ErrorCode::badArgument,
                 fmt::format("{} probes are asked for, but only {} positions with a clearance of {} m were found; lower the "
                             "count or the clearance.",
                             count, candidates.size(), clearance)};
}

void SkeletonPlacement::choose(float target)
{
    chosen = chooseGreedily(table, count, target, pinned);
    if (count && chosen.size() <= kMostExchanged) improveByExchange(table, chosen, 2, pinned);
    if (!count) pruneNeedless(table, chosen, pinned);
}

/// The choice is fitted to its surfels; other samples see a little less, so it aims higher until those are content, too.
Status SkeletonPlacement::meetTheCoverage()
{
    float target = settings.coverage;
    for (int round = 0; round < 6; ++round)
    {
        CoverageSettings check;
        check.seed = settings.seed ^ 0x636865636bull;
        const Result<Coverage> measured = measureCoverage(scene, visibility, space, positionsOf(candidates, chosen), check, {});
        if (!measured) return measured.error();
        if (measured->rays >= settings.coverage || target >= report.bestPossible) break;
        target = std::min(report.bestPossible, target + std::max(settings.coverage - measured->rays, 1e-4f));
        choose(target);
    }
    // A count is bounded by its knob; a coverage may need any number.
    if (chosen.size() <= kMostProbes) return success();
    return Error{ErrorCode::badInput, fmt::format("A coverage of {} needs {} probes, more than {}; lower the coverage.", settings.coverage,
                                                  chosen.size(), kMostProbes)};
}

/// The choice was among sampled candidates: a probe may do better close by (Wang et al. 2019, section 3.3). From here on probes are
/// positions, where no candidate is.
Result<ProbeSet> SkeletonPlacement::moved()
{
    std::vector<vec3> positions = positionsOf(candidates, chosen);
    // By fresh samples: those of the choice have been fitted to already.
    const ViewTargets refining = stratifiedTargets(
        visibility, mixedSurfels(scene, visibility, space, kDraws * settings.refineSurfels, settings.seed ^ 0x726566696e65ull), positions,
        settings.refineSurfels / 2, probeSpacing(space, positions.size()), gaps);
    OptimiseSettings optimise;
    optimise.refine = settings.refine;
    optimise.rounds = settings.refineRounds;
    optimise.clearance = clearance;
    optimise.comfort = comfort;
    optimise.seed = settings.seed;
    optimise.fixed = pinned;
    if (auto done = optimisePositions(legal, refining, positions, optimise, progress); !done) return done.error();

    std::vector<Candidate> final;
    for (size_t k = 0; k < chosen.size(); ++k) final.push_back({positions[k], candidates[chosen[k]].origin});
    // By the positions as they are now; what the choice knew of them has been moved away from.
    return explained(visibility, refining, final, report);
}

Status soundInput(const Scene& scene, const PlaceSettings& settings)
{
    if (const std::string fault = faultOf(settings); !fault.empty())
        return Error{ErrorCode::badArgument, fmt::format("Placement: {}", fault)};
    if (const std::string fault = validate(scene); !fault.empty()) return Error{ErrorCode::badInput, fault};
    return success();
}

} // namespace

Result<std::vector<ProbeGrid>> gridPoses(const Scene& scene, const PlaceSettings& settings, const Progress& progress)
{
    if (const Status sound = soundInput(scene, settings); !sound) return sound.error();
    const Result<Visibility> visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    const Result<FreeSpace> space = findFreeSpace(scene, *visibility, settings.inside, settings.voxels, progress, settings.open);
    if (!space) return space.error();
    PlaceSettings fitted = settings;
    fitted.fitGrid = true;
    return gridsFor(*space, fitted);
}

Result<ProbeSet> placeProbes(const Scene& scene, const PlaceSettings& settings, PlaceReport& report, const Progress& progress)
{
    const auto started = std::chrono::steady_clock::now();
    report = {};
    if (const Status sound = soundInput(scene, settings); !sound) return sound.error();
    const Result<Visibility> visibility = Visibility::build(scene);
    if (!visibility) return visibility.error();
    const Result<FreeSpace> space = findFreeSpace(scene, *visibility, settings.inside, settings.voxels, progress, settings.open);
    if (!space) return space.error();
    report.reachable = space->bounds;
    report.reachableVolume = space->volume;
    report.voxel = space->field.voxel;
    report.ground = space->ground;
    report.surfaceLeftOut = shareLeftOut(scene, *visibility, *space, settings.seed ^ 0x6c656674ull);

    const bool isGrid = settings.method == PlaceSettings::Method::grid;
    Result<ProbeSet> set = isGrid ? placeGrid(scene, *visibility, *space, settings, report, progress)
                                  : SkeletonPlacement(scene, *visibility, *space, settings, report, progress).run();
    if (!set) return set;
    set->method = isGrid ? "grid" : settings.method == PlaceSettings::Method::balls ? "balls" : "sdf";
    set->scene = scene.name;
    set->seed = settings.seed;

    const std::vector<vec3> positions = positionsOf(*set);
    CoverageSettings check;
    check.seed = settings.seed;
    const Result<Coverage> coverage = measureCoverage(scene, *visibility, *space, positions, check, progress);
    if (!coverage) return coverage.error();
    report.coverageRays = coverage->rays;
    report.coverageArea = coverage->area;
    report.medianCosine = coverage->medianCosine;
    report.medianDistance = coverage->medianDistance;
    if (settings.explain) report.picture = drawPlacement(*space, positions, *coverage);
    if (!isGrid && settings.count == 0 && coverage->rays < settings.coverage - 0.001f)
        report.warnings.push_back(
            fmt::format("The coverage reached is {:.2f} %, not the {:.2f} % asked for: of the tested positions all together see "
                        "{:.2f} %. Lower the clearance, or the coverage.",
                        100.0 * double(coverage->rays), 100.0 * double(settings.coverage), 100.0 * double(report.bestPossible)));
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return set;
}

} // namespace sconce
