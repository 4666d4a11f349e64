#include "placement/optimise.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "base/random.h"
#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

// Closed forms of the density proportional to (1 - x) f0 + x f1 on [0,1]: mean (f0 + 2 f1) / (3 (f0 + f1)).
TEST(SampleLinear, MeanIsThatOfTheLinearDensity)
{
    for (const auto& [f0, f1] : {std::pair{1.0f, 3.0f}, {3.0f, 1.0f}, {0.0f, 2.0f}, {2.0f, 0.0f}, {5.0f, 5.0f}, {1e6f, 1e6f + 1.0f}})
    {
        double mean = 0.0;
        constexpr int kDraws = 10000;
        for (int i = 0; i < kDraws; ++i) mean += double(sampleLinear(f0, f1, (float(i) + 0.5f) / float(kDraws))) / kDraws;
        EXPECT_NEAR(mean, (double(f0) + 2.0 * double(f1)) / (3.0 * (double(f0) + double(f1))), 1e-4) << f0 << " " << f1;
    }
}

TEST(SampleLinear, FlatAndEmptyModelsReturnTheUniformNumber)
{
    for (const float uniform : {0.0f, 0.25f, 0.999f})
    {
        EXPECT_FLOAT_EQ(sampleLinear(4.0f, 4.0f, uniform), uniform);
        EXPECT_FLOAT_EQ(sampleLinear(0.0f, 0.0f, uniform), uniform);
    }
    EXPECT_EQ(sampleLinear(0.0f, 1.0f, 0.0f), 0.0f); // the inverse's 0 / 0
}

// A fitness linear along one axis: along the others the density is even. Along it the mean is that of the line, 7/12, for z; x and y are
// drawn on several edges, and the later draws prefer the edges whose draw was fit, so that theirs lies a little higher.
TEST(SampleCube, LinearFitnessAlongAnAxisDrawsByIt)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        std::array<float, 8> fitness;
        for (size_t corner = 0; corner < 8; ++corner) fitness[corner] = (corner >> axis & 1) ? 3.0f : 1.0f;
        glm::dvec3 mean(0.0);
        constexpr int kDraws = 20000;
        for (int i = 0; i < kDraws; ++i)
        {
            Random random(3, uint64_t(i));
            std::array<float, 7> uniforms;
            for (float& uniform : uniforms) uniform = random.uniform();
            mean += glm::dvec3(sampleCube(fitness, uniforms)) / double(kDraws);
        }
        for (int other = 0; other < 3; ++other)
        {
            if (other == axis) continue;
            EXPECT_NEAR(mean[other], 0.5, 0.01) << axis;
        }
        EXPECT_NEAR(mean[axis], axis == 2 ? 7.0 / 12.0 : 0.6, axis == 2 ? 0.01 : 0.02) << axis;
    }
}

struct Room
{
    Scene scene = furnishedRoom();
    Result<Visibility> visibility = Visibility::build(scene);
    Result<FreeSpace> space = findFreeSpace(scene, *visibility, {}, 100000);
    ViewTargets targets{*visibility, raySurfels(*visibility, *space, 4000, 5), 1.0f};

    uint64_t fitness(const std::vector<vec3>& positions) const
    {
        std::vector<uint8_t> best(targets.size(), 0), row(targets.size());
        for (const vec3& position : positions)
        {
            targets.rate(*visibility, position, row);
            for (size_t s = 0; s < row.size(); ++s) best[s] = std::max(best[s], row[s]);
        }
        uint64_t sum = 0;
        for (uint8_t one : best) sum += one;
        return sum;
    }
};

TEST(OptimisePositions, FitnessRisesAndPositionsStayLegal)
{
    const Room room;
    for (const Refine refine : {Refine::gradient, Refine::gibbs, Refine::stochastic})
    {
        std::vector<vec3> positions{{0.5f, 2.5f, 0.5f}, {0.7f, 2.5f, 0.5f}, {0.5f, 2.5f, 0.7f}}; // crowded in a corner
        const uint64_t before = room.fitness(positions);
        OptimiseSettings settings;
        settings.refine = refine;
        settings.clearance = 0.1f;
        settings.step = 0.5f;
        ASSERT_TRUE(optimisePositions({*room.visibility, *room.space}, room.targets, positions, settings, {}));
        EXPECT_GT(room.fitness(positions), before + before / 50);
        for (const vec3& position : positions) EXPECT_GE(bruteDistance(room.scene, position), 0.1 - 1e-5);
    }
}

TEST(OptimisePositions, FixedOnesStay)
{
    const Room room;
    const vec3 pinned(0.5f, 2.5f, 0.5f);
    std::vector<vec3> positions{pinned, {0.7f, 2.5f, 0.5f}};
    OptimiseSettings settings;
    settings.fixed = 1;
    ASSERT_TRUE(optimisePositions({*room.visibility, *room.space}, room.targets, positions, settings, {}));
    EXPECT_EQ(positions[0], pinned);
    EXPECT_NE(positions[1], vec3(0.7f, 2.5f, 0.5f));
}

TEST(OptimisePositions, SamePositionsForAnyNumberOfThreads)
{
    const Room room;
    std::vector<std::vector<vec3>> results;
    for (const size_t threads : {1u, 2u})
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back({{0.5f, 2.5f, 0.5f}, {0.7f, 2.5f, 0.5f}, {3.0f, 1.5f, 2.0f}});
        ASSERT_TRUE(optimisePositions({*room.visibility, *room.space}, room.targets, results.back(), {}, {}));
    }
    EXPECT_EQ(results[0], results[1]);
}

TEST(OptimisePositions, StopsWhenAsked)
{
    const Room room;
    std::vector<vec3> positions{{0.5f, 2.5f, 0.5f}};
    const Status done = optimisePositions({*room.visibility, *room.space}, room.targets, positions, {}, [](auto, double) { return false; });
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace sconce
