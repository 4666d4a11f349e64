// The tracer's shared text on the CPU, against Embree, closed forms and itself in double precision. Maps are cast by Embree.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "tests/support/cornell_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;

/// A closed box, its inside seen by one probe off its centre.
Scene closedBox(float scale, vec3 centre = vec3(0.0f))
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(centre - scale * vec3(1.0f, 0.8f, 0.6f), centre + scale * vec3(1.0f, 0.8f, 0.6f), mesh.material("wall", vec3(0.5f)));
    return scene;
}

template <class Real> std::vector<TracedRay> traceAll(const Traced& traced, const RaySet& set, const gpu::TraceQuality& quality)
{
    twin::LightFieldTwin<Real> text(traced.field, quality);
    using V = glm::vec<3, Real>;
    std::vector<TracedRay> out(set.size());
    for (size_t i = 0; i < set.size(); ++i)
    {
        const auto r = text.traceRay((V(set.origins[i]) - V(traced.field.info.origin)) / Real(traced.field.info.scale),
                                     V(set.directions[i]), V(set.normals[i]));
        out[i] = {TraceStatus(r.status), float(r.t * Real(traced.field.info.scale)), uint32_t(r.handoffs), uint32_t(r.distanceReads),
                  uint32_t(r.indexReads)};
    }
    return out;
}

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    return glm::normalize(vec3(normal(random), normal(random), normal(random)));
}

TEST(ProbeTrace, ClosedBoxFromOneProbeIsExact)
{
    Traced traced(closedBox(1.0f), std::vector{vec3(0.13f, -0.21f, 0.09f)}, 128);
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    std::mt19937 random(1);
    std::uniform_real_distribution<float> across(-0.95f, 0.95f);
    int beside = 0, turned = 0, unsure = 0; // texels that straddle an edge of the box know one of its two walls
    for (int i = 0; i < 20000; ++i)
    {
        const vec3 origin = vec3(across(random), 0.8f * across(random), 0.6f * across(random));
        const vec3 direction = randomDirection(random);
        const auto truth = traced.rays.closest(origin, direction);
        ASSERT_TRUE(truth);
        const auto hit = text.queryRay(origin, direction);
        ASSERT_NE(hit.status, 0u);
        unsure += hit.status == 2u; // no second probe to ask where two walls meet
        if (hit.status == 2u) continue;
        EXPECT_NEAR(hit.t, truth->t, 0.01f * traced.scene.bounds().diagonal());
        beside += std::abs(hit.t - truth->t) > 0.001f * traced.scene.bounds().diagonal();
        turned += std::abs(glm::dot(hit.normal, direction) + std::abs(glm::dot(truth->geometricNormal, direction))) > 0.05f;
    }
    EXPECT_LE(unsure, 20);
    EXPECT_LE(beside, 60);
    EXPECT_LE(turned, 600);
}

TEST(ProbeTrace, RaysThroughTheProbeAndAlongAxesAndDiagonals)
{
    const vec3 probe(0.125f, -0.25f, 0.0625f);
    Traced traced(closedBox(1.0f), std::vector{probe}, 128);
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
            {
                if (x == 0 && y == 0 && z == 0) continue;
                const vec3 direction = glm::normalize(vec3(x, y, z));
                for (const vec3 origin :
                     {probe, probe - 0.3f * direction, probe + 0.1f * direction, vec3(0.3f, 0.3f, 0.3f), probe + vec3(0.2f, 0.2f, 0.0f)})
                {
                    const auto truth = traced.rays.closest(origin, direction);
                    const auto hit = text.queryRay(origin, direction);
                    ASSERT_EQ(hit.status, 1u) << x << y << z;
                    EXPECT_NEAR(hit.t, truth->t, 0.02f) << x << y << z;
                }
            }
}

TEST(ProbeTrace, CornellIsRight)
{
    const RaySet set = cornellRays(20000);
    const TraceScore score = scoreTraces(set, traceAll<float>(cornell(), set, defaultQuality()));
    RecordProperty("right1", std::to_string(score.right1));
    // Found: 0.98965, 0.98765, 0.00115, 0.0008, 16.4.
    EXPECT_GE(score.right1, 0.988);
    EXPECT_GE(score.right02, 0.986);
    EXPECT_LE(score.leak, 0.002);
    EXPECT_LE(score.falseHit, 0.0015);
    EXPECT_LE(score.distanceReads.mean, 17.0);
}

// As under the table of town's kitchen, whose floor had mirrored the sun on the roof: what a probe out in the open sees there hides all of
// the room.
TEST(ProbeTrace, LostRayShowsWhatHidItInItsRoomNotTheRoof)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t plaster = mesh.material("plaster", vec3(0.5f));
    mesh.box({-2.0f, 0.0f, -2.0f}, {2.0f, 2.5f, 2.0f}, plaster);  // a room
    mesh.box({-0.8f, 0.3f, -0.8f}, {0.8f, 0.35f, 0.8f}, plaster); // a table in it
    mesh.box({8.0f, 0.0f, -1.0f}, {9.0f, 7.0f, 1.0f}, plaster);   // so that the scene goes on outside
    Traced traced(std::move(scene), std::vector{vec3(0.1f, 1.6f, -0.2f), vec3(0.4f, 6.0f, -0.3f)}, 128);
    // As where a window lets the probe outside see some of each voxel.
    const uint16_t marker = uint16_t(traced.field.info.marker), list[] = {0, 1, 0, 0};
    for (auto texel = traced.field.octree.texels.begin(); texel != traced.field.octree.texels.end(); texel += 4)
        if (texel[3] != marker) std::ranges::copy(list, texel);
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    std::mt19937 random(3);
    std::uniform_real_distribution<float> across(-0.5f, 0.5f);
    int lost = 0, named = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 origin(across(random), 0.1f, across(random));
        const auto hit = text.queryRay(origin, randomDirection(random));
        if (hit.status != 2u) continue;
        ++lost;
        named += hit.probe == 0;
    }
    RecordProperty("lost", std::to_string(lost));
    EXPECT_GE(lost, 1500);
    EXPECT_EQ(named, lost);
}

TEST(ProbeTrace, ResultDoesNotDependOnTheLevelsUsed)
{
    const RaySet set = cornellRays(5000);
    const auto expected = traceAll<float>(cornell(), set, defaultQuality());
    for (int coarsest : {0, 2, 4, 6})
        for (int start : {0, 2, 4})
        {
            if (start > coarsest) continue;
            gpu::TraceQuality quality = defaultQuality();
            quality.coarsestLevel = coarsest;
            quality.startLevel = start;
            const auto got = traceAll<float>(cornell(), set, quality);
            size_t different = 0;
            for (size_t i = 0; i < got.size(); ++i)
                different += got[i].status != expected[i].status || got[i].t != expected[i].t || got[i].handoffs != expected[i].handoffs;
            EXPECT_EQ(different, 0u) << "coarsest " << coarsest << " start " << start;
        }
}

TEST(ProbeTrace, ConfidenceIsAboutTheShareThatIsRight)
{
    const RaySet set = cornellRays(20000);
    const float tolerance = 0.002f * set.diagonal;
    twin::LightFieldTwin<float> text(cornell().field, defaultQuality());
    double sum = 0.0, right = 0.0, answered = 0.0, sure = 0.0, sureRight = 0.0;
    for (size_t i = 0; i < set.size(); ++i)
    {
        const gpu::RayHit hit = text.queryRay(set.origins[i], set.directions[i]);
        ASSERT_GE(hit.confidence, 0.0f);
        ASSERT_LE(hit.confidence, 1.0f);
        if (hit.status == 2u)
        {
            EXPECT_EQ(hit.confidence, 0.0f);
            continue;
        }
        const bool isRight = hit.status == 1u ? set.truth[i].hit && std::abs(hit.t - set.truth[i].t) <= tolerance : !set.truth[i].hit;
        ++answered;
        sum += hit.confidence;
        right += isRight;
        if (hit.confidence < 0.95f) continue;
        ++sure;
        sureRight += isRight;
    }
    EXPECT_NEAR(sum / answered, right / answered, 0.03);
    ASSERT_GT(answered - sure, 100.0);
    EXPECT_LT((right - sureRight) / (answered - sure), sureRight / sure);
}

TEST(ProbeTrace, FarBoundsChangeReadsAndNothingElse)
{
    const RaySet set = cornellRays(10000);
    const auto expected = traceAll<float>(cornell(), set, defaultQuality());
    gpu::TraceQuality quality = defaultQuality();
    quality.farBounds = 1;
    const auto got = traceAll<float>(cornell(), set, quality);
    size_t different = 0, reads = 0;
    for (size_t i = 0; i < got.size(); ++i)
    {
        different += got[i].status != expected[i].status || got[i].t != expected[i].t || got[i].handoffs != expected[i].handoffs;
        reads += got[i].distanceReads != expected[i].distanceReads;
    }
    EXPECT_EQ(different, 0u);
    EXPECT_GT(reads, set.size() / 100) << "the far bounds were not read";
}

/// How early an order asks a probe, by angles and distances in double precision: the smallest first.
double turnOf(int order, glm::dvec3 centre, glm::dvec3 at, glm::dvec3 direction)
{
    const double angle = std::acos(glm::dot(glm::normalize(at - centre), direction)); // of the ray off the way from the probe
    if (order == gpu::kOrderParallel) return std::min(angle, std::numbers::pi - angle);
    if (order == gpu::kOrderBehind) return angle;
    return glm::length(glm::cross(centre - at, direction));
}

// In an empty room each probe sees where a ray ends, so that the first that is asked answers.
TEST(ProbeTrace, OrdersAskFirstWhoTheyName)
{
    const std::vector<vec3> probes = {{0.4f, 0.3f, 0.2f}, {-0.5f, 0.2f, 0.1f}, {0.1f, -0.4f, -0.3f}, {-0.3f, -0.2f, 0.4f}};
    Traced traced(closedBox(1.0f), probes, 128);
    const gpu::LightFieldInfo& info = traced.field.info;
    gpu::TraceQuality quality = defaultQuality();
    quality.opinion = 0.0f;
    for (const int order : {gpu::kOrderParallel, gpu::kOrderBehind, gpu::kOrderNearestLine})
    {
        quality.order = order;
        twin::LightFieldTwin<float> text(traced.field, quality);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> across(-0.9f, 0.9f);
        int asked = 0, notRanked = 0;
        for (int i = 0; i < 5000; ++i)
        {
            const vec3 origin = vec3(across(random), 0.8f * across(random), 0.6f * across(random)), direction = randomDirection(random);
            const auto hit = text.queryRay(origin, direction);
            if (hit.handoffs > 0 || hit.status != 1u) continue;
            int reads = 0;
            const vec3 start = (origin - vec3(info.origin)) / info.scale;
            const glm::uvec4 list = text.rankedProbesAt(start + text.lookAhead(0) * info.voxel * direction, reads);
            std::vector<std::pair<double, uint32_t>> turns;
            for (int k = 0; k < gpu::kRanked; ++k) turns.push_back({turnOf(order, probes[list[k]], origin, direction), list[k]});
            std::ranges::sort(turns);
            const auto other = std::ranges::find_if(turns, [&](const auto& turn) { return turn.second != turns[0].second; });
            if (other != turns.end() && other->first - turns[0].first < 1e-4) continue; // float may turn those about
            ++asked;
            notRanked += turns[0].second != list[0];
            ASSERT_EQ(hit.probe, turns[0].second) << "order " << order << ", ray " << i;
        }
        EXPECT_GT(asked, 4500);
        EXPECT_GT(notRanked, 1000) << "the order is the list's own";
    }
}

// A wall of small steps far from one probe and near another: the far one's texels are as large as the steps.
TEST(ProbeTrace, SecondOpinionOfANearerProbeIsMoreExact)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t wall = mesh.material("wall", vec3(0.5f));
    mesh.box({-8, 0, -2}, {8, 3, 2}, wall);
    for (int i = 0; i < 20; ++i) // boxes of 5 to 15 cm on the far end
    {
        const float y = 0.15f * float(i), depth = 0.05f + 0.1f * float(i * 7 % 10) / 10.0f;
        mesh.box({8.0f - depth, y, -2.0f}, {8.0f, y + 0.075f, 2.0f}, wall);
    }
    Traced traced(std::move(scene), std::vector{vec3(-7.0f, 1.4f, 0.1f), vec3(6.5f, 1.6f, -0.2f)}, 64);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> across(-1.0f, 1.0f);
    std::vector<vec3> origins, directions;
    for (int i = 0; i < 4000; ++i)
    {
        const vec3 from(-6.0f + across(random), 1.5f + across(random), 1.5f * across(random));
        const vec3 to(8.0f, 1.5f + 1.4f * across(random), 1.9f * across(random));
        origins.push_back(from);
        directions.push_back(glm::normalize(to - from));
    }
    const RaySet set = raySetFrom(traced.rays, origins, directions);
    gpu::TraceQuality without = defaultQuality();
    without.opinion = 0.0f;
    const TraceScore one = scoreTraces(set, traceAll<float>(traced, set, without));
    const TraceScore two = scoreTraces(set, traceAll<float>(traced, set, defaultQuality()));
    EXPECT_GT(two.right02, one.right02 + 0.02);
    EXPECT_GE(two.right1, one.right1);
    EXPECT_LT(two.handoffs.mean, one.handoffs.mean + 1.0);
}

TEST(ProbeTrace, FloatAgreesWithDouble)
{
    const RaySet set = cornellRays(10000);
    const auto f = traceAll<float>(cornell(), set, defaultQuality());
    const auto d = traceAll<double>(cornell(), set, defaultQuality());
    size_t status = 0, far = 0;
    for (size_t i = 0; i < f.size(); ++i)
    {
        status += f[i].status != d[i].status;
        far += f[i].status == d[i].status && std::abs(f[i].t - d[i].t) > 1e-3f * d[i].t;
    }
    EXPECT_LE(status, f.size() / 1000);
    EXPECT_LE(far, f.size() / 500);
}

TEST(ProbeTrace, ScalingTheSceneByPowersOfTwoChangesNoBit)
{
    const RaySet set = cornellRays(3000);
    const auto expected = traceAll<float>(cornell(), set, defaultQuality());
    for (float scale : {0.0078125f, 128.0f})
    {
        Scene scene = *makeBuiltinScene("cornell-glossy");
        for (vec3& p : scene.positions) p *= scale;
        std::vector<vec3> probes = kCornellProbes;
        for (vec3& p : probes) p *= scale;
        Traced traced(std::move(scene), probes, 128);
        RaySet scaled = set;
        for (vec3& o : scaled.origins) o *= scale;
        const auto got = traceAll<float>(traced, scaled, defaultQuality());
        size_t different = 0; // Embree's own distances may differ in the last bit
        for (size_t i = 0; i < got.size(); ++i)
            different += got[i].status != expected[i].status || std::abs(got[i].t - expected[i].t * scale) > 1e-4f * scale;
        EXPECT_LE(different, got.size() / 300) << scale;
    }
}

TEST(ProbeTrace, WallOnTheBoundsStopsRays)
{
    // Rays that end exactly on a wall that is the scene's border, from far away and near.
    Traced traced(closedBox(1.0f), std::vector{vec3(0.0f)}, 64);
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    std::mt19937 random(4);
    std::uniform_real_distribution<float> across(-0.5f, 0.5f);
    for (int i = 0; i < 5000; ++i)
    {
        const vec3 target(1.0f, across(random), across(random)), origin(-0.99f, across(random), across(random));
        EXPECT_EQ(text.queryRay(origin, glm::normalize(target - origin)).status, 1u);
    }
}

TEST(ProbeTrace, SkyIsAMiss)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.quad({-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}, mesh.material("ground", vec3(0.5f)));
    mesh.box({-1, 0, -1}, {1, 1, 1}, 0);
    scene.sky = vec3(2.0f, 3.0f, 4.0f);
    Traced traced(std::move(scene), std::vector{vec3(2.5f, 0.6f, 0.3f), vec3(-2.5f, 0.6f, 0.3f)}, 64);
    traced.field.info.sky = traced.scene.sky;
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    const auto hit = text.queryRay(vec3(2.0f, 0.5f, 2.0f), glm::normalize(vec3(0.2f, 1.0f, 0.1f)));
    EXPECT_EQ(hit.status, 0u);
    EXPECT_EQ(vec3(hit.radiance), traced.scene.sky);
}

TEST(ProbeTrace, AnyRayEndsWithFiniteNumbers)
{
    Traced& traced = cornell();
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    const float nan = std::nanf(""), inf = INFINITY, tiny = 1e-40f;
    const std::vector<float> odd = {0.0f, -0.0f, 1.0f, -1.0f, nan, inf, -inf, tiny, 1e30f, 0.5f};
    std::mt19937 random(9);
    auto pick = [&] { return odd[random() % odd.size()]; };
    for (int i = 0; i < 20000; ++i)
    {
        const vec3 origin(pick(), pick(), pick()), direction(pick(), pick(), pick());
        const auto hit = text.queryRay(origin, direction);
        EXPECT_TRUE(std::isfinite(hit.t) && std::isfinite(hit.position.x + hit.position.y + hit.position.z));
        EXPECT_TRUE(std::isfinite(hit.normal.x + hit.normal.y + hit.normal.z));
        EXPECT_LE(hit.handoffs, 24);
        EXPECT_LT(hit.distanceReads, 20000);
    }
}

TEST(ProbeTrace, ThinSheetIsNotPassedFromEitherSide)
{
    Scene scene = closedBox(1.0f);
    MeshBuilder mesh(scene);
    mesh.quad({0, -0.8f, 0.6f}, {0, -0.8f, -0.6f}, {0, 0.8f, -0.6f}, {0, 0.8f, 0.6f}, 0); // one triangle pair without thickness
    Traced traced(std::move(scene), std::vector{vec3(-0.5f, 0.1f, 0.0f), vec3(0.5f, -0.1f, 0.1f)}, 128);
    twin::LightFieldTwin<float> text(traced.field, defaultQuality());
    std::mt19937 random(12);
    std::uniform_real_distribution<float> along(-0.7f, 0.7f), off(1e-3f, 0.9f);
    int wrong = 0;
    for (int i = 0; i < 20000; ++i)
    {
        const float side = i % 2 ? 1.0f : -1.0f;
        const vec3 origin(side * off(random), along(random), 0.7f * along(random));
        const vec3 direction = randomDirection(random);
        const auto truth = traced.rays.closest(origin, direction);
        const auto hit = text.queryRay(origin, direction);
        wrong += hit.status != 1u || std::abs(hit.t - truth->t) > 0.01f * traced.scene.bounds().diagonal();
    }
    EXPECT_LE(wrong, 100); // 0.5 %
}

/// Shares of shadow rays between surface points of the box, and out of it, that Embree answers otherwise: lit wrongly, dark wrongly.
struct ShadowErrors
{
    double lit = 0.0, dark = 0.0;
};

ShadowErrors shadowErrors(bool outside)
{
    const Traced& box = cornell();
    twin::LightFieldTwin<float> text(box.field, defaultQuality());
    const float diagonal = glm::length(box.scene.bounds().high - box.scene.bounds().low);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const auto somewhere = [&] { return glm::normalize(vec3(normal(random), normal(random), normal(random))); };
    ShadowErrors errors;
    int asked = 0;
    while (asked < 5000)
    {
        const vec3 eye = kCornellProbes[asked % kCornellProbes.size()];
        const auto start = box.rays.closest(eye, somewhere()), end = box.rays.closest(eye, somewhere());
        if (!start || !end) continue;
        const vec3 side = glm::dot(start->geometricNormal, eye - start->position) < 0.0f ? -start->geometricNormal : start->geometricNormal;
        const vec3 point = start->position + 1e-4f * diagonal * side;
        vec3 direction = somewhere();
        float far = 1e30f;
        if (!outside)
        {
            far = glm::distance(point, end->position);
            direction = (end->position - point) / far;
        }
        if (glm::dot(direction, side) < 0.05f || far < 0.05f * diagonal) continue;
        ++asked;
        const bool free = !box.rays.occluded(point, direction, outside ? 1e30f : far - 0.005f * diagonal);
        const bool lit = text.lightReaches(point, direction, far, side);
        errors.lit += lit && !free;
        errors.dark += !lit && free;
    }
    errors.lit /= asked;
    errors.dark /= asked;
    return errors;
}

TEST(LightReaches, ShadowRaysBetweenSurfacesAndToTheSkyAgreeWithEmbree)
{
    for (const bool outside : {false, true})
    {
        const ShadowErrors errors = shadowErrors(outside);
        RecordProperty(outside ? "sky, lit" : "surface, lit", std::to_string(errors.lit));
        RecordProperty(outside ? "sky, dark" : "surface, dark", std::to_string(errors.dark));
        EXPECT_LT(errors.lit, 0.005) << outside;
        EXPECT_LT(errors.dark, 0.01) << outside;
    }
}

} // namespace
} // namespace sconce
