#include "placement/view_targets.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

struct Room
{
    Scene scene = furnishedRoom();
    Result<Visibility> visibility = Visibility::build(scene);
    Result<FreeSpace> space = findFreeSpace(scene, *visibility, {}, 100000);
    std::vector<Surfel> draws = raySurfels(*visibility, *space, 20000, 5);

    std::vector<vec3> probes(size_t count, uint64_t seed) const
    {
        std::vector<vec3> found;
        Random random(seed, 1);
        while (found.size() < count) found.push_back(space->randomPoint(random));
        return found;
    }

    int views(const Surfel& surfel, std::span<const vec3> probes) const
    {
        int count = 0;
        for (const vec3& probe : probes)
        {
            const vec3 way = probe - surfel.position;
            count +=
                glm::dot(way, surfel.normal) > kLeastCosine * glm::length(way) && visibility->sees(probe, surfel.position, surfel.normal);
        }
        return count;
    }
};

// Against the plain sum in 64 bits; the lengths end within a block of the fast sum and within the common surfels.
TEST(GainOf, IsTheWeightedSumOfWhatARowAdds)
{
    Random random(1, 1);
    for (const size_t surfels : {1u, 17u, 4096u, 9001u})
    {
        std::vector<uint8_t> row(surfels), best(surfels);
        for (size_t s = 0; s < surfels; ++s) row[s] = uint8_t(random.below(256)), best[s] = uint8_t(random.below(256));
        const SurfelWeights weights{surfels / 3, 15, 2};
        uint64_t sum = 0;
        for (size_t s = 0; s < surfels; ++s)
            if (row[s] > best[s]) sum += uint64_t(row[s] - best[s]) * (s < surfels / 3 ? 15 : 2);
        EXPECT_EQ(gainOf(row, best.data(), weights), sum) << surfels;
    }
}

TEST(CountViews, AgreesWithOneQuestionAtATime)
{
    const Room room;
    const std::vector<vec3> probes = room.probes(9, 3);
    const std::span<const Surfel> some(room.draws.data(), 500);
    const std::vector<uint8_t> views = countViews(*room.visibility, some, probes, 1.0f, 3);
    for (size_t s = 0; s < some.size(); ++s) EXPECT_EQ(views[s], std::min(room.views(some[s], probes), 3)) << s;
}

TEST(ViewTargets, RatesOnlyWhatExceedsTheFloor)
{
    const Room room;
    const ViewTargets targets(*room.visibility, room.draws, 1.0f);
    const vec3 probe = room.probes(1, 4).front();
    std::vector<uint8_t> all(targets.size()), above(targets.size()), floor(targets.size());
    Random random(2, 2);
    for (uint8_t& one : floor) one = random.below(2) ? uint8_t(kSeen + random.below(kBetter)) : uint8_t(0);
    targets.rate(*room.visibility, probe, all);
    targets.rate(*room.visibility, probe, above, floor);
    for (size_t s = 0; s < targets.size(); ++s) EXPECT_EQ(above[s], all[s] > floor[s] ? all[s] : 0) << s;
}

// Rounding is spread over the surfels, so a sum over many knows less than a step of one: a probe 2 % farther from a wall is worth less.
TEST(ViewTargets, SumsTellViewsApartThatDifferByLessThanAStep)
{
    const Scene scene = closedRoom({40, 40, 40});
    const Result<Visibility> visibility = Visibility::build(scene);
    std::vector<Surfel> patch(4000);
    for (size_t s = 0; s < patch.size(); ++s) patch[s] = {{0.0f, 20.0f + 1e-5f * float(s), 20.0f}, {1, 0, 0}, 0, false};
    const ViewTargets targets(*visibility, patch, 5.0f);
    const auto worth = [&](float distance)
    {
        std::vector<uint8_t> row(targets.size());
        targets.rate(*visibility, {distance, 20.0f, 20.0f}, row);
        double sum = 0.0;
        for (uint8_t value : row) sum += double(value) / double(row.size());
        return sum;
    };
    for (const float distance : {5.0f, 5.1f, 8.0f}) // the floor of a value with an even offset: its mean is the value
        EXPECT_NEAR(worth(distance), double(kSeen) + double(kBetter) * 5.0 / (5.0 + double(distance)), 0.01) << distance;
}

// The estimate is of all draws: also for a set that differs from the one by which they were sorted into common and rare.
TEST(StratifiedTargets, EstimateTheCoverageOfOtherSets)
{
    const Room room;
    std::vector<vec3> probes = room.probes(6, 7);
    std::vector<Surfel> unseen;
    const ViewTargets targets = stratifiedTargets(*room.visibility, room.draws, probes, 2500, 1.0f, unseen);
    EXPECT_LE(targets.size(), 5100u);
    EXPECT_NEAR(double(targets.weights.total(targets.size())), double(room.draws.size()), 20.0);
    const auto coverages = [&]
    {
        size_t seenDraws = 0;
        for (const Surfel& surfel : room.draws) seenDraws += room.views(surfel, probes) > 0;
        uint64_t seenWeight = 0;
        for (size_t s = 0; s < targets.size(); ++s)
            if (room.views(targets.surfels[s], probes) > 0) seenWeight += targets.weights.of(s);
        return std::pair(double(seenDraws) / double(room.draws.size()), double(seenWeight) / double(targets.weights.total(targets.size())));
    };
    const auto [all, kept] = coverages();
    EXPECT_NEAR(kept, all, 1e-3); // what nobody sees is all kept
    EXPECT_NEAR(double(unseen.size()) / double(room.draws.size()), 1.0 - all, 1e-6);
    probes[2] = room.probes(1, 8).front();
    const auto [allAfter, keptAfter] = coverages();
    EXPECT_NEAR(keptAfter, allAfter, 0.006);
}

} // namespace
} // namespace sconce
