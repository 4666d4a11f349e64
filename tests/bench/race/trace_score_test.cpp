#include "bench/race/trace_score.h"

#include <cmath>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(TraceScore, EachVerdictOnceByHand)
{
    RaySet set;
    set.diagonal = 100.0f; // 1 % is 1 m, 0.2 % is 0.2 m
    const auto expect = [&](bool hit, float t, TraceStatus status, float traced, TraceVerdict verdict)
    { EXPECT_EQ(judge({.hit = hit, .t = t}, {.status = status, .t = traced}, set.diagonal), verdict) << t << ' ' << traced; };
    expect(true, 10.0f, TraceStatus::hit, 10.9f, TraceVerdict::right);
    expect(true, 10.0f, TraceStatus::hit, 11.1f, TraceVerdict::leak);
    expect(true, 10.0f, TraceStatus::hit, 8.9f, TraceVerdict::falseHit);
    expect(true, 10.0f, TraceStatus::miss, 0.0f, TraceVerdict::leak);
    expect(true, 10.0f, TraceStatus::unknown, 10.0f, TraceVerdict::unresolved);
    expect(true, 10.0f, TraceStatus::hit, std::nanf(""), TraceVerdict::unresolved);
    expect(false, 0.0f, TraceStatus::hit, 50.0f, TraceVerdict::falseHit);
    expect(false, 0.0f, TraceStatus::miss, 0.0f, TraceVerdict::right);

    std::vector<TracedRay> traced;
    for (uint32_t i = 0; i < 100; ++i)
    {
        set.origins.emplace_back(0.0f);
        set.truth.push_back({.hit = true, .t = 10.0f});
        traced.push_back({TraceStatus::hit, i < 50 ? 10.1f : 10.5f, i, 2, i == 99 ? 1000u : 0u});
    }
    traced[0].status = TraceStatus::unknown;
    const TraceScore score = scoreTraces(set, traced);
    EXPECT_DOUBLE_EQ(score.right1, 0.99);
    EXPECT_DOUBLE_EQ(score.right02, 0.49);
    EXPECT_DOUBLE_EQ(score.unresolved, 0.01);
    EXPECT_DOUBLE_EQ(score.assumed1, 1.0) << "it lost sight where the truth is";
    EXPECT_DOUBLE_EQ(score.assumed02, 0.5);
    EXPECT_DOUBLE_EQ(score.handoffs.mean, 49.5);
    EXPECT_EQ(score.handoffs.p95, 94u); // 95th smallest of 0..99
    EXPECT_EQ(score.handoffs.max, 99u);
    EXPECT_DOUBLE_EQ(score.distanceReads.mean, 2.0);
    EXPECT_EQ(score.indexReads.p95, 0u);
    EXPECT_EQ(score.indexReads.max, 1000u);
    // Of rays that started a little ahead, each distance is the less by it.
    set.fartherTruth = set.truth;
    for (RayTruth& truth : set.fartherTruth) truth.t = 10.5f;
    EXPECT_DOUBLE_EQ(scoreTraces(set, traced, true).right02, 0.5);
}

// Ten viewpoints of ten rays, five of which are all right and five all wrong: as sure as ten throws of a coin, 1/2 sqrt(1/9), not as a
// hundred. Where each viewpoint has five right rays, nothing is unsure.
TEST(TraceScore, SharesAreAsSureAsTheirViewpoints)
{
    for (const bool together : {true, false})
    {
        RaySet set;
        set.diagonal = 100.0f;
        std::vector<TracedRay> traced;
        for (uint32_t i = 0; i < 100; ++i)
        {
            set.origins.emplace_back(0.0f);
            set.truth.push_back({.hit = true, .t = 10.0f});
            set.viewpoints.push_back(i / 10);
            const bool right = (together ? i / 10 : i) % 2 == 0;
            traced.push_back({right ? TraceStatus::hit : TraceStatus::miss, 10.0f});
        }
        const TraceScore score = scoreTraces(set, traced);
        EXPECT_DOUBLE_EQ(score.right1, 0.5);
        EXPECT_NEAR(score.right1Unsure, together ? 0.5 * std::sqrt(1.0 / 9.0) : 0.0, 1e-12);
        EXPECT_EQ(score.right02Unsure, score.right1Unsure);
        set.viewpoints.clear();
        EXPECT_EQ(scoreTraces(set, traced).right1Unsure, 0.0) << "nobody knows";
    }
}

// Nearest rank: the 95th of 100, the 19th of 20, and of fewer than 20 the last.
TEST(TraceScore, SpreadsAreNearestRanks)
{
    const auto spreadOf = [](uint32_t count)
    {
        RaySet set;
        set.diagonal = 1.0f;
        std::vector<TracedRay> traced;
        for (uint32_t i = count; i > 0; --i)
        {
            set.origins.emplace_back(0.0f);
            set.truth.emplace_back();
            traced.push_back({.status = TraceStatus::miss, .distanceReads = i});
        }
        return scoreTraces(set, traced).distanceReads;
    };
    for (const auto& [count, rank] : {std::pair{1u, 1u}, {2u, 2u}, {19u, 19u}, {20u, 19u}, {21u, 20u}, {100u, 95u}, {101u, 96u}})
    {
        EXPECT_EQ(spreadOf(count).p95, rank) << count;
        EXPECT_EQ(spreadOf(count).max, count);
        EXPECT_DOUBLE_EQ(spreadOf(count).mean, (count + 1) / 2.0);
    }
}

TEST(TraceScore, OfNoRaysIsNothing)
{
    const TraceScore score = scoreTraces({}, {});
    EXPECT_EQ(score.rays, 0u);
    EXPECT_EQ(score.right1 + score.right02 + score.falseHit + score.leak + score.unresolved, 0.0);
    EXPECT_EQ(score.handoffs.max, 0u);
}

} // namespace
} // namespace sconce
