// The hazards that a tracer of probe maps is known to fall into, one test each; the ones met elsewhere are named in docs/limits.md.
#include <cmath>

#include <gtest/gtest.h>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"
#include "tests/support/cornell_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr size_t kRays = 10000;
const std::vector<vec3> kBoxProbes = {vec3(0.125f, -0.25f, 0.0625f), vec3(-0.375f, 0.125f, -0.125f)};

TraceScore scoreOf(const HardScene& scene, std::span<const vec3> origins, std::span<const vec3> directions)
{
    const RaySet set = raySetFrom(scene.rays, origins, directions);
    Walk<float> walk(scene.field, defaultQuality());
    return scoreTraces(set, walkAll(walk, set));
}

/// Rays against the closed form of a box: shares of misses, of answers off by more than 1 % of the diagonal, of unknown.
struct BoxScore
{
    double miss = 0.0, off = 0.0, unknown = 0.0;
    size_t rays = 0;
    void add(const TracedRay& got, double truth)
    {
        ++rays;
        miss += got.status == TraceStatus::miss;
        unknown += got.status == TraceStatus::unknown;
        off += got.status == TraceStatus::hit && !(std::abs(got.t - truth) <= 0.01 * 2.0 * glm::length(kBoxHalf));
    }
};

void expectBox(const std::string& name, const BoxScore& score, double off = kHardlyAny)
{
    const auto rays = double(score.rays);
    expectAtMost(name + ": share that leaves the closed box", score.rays, score.miss / rays, 0.0);
    expectAtMost(name + ": share of hits off by over 1 %", score.rays, score.off / rays, off);
    expectAtMost(name + ": share unknown", score.rays, score.unknown / rays, kHardlyAny);
}

TEST(RayHazards, BoundaryPastInfinityLeaksNothingInCornell)
{
    const HardScene cornell(*makeBuiltinScene("cornell"), kCornellProbes, 256, 64);
    const RaySet set = glossyRaysOf(cornell, kRays);
    Walk<float> walk(cornell.field, defaultQuality());
    expectAtMost("cornell, glossy rays: leak", kRays, scoreTraces(set, walkAll(walk, set)).leak, 0.0004);
}

TEST(RayHazards, RaysThatEndExactlyOnTheBoundsAreStopped)
{
    HardScene box(closedBox(), kBoxProbes);
    Walk<float> walk(box.field, defaultQuality());
    BoxScore score;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(1, 1, i);
        const vec3 origin = pointIn(random, -0.98f * kBoxHalf, 0.98f * kBoxHalf);
        vec3 target = pointIn(random, -0.9f * kBoxHalf, 0.9f * kBoxHalf);
        const int axis = int(i % 3);
        target[axis] = i % 2 ? kBoxHalf[axis] : -kBoxHalf[axis];
        const vec3 d = glm::normalize(target - origin);
        score.add(walk.trace(origin, d), boxExit(origin, d, kBoxHalf));
    }
    expectBox("rays that end exactly on the bounds", score);
}

TEST(RayHazards, RaysThroughAndFromTheProbeCentreAlongAxesAndDiagonals)
{
    HardScene box(closedBox(), kBoxProbes);
    Walk<float> walk(box.field, defaultQuality());
    BoxScore score;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(1, 2, i);
        const vec3 probe = kBoxProbes[i % 2];
        vec3 d;
        do d = vec3(int(random.below(3)) - 1, int(random.below(3)) - 1, int(random.below(3)) - 1);
        while (d == vec3(0.0f));
        if (i % 4 == 0) d = unitVector(random); // any direction, but through the centre
        d = glm::normalize(d);
        const float back[] = {0.0f, 0.0625f, 0.03125f, -0.0625f, -1e-7f};
        const vec3 origin = probe - back[i % 5] * d;
        score.add(walk.trace(origin, d), boxExit(origin, d, kBoxHalf));
    }
    expectBox("rays through and from probe centres", score);
}

TEST(RayHazards, RaysInThePlanesBetweenFacesOfAProbe)
{
    HardScene box(closedBox(), kBoxProbes);
    Walk<float> walk(box.field, defaultQuality());
    BoxScore score;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(1, 3, i);
        const vec3 probe = kBoxProbes[i % 2];
        const int a = int(i % 3), b = (a + 1) % 3, c = (a + 2) % 3;
        const float sign = i % 4 < 2 ? 1.0f : -1.0f;
        vec3 off(0.0f), d = unitVector(random);
        off[a] = 0.25f * (random.uniform() - 0.5f);
        off[b] = sign * off[a]; // |a| = |b| exactly, origin and direction
        off[c] = 0.25f * (random.uniform() - 0.5f);
        d[b] = sign * d[a];
        d = glm::normalize(d);
        d[b] = sign * d[a];
        const vec3 origin = probe + off;
        score.add(walk.trace(origin, d), boxExit(origin, d, kBoxHalf));
    }
    expectBox("rays in the planes between a probe's faces", score, 0.0004);
}

// A texel of these maps is 2 to 3 cm there: what starts nearer to a sheet than that may be taken for a start on the sheet's other side by a
// probe of that side.
/// A point on one of curtains()'s strips and the strip's unit normal.
std::pair<vec3, vec3> pointOnCurtain(Random& random, int curtain)
{
    const auto edge = [&](int strip)
    {
        const float x = float(1 + curtain), z = 0.5f + 3.0f * float(strip) / float(kCurtainStrips);
        return vec3(x + 0.12f * std::sin(9.0f * z + 4.0f * x), 0.2f, z);
    };
    const int strip = std::min(int(float(kCurtainStrips) * random.uniform()), kCurtainStrips - 1);
    const vec3 from = edge(strip), to = edge(strip + 1);
    const vec3 point = glm::mix(from, to, 0.1f + 0.8f * random.uniform()) + vec3(0.0f, 2.2f * random.uniform(), 0.0f);
    return {point, glm::normalize(glm::cross(vec3(0.0f, 1.0f, 0.0f), to - from))};
}

TEST(RayHazards, OriginsBehindWavySheetsWithoutThickness)
{
    struct Case
    {
        const char* name;
        float low, high; // metres off the sheet
        bool normals;    // whether rays know the side they start on
        double falseHits, leaks;
    };
    for (const Case& test : {Case{"rays from 4 to 10 cm off curtains", 0.04f, 0.1f, false, 0.001, 0.0045},
                             Case{"rays from 0.3 to 3 cm off curtains", 0.003f, 0.03f, false, 0.0038, 0.05},
                             Case{"rays from 0.3 to 3 cm off curtains, with the normal", 0.003f, 0.03f, true, 0.0024, 0.0028},
                             Case{"rays from 1 mm off curtains, with the normal", 0.001f, 0.001f, true, 0.0018, 0.005}})
    {
        static const auto scene = hardScene("curtains");
        std::vector<vec3> origins, directions, normals;
        for (size_t i = 0; i < kRays; ++i)
        {
            Random random(1, 8, i);
            const auto [point, normal] = pointOnCurtain(random, int(i % 3));
            normals.push_back((i & 1) != 0 ? normal : -normal);
            origins.push_back(point + glm::mix(test.low, test.high, random.uniform()) * normals.back());
            directions.push_back(unitVector(random));
        }
        RaySet set = raySetFrom(scene->rays, origins, directions);
        if (test.normals) set.normals = normals;
        Walk<float> walk(scene->field, defaultQuality());
        const TraceScore score = scoreTraces(set, walkAll(walk, set));
        expectAtMost(std::string(test.name) + ": false hits", kRays, score.falseHit, test.falseHits);
        expectAtMost(std::string(test.name) + ": leaks", kRays, score.leak, test.leaks, 0.01);
    }
}

TEST(RayHazards, RaysAimedWithinATexelOfSilhouettes)
{
    Scene scene = closedBox(2.0f);
    MeshBuilder mesh(scene);
    mesh.box({-0.25f, -0.25f, -0.25f}, {0.25f, 0.25f, 0.25f}, 0);
    const std::vector<vec3> probes = {vec3(-1.2f, 0.7f, 0.4f), vec3(1.1f, -0.8f, 0.5f), vec3(0.3f, 0.9f, -0.6f), vec3(-0.6f, -0.9f, -0.5f)};
    HardScene box(std::move(scene), probes);
    std::vector<vec3> origins, directions;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(1, 5, i);
        vec3 origin = pointIn(random, -1.9f * kBoxHalf, 1.9f * kBoxHalf);
        if (glm::all(glm::lessThan(glm::abs(origin), vec3(0.3f)))) origin.x += 0.8f;
        vec3 edge(random.uniform() - 0.5f, i & 1 ? 0.25f : -0.25f, i & 2 ? 0.25f : -0.25f);
        edge = vec3(0.5f * edge.x, edge.y, edge.z);
        const int turn = int(i % 3);
        const vec3 target = turn == 0 ? edge : (turn == 1 ? vec3(edge.z, edge.x, edge.y) : vec3(edge.y, edge.z, edge.x));
        const float texel = glm::distance(origin, target) * 2.0f / 64.0f;
        origins.push_back(origin);
        directions.push_back(glm::normalize(target + texel * (2.0f * random.uniform() - 1.0f) * unitVector(random) - origin));
    }
    const TraceScore score = scoreOf(box, origins, directions);
    expectAtMost("rays within a texel of silhouettes: false hits", kRays, score.falseHit, 0.08);
    expectAtMost("rays within a texel of silhouettes: leaks", kRays, score.leak, 0.03);
    expectAtMost("rays within a texel of silhouettes: unknown", kRays, score.unresolved, 0.04);
}

TEST(RayHazards, ScalingByAHundredthAndAHundredChangesNoScore)
{
    double right[3] = {};
    int index = 0;
    for (const float scale : {1.0f, 0.01f, 100.0f})
    {
        Scene scene = *makeBuiltinScene("cornell");
        for (vec3& p : scene.positions) p *= scale;
        for (Camera& camera : scene.cameras) camera.eye *= scale;
        HardScene scaled(std::move(scene), 8);
        const RaySet set = glossyRaysOf(scaled, kRays);
        Walk<float> walk(scaled.field, defaultQuality());
        right[index++] = scoreTraces(set, walkAll(walk, set)).right1;
    }
    // With five sets of rays 0.003 to 0.005; 0.01 and 100 agree with each other within 0.001. Why scale 1 differs was not looked into.
    expectAtMost("scene x0.01 and x100: change of the share right", 3 * kRays,
                 std::max(std::abs(right[1] - right[0]), std::abs(right[2] - right[0])), 0.006, 0.002);
}

TEST(RayHazards, EveryRayEndsWithinDerivedBounds)
{
    const auto scene = hardScene("curtains");
    const gpu::TraceQuality quality = defaultQuality();
    Walk<float> walk(scene->field, quality);
    for (size_t i = 0; i < 3 * kRays; ++i)
    {
        Random random(1, 6, i);
        vec3 d = unitVector(random);
        if (i % 3 == 1) d[int(i / 3 % 3)] = 0.0f;                                        // in a plane of two axes
        if (i % 3 == 2) d = glm::normalize(d * vec3(1.0f, 1e-6f, i & 1 ? 1e-7f : 1.0f)); // grazing
        walk.trace(pointIn(random, vec3(-1.0f), vec3(5.0f, 4.0f, 5.0f)), glm::normalize(d));
    }
    expectAtMost("every ray ends: rays stopped by the limit of turns", walk.rays, double(walk.limitReached), 0.0);
    expectAtMost("every ray ends: turns, share of the derived limit", walk.rays, walk.worstTurns, 0.0022); // beyond 1 it would be stopped
    expectAtMost("every ray ends: times t falls outside a second opinion", walk.rays, double(walk.fallsOutsideOpinions), 0.0);
    expectAtMost("every ray ends: times t falls in a ray", walk.rays, walk.worstFalls, 2.0);
    expectAtMost("every ray ends: numbers that are not finite", walk.rays, double(walk.notFinite), 0.0);
}

TEST(RayHazards, RaysFromVoxelsThatNoProbeSees)
{
    Scene scene = closedBox(2.0f);
    MeshBuilder mesh(scene);
    mesh.box({0.5f, -0.5f, -0.5f}, {1.5f, 0.5f, 0.5f}, 0); // a room without a probe
    const std::vector<vec3> probes = {vec3(-1.0f, 0.3f, 0.2f), vec3(-1.2f, -0.4f, -0.3f)};
    HardScene box(std::move(scene), probes);
    Walk<float> walk(box.field, defaultQuality());
    size_t left = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(1, 7, i);
        const vec3 origin = pointIn(random, vec3(0.51f, -0.49f, -0.49f), vec3(1.49f, 0.49f, 0.49f));
        left += walk.trace(origin, unitVector(random)).status == TraceStatus::miss;
    }
    expectAtMost("rays from a sealed room no probe sees: share that says it left the scene", kRays, double(left) / kRays, 0.0);
    expectAtMost("rays from a sealed room no probe sees: rays stopped by the limit", kRays, double(walk.limitReached), 0.0);
}

} // namespace
} // namespace sconce
