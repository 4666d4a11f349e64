// Rays from and to the places where a decision flips: borders of charts, texels and cells, edges and vertices, odd numbers.
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_scenes.h"
#include "tests/properties/hard_cases/walk.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using glm::dvec3;

constexpr size_t kRays = 10000;
constexpr uint32_t kFace = 128; // texels a side: at the box's far end one of them is 1 % of its diagonal
const std::vector<vec3> kBoxProbes = {vec3(0.125f, -0.25f, 0.0625f), vec3(-0.375f, 0.125f, -0.125f)};

struct BorderScore
{
    size_t rays = 0, miss = 0, off = 0, unknown = 0;
    void add(const TracedRay& got, double truth, double tolerance)
    {
        ++rays;
        miss += got.status == TraceStatus::miss;
        unknown += got.status == TraceStatus::unknown;
        off += got.status == TraceStatus::hit && !(std::abs(got.t - truth) <= tolerance);
    }
    void expect(const std::string& name, double offBound, double unknownBound) const
    {
        expectAtMost(name + ": share that leaves the closed scene", rays, double(miss) / double(rays), 0.0);
        expectAtMost(name + ": share of hits off by over 1 %", rays, double(off) / double(rays), offBound);
        expectAtMost(name + ": share unknown", rays, double(unknown) / double(rays), unknownBound);
    }
};

const double kOnePercent = 0.01 * 2.0 * double(glm::length(kBoxHalf));

TEST(RayBorders, OriginsOnEdgesCornersAndDiagonalsOfChartsAndOnTexelBorders)
{
    HardScene box(closedBox(), kBoxProbes, kFace);
    Walk<float> walk(box.field, defaultQuality());
    twin::LightFieldTwin<float> text(box.field, defaultQuality());
    const char* names[] = {"origins on a chart's edge", "origins on a chart's corner", "origins on a face's diagonal",
                           "origins on texel borders"};
    for (int kind = 0; kind < 4; ++kind)
    {
        BorderScore score;
        for (size_t i = 0; i < kRays; ++i)
        {
            Random random(2, uint64_t(kind), i);
            const int face = int(i % 6);
            const auto border = [&] { return float(random.below(kFace + 1)) * 2.0f / float(kFace) - 1.0f; };
            const auto side = [&] { return random.below(2) ? 1.0f : -1.0f; };
            vec3 uvw(border(), border(), 1.0f);
            if (kind == 0) uvw.x = side();
            if (kind == 1) uvw.x = side(), uvw.y = side();
            if (kind == 2) uvw.y = side() * uvw.x;
            const vec3 origin = kBoxProbes[i % 2] + (random.below(2) ? 0.25f : 0.125f) * text.faceDirection(face, uvw);
            // any direction; away from the probe, so that the ray stays on the border; along the border
            vec3 d = unitVector(random);
            if (i % 3 == 1) d = glm::normalize(text.faceDirection(face, uvw));
            if (i % 3 == 2) d = text.faceDirection(face, i & 4 ? vec3(1, 0, 0) : vec3(0, 1, 0));
            score.add(walk.trace(origin, d), boxExit(origin, d, kBoxHalf), kOnePercent);
        }
        score.expect(names[kind], kHardlyAny, kHardlyAny);
    }
}

TEST(RayBorders, OriginsOnBordersOfOctreeCellsAndOnTheBounds)
{
    HardScene box(closedBox(), kBoxProbes, kFace);
    const gpu::LightFieldInfo& info = box.field.info;
    Walk<float> walk(box.field, defaultQuality());
    BorderScore cells, bounds;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(3, 0, i);
        vec3 p;
        for (int a = 0; a < 3; ++a)
        {
            const auto count = uint32_t((info.boundsHigh[a] - info.boundsLow[a]) / info.voxel);
            p[a] = (info.boundsLow[a] + float(1 + random.below(count - 1)) * info.voxel) * info.scale + info.origin[a];
            p[a] = glm::clamp(p[a], -0.99f * kBoxHalf[a], 0.99f * kBoxHalf[a]);
        }
        vec3 d = unitVector(random);
        if (i % 2) d = vec3(0.0f), d[int(i / 2 % 3)] = i % 4 < 2 ? 1.0f : -1.0f;
        cells.add(walk.trace(p, d), boxExit(p, d, kBoxHalf), kOnePercent);

        vec3 onWall = pointIn(random, -0.95f * kBoxHalf, 0.95f * kBoxHalf), inward = unitVector(random);
        const int axis = int(i % 3);
        onWall[axis] = i & 1 ? kBoxHalf[axis] : -kBoxHalf[axis];
        if (inward[axis] * onWall[axis] > 0.0f) inward = -inward;
        if (std::abs(inward[axis]) < 0.1f) continue; // grazing starts are reported apart
        bounds.add(walk.trace(onWall, inward), boxExit(onWall, inward, kBoxHalf), kOnePercent);
    }
    cells.expect("origins on octree cell borders", kHardlyAny, kHardlyAny);
    bounds.expect("origins exactly on a wall at the bounds", kHardlyAny, kHardlyAny);
}

TEST(RayBorders, OddNumbersGiveFiniteAnswers)
{
    HardScene box(closedBox(), kBoxProbes, kFace);
    twin::LightFieldTwin<float> text(box.field, defaultQuality());
    Walk<float> walk(box.field, defaultQuality());
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::array<float, 18> odd = {0.0f,  -0.0f, 1.0f,   -1.0f, NAN,    inf,  -inf,   1e-40f,  -1e-40f,
                                       1e30f, 3e38f, 1e-20f, 0.5f,  -0.25f, 1e9f, -1e18f, 1.0005f, 1e-45f};
    size_t bad = 0;
    for (size_t i = 0; i < 2 * kRays; ++i)
    {
        Random random(4, 0, i);
        const auto pick = [&] { return odd[random.below(uint32_t(odd.size()))]; };
        const auto any = [&]
        {
            const float x = pick(), y = pick(), z = pick();
            return vec3(x, y, z);
        };
        vec3 o = any(), d = any();
        if (i % 3 == 1) o = pointIn(random, -kBoxHalf, kBoxHalf); // odd direction only
        if (i % 3 == 2) d = unitVector(random);                   // odd origin only
        walk.trace(o, d);
        const auto hit = text.queryRay(o, d);
        for (const float value : {hit.t, hit.position.x, hit.position.y, hit.position.z, hit.normal.x, hit.normal.y, hit.normal.z,
                                  hit.radiance.x, hit.radiance.y, hit.radiance.z})
            bad += !std::isfinite(value);
        bad += hit.t < 0.0f;
    }
    expectAtMost("-0, denormals, zero-length, huge, NaN and Inf: numbers that are not finite", 2 * kRays, double(bad), 0.0);
    expectAtMost("-0, denormals, zero-length, huge, NaN and Inf: rays stopped by the limit", 2 * kRays, double(walk.limitReached), 0.0);
}

TEST(RayBorders, NegativeZeroAnswersLikeZeroToTheBit)
{
    HardScene box(closedBox(), kBoxProbes, kFace);
    Walk<float> walk(box.field, defaultQuality());
    size_t different = 0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(4, 1, i);
        vec3 o = pointIn(random, -0.9f * kBoxHalf, 0.9f * kBoxHalf), d = unitVector(random);
        d[int(i % 3)] = 0.0f;
        if (i & 1) o[int(i / 3 % 3)] = 0.0f;
        d = glm::normalize(d);
        vec3 o2 = o, d2 = d;
        for (int a = 0; a < 3; ++a)
        {
            if (o2[a] == 0.0f) o2[a] = -0.0f;
            if (d2[a] == 0.0f) d2[a] = -0.0f;
        }
        const TracedRay a = walk.trace(o, d), b = walk.trace(o2, d2);
        different += a.status != b.status || a.t != b.t || a.distanceReads != b.distanceReads;
    }
    expectAtMost("-0 in place of 0: rays answered otherwise", kRays, double(different), 0.0);
}

TEST(RayBorders, HitsAtZeroDistance)
{
    HardScene box(closedBox(), kBoxProbes, kFace);
    Walk<float> walk(box.field, defaultQuality());
    size_t through = 0, far = 0;
    double worst = 0.0;
    for (size_t i = 0; i < kRays; ++i)
    {
        Random random(4, 2, i);
        vec3 o = pointIn(random, -0.9f * kBoxHalf, 0.9f * kBoxHalf), d = unitVector(random);
        const int axis = int(i % 3);
        o[axis] = i & 1 ? kBoxHalf[axis] : -kBoxHalf[axis];
        if (d[axis] * o[axis] < 0.0f) d = -d; // out through the wall that the origin lies on
        if (std::abs(d[axis]) < 0.1f) continue;
        const TracedRay got = walk.trace(o, d);
        through += got.status == TraceStatus::miss;
        far += got.status == TraceStatus::hit && got.t > kOnePercent;
        if (got.status == TraceStatus::hit) worst = std::max(worst, double(got.t));
    }
    expectAtMost("rays into the wall they start on: share that leaves", kRays, double(through) / kRays, 0.0);
    expectAtMost("rays into the wall they start on: share of hits off by over 1 %", kRays, double(far) / kRays, 0.0);
    expectAtMost("rays into the wall they start on: worst t, metres", kRays, worst, 0.0068);
}

/// Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", in double precision, against every triangle: the truth where
/// rays meet edges and vertices exactly. Infinity: nothing is met.
double nearestByWoop(const Scene& scene, dvec3 origin, dvec3 direction)
{
    const dvec3 size = glm::abs(direction);
    const int kz = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    if (direction[kz] < 0.0) std::swap(kx, ky);
    const dvec3 shear(direction[kx] / direction[kz], direction[ky] / direction[kz], 1.0 / direction[kz]);
    double nearest = std::numeric_limits<double>::infinity();
    for (const uvec3& triangle : scene.triangles)
    {
        std::array<dvec3, 3> p;
        for (int c = 0; c < 3; ++c)
        {
            const dvec3 v = dvec3(scene.positions[triangle[c]]) - origin;
            p[size_t(c)] = {v[kx] - shear.x * v[kz], v[ky] - shear.y * v[kz], shear.z * v[kz]};
        }
        const double u = p[2].x * p[1].y - p[2].y * p[1].x, v = p[0].x * p[2].y - p[0].y * p[2].x, w = p[1].x * p[0].y - p[1].y * p[0].x;
        if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) continue;
        const double sum = u + v + w;
        if (sum == 0.0) continue;
        const double t = (u * p[0].z + v * p[1].z + w * p[2].z) / sum;
        if (t >= 0.0) nearest = std::min(nearest, t);
    }
    return nearest;
}

TEST(RayBorders, RaysAimedExactlyAtVerticesAndEdges)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.sphere(vec3(0.0f), 1.0f, 16, 10, mesh.material("wall", vec3(0.5f)));
    const std::vector<vec3> probes = {vec3(0.125f, -0.25f, 0.0625f), vec3(-0.375f, 0.125f, -0.125f), vec3(0.2f, 0.3f, 0.3f)};
    HardScene ball(std::move(scene), probes);
    Walk<float> walk(ball.field, defaultQuality());
    const double tolerance = 0.01 * double(ball.scene.bounds().diagonal());
    BorderScore vertices, edges;
    size_t truthless = 0;
    for (size_t i = 0; i < 2 * kRays; ++i)
    {
        Random random(5, 0, i);
        const vec3 origin = 0.8f * random.uniform() * unitVector(random);
        const uvec3 triangle = ball.scene.triangles[random.below(uint32_t(ball.scene.triangles.size()))];
        const vec3 a = ball.scene.positions[triangle[int(i % 3)]], b = ball.scene.positions[triangle[int((i + 1) % 3)]];
        const bool edge = i & 1;
        const vec3 d = glm::normalize((edge ? glm::mix(a, b, random.uniform()) : a) - origin);
        const double truth = nearestByWoop(ball.scene, origin, d);
        truthless += std::isinf(truth);
        (edge ? edges : vertices).add(walk.trace(origin, d), truth, tolerance);
    }
    EXPECT_EQ(truthless, 0u) << "the truth itself leaks";
    vertices.expect("rays aimed exactly at vertices", kHardlyAny, kHardlyAny);
    edges.expect("rays aimed exactly at edges", kHardlyAny, kHardlyAny);
}

} // namespace
} // namespace sconce
