// What a placement is worth beside its yardstick, in one run and on the same samples:
//   sconce_placement_table SCENE COUNT [COUNT...] [--rows NAME,NAME...] [--save PREFIX] [--seed N]
// Rows: yardstick, grid, skeleton (alone), chosen (greedy and exchange), gradient, gibbs, stochastic
// (that and refined so; gradient is what `sconce place` does), balls, balls-gradient (with the other skeleton), bound (what any legal
// position at all sees). The grid is that of `place --fit-grid`'s poses which sees most ray hits. Each line: coverage of ray hits and of
// area in per cent, cosine and distance of the best view (medians), seconds. --save writes PREFIX-COUNT-ROW.json, for `sconce bake` and
// sconce_ray_accuracy.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>

#include <tbb/parallel_for.h>

#include "base/random.h"
#include "placement/grid.h"
#include "placement/place.h"
#include "placement/skeleton.h"
#include "scene/named_scene.h"
#include "tests/placement/yardstick.h"

namespace sconce
{
namespace
{

double cpuSeconds()
{
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/// Whether some position that keeps the clearance sees the surfel: tried along random directions of its hemisphere, nearest first, since a
/// position on a way that is free all along sees where the way starts.
bool seenFromAnywhere(const LegalSpace& legal, const Surfel& surfel, uint64_t stream)
{
    constexpr int kDirections = 300, kDepths = 12;
    Random random(99, stream);
    const vec3 start = surfel.position + legal.visibility.epsilon() * surfel.normal;
    for (int i = 0; i < kDirections; ++i)
    {
        vec3 direction = random.direction();
        if (glm::dot(direction, surfel.normal) < 0.0f) direction = -direction;
        if (glm::dot(direction, surfel.normal) <= kLeastCosine) continue;
        RayHit hit;
        const float reach = legal.visibility.cast(start, direction, hit) ? hit.t : legal.space.bounds.diagonal();
        for (int depth = 1; depth <= kDepths; ++depth)
        {
            const float share = float(depth) / float(kDepths + 1);
            if (legal.allows(start + share * share * reach * direction, legal.space.field.voxel)) return true;
        }
    }
    return false;
}

struct Table
{
    const Scene& scene;
    const Visibility& visibility;
    const FreeSpace& space;
    std::string savePrefix;
    std::vector<std::string> rows; // empty: all
    uint64_t seed = 1;

    bool wants(const std::string& row) const { return rows.empty() || std::find(rows.begin(), rows.end(), row) != rows.end(); }

    int line(const char* method, uint32_t count, const std::function<Result<ProbeSet>()>& place) const
    {
        if (!wants(method)) return 0;
        const double cpu = cpuSeconds();
        const auto started = std::chrono::steady_clock::now();
        const Result<ProbeSet> set = place();
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
        const double spent = cpuSeconds() - cpu;
        if (!set) return std::fprintf(stderr, "%s: %s\n", method, set.error().message.c_str()), 1;
        std::vector<vec3> positions;
        for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
        CoverageSettings check;
        check.seed = 4711; // of no placement
        const Result<Coverage> coverage = measureCoverage(scene, visibility, space, positions, check);
        if (!coverage) return std::fprintf(stderr, "%s: %s\n", method, coverage.error().message.c_str()), 1;
        double quality = 0.0;
        for (float one : coverage->quality) quality += double(one) / double(coverage->quality.size());
        std::printf("%-10s %6zu  %7.2f %7.2f  %6.3f %7.3f  %7.4f  %6.1f %6.1f\n", method, positions.size(), 100.0 * double(coverage->rays),
                    100.0 * double(coverage->area), double(coverage->medianCosine), double(coverage->medianDistance), quality, seconds,
                    spent);
        std::fflush(stdout);
        if (savePrefix.empty()) return 0;
        const Status saved = saveProbes(*set, savePrefix + "-" + std::to_string(count) + "-" + method + ".json");
        if (!saved) return std::fprintf(stderr, "%s\n", saved.error().message.c_str()), 1;
        return 0;
    }

    ProbeSet setOf(const std::vector<vec3>& positions, const char* why) const
    {
        ProbeSet set;
        for (const vec3& position : positions) set.probes.push_back({position, why});
        return set;
    }

    Result<ProbeSet> ours(uint32_t count, PlaceSettings::Method method, Refine refine) const
    {
        PlaceSettings settings;
        settings.count = count;
        settings.method = method;
        settings.refine = refine;
        settings.seed = seed;
        PlaceReport report;
        return placeProbes(scene, settings, report);
    }

    /// `place --fit-grid` chooses by how a point's own cell sees it, which tracers need, and so not always the grid that sees most.
    Result<ProbeSet> gridThatSeesMost(uint32_t count) const
    {
        Result<ProbeSet> best = Error{ErrorCode::badInput, "There is no grid."};
        float most = -1.0f;
        for (const glm::ivec3& shape : gridShapes(space.bounds, count, kGridShapes))
            for (const float margin : kGridMargins)
            {
                const ProbeGrid grid = gridIn(space.bounds, shape, margin);
                std::vector<vec3> positions;
                for (int z = 0; z < shape.z; ++z)
                    for (int y = 0; y < shape.y; ++y)
                        for (int x = 0; x < shape.x; ++x) positions.push_back(grid.origin + grid.step * vec3(x, y, z));
                CoverageSettings check;
                check.seed = 815; // of no placement, and not the table's
                check.points = 20000;
                const Result<Coverage> coverage = measureCoverage(scene, visibility, space, positions, check);
                if (!coverage) return coverage.error();
                if (coverage->rays <= most) continue;
                most = coverage->rays;
                best = setOf(positions, "grid");
            }
        return best;
    }

    /// Of the same points that the other rows are measured on.
    void bound() const
    {
        if (!wants("bound")) return;
        CoverageSettings check;
        check.seed = 4711;
        const Result<Coverage> none = measureCoverage(scene, visibility, space, {}, check);
        if (!none) return;
        const LegalSpace legal{visibility, space};
        std::vector<uint8_t> seen(none->points.size());
        tbb::parallel_for(size_t(0), seen.size(), [&](size_t s) { seen[s] = seenFromAnywhere(legal, none->points[s], s); });
        std::printf("%-10s %6s  %7.2f\n", "bound", "any", 100.0 * double(std::count(seen.begin(), seen.end(), 1)) / double(seen.size()));
        std::fflush(stdout);
    }

    int run(uint32_t count) const
    {
        int failures = line("yardstick", count,
                            [&] { return Result<ProbeSet>(setOf(test::yardstickProbes(visibility, space, count, 6 + seed), "greedy")); });
        failures += line("grid", count, [&] { return gridThatSeesMost(count); });
        failures += line("skeleton", count,
                         [&]
                         {
                             std::vector<vec3> positions;
                             for (const Candidate& candidate : skeletonCandidates({visibility, space}, count, space.field.voxel))
                                 positions.push_back(candidate.position);
                             return Result<ProbeSet>(setOf(positions, "skeleton"));
                         });
        failures += line("chosen", count, [&] { return ours(count, PlaceSettings::Method::sdf, Refine::none); });
        const std::pair<const char*, Refine> refinements[] = {
            {"gradient", Refine::gradient}, {"gibbs", Refine::gibbs}, {"stochastic", Refine::stochastic}};
        for (const auto& [name, refine] : refinements)
            failures += line(name, count, [&] { return ours(count, PlaceSettings::Method::sdf, refine); });
        failures += line("balls", count, [&] { return ours(count, PlaceSettings::Method::balls, Refine::none); });
        failures += line("balls-gradient", count, [&] { return ours(count, PlaceSettings::Method::balls, Refine::gradient); });
        return failures;
    }
};

int main(int argc, char** argv)
{
    std::vector<std::string> words(argv + 1, argv + argc);
    const auto option = [&words](const char* name)
    {
        const auto at = std::find(words.begin(), words.end(), name);
        if (at == words.end() || at + 1 == words.end()) return std::string();
        const std::string value = at[1];
        words.erase(at, at + 2);
        return value;
    };
    const std::string prefix = option("--save");
    const std::string seed = option("--seed");
    std::istringstream list(option("--rows"));
    std::vector<std::string> rows;
    for (std::string row; std::getline(list, row, ',');) rows.push_back(row);
    if (words.size() < 2)
        return std::fprintf(stderr, "usage: sconce_placement_table SCENE COUNT [COUNT...] [--rows NAME,NAME...] [--save PREFIX] "
                                    "[--seed N]\n"),
               2;
    Result<Scene> scene = namedScene(words[0]);
    if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 3;
    Result<Visibility> visibility = Visibility::build(*scene);
    if (!visibility) return std::fprintf(stderr, "%s\n", visibility.error().message.c_str()), 3;
    Result<FreeSpace> space = findFreeSpace(*scene, *visibility, {});
    if (!space) return std::fprintf(stderr, "%s\n", space.error().message.c_str()), 3;
    const Result<Coverage> none = measureCoverage(*scene, *visibility, *space, {}, {});
    std::printf("%s: %zu triangles, reachable %.1f of %.1f m^3, cells of %.3f m, backs %.2f %%\n", words[0].c_str(),
                scene->triangles.size(), space->volume,
                double(visibility->bounds().size().x) * double(visibility->bounds().size().y) * double(visibility->bounds().size().z),
                double(space->field.voxel), none ? 100.0 * double(none->backs) : 0.0);
    std::printf("method     probes     rays    area  cosine  metres  quality  seconds    cpu\n");
    const Table table{*scene, *visibility, *space, prefix, rows, seed.empty() ? 1 : std::strtoull(seed.c_str(), nullptr, 10)};
    table.bound();
    int failures = 0;
    for (size_t word = 1; word < words.size(); ++word) failures += table.run(uint32_t(std::strtoul(words[word].c_str(), nullptr, 10)));
    return failures ? 1 : 0;
}

} // namespace
} // namespace sconce

int main(int argc, char** argv)
{
    return sconce::main(argc, argv);
}
