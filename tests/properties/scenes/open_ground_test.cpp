// A viewer may walk anywhere on open ground, and rays from there must be answered, too.
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "bench/reference/ray_scene.h"
#include "placement/place.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "tests/support/field_by_rays.h"

namespace sconce
{
namespace
{

using namespace testing_support;

struct Answers // shares of rays
{
    double right = 0.0, unresolved = 0.0;
};

/// Rays in all directions from where a viewer of 1.7 m stands, anywhere on the scene.
Answers fromStandingPoints(const Scene& scene, const RayScene& rays, const FieldData& field)
{
    constexpr int kRays = 20000;
    const Bounds box = scene.bounds();
    twin::LightFieldTwin<float> text(field, defaultQuality());
    Answers answers;
    int asked = 0;
    for (uint64_t i = 0; asked < kRays; ++i)
    {
        Random random(9, i);
        const vec2 at = random.uniform2();
        const vec3 above(box.low.x + at.x * box.size().x, box.high.y + 1.0f, box.low.z + at.y * box.size().z);
        const auto ground = rays.closest(above, {0.0f, -1.0f, 0.0f});
        if (!ground) continue;
        const vec3 eye = ground->position + vec3(0.0f, 1.7f, 0.0f), direction = random.direction();
        const auto truth = rays.closest(eye, direction);
        const gpu::RayHit hit = text.queryRay(eye, direction);
        ++asked;
        answers.unresolved += hit.status == 2;
        answers.right += truth ? hit.status == 1 && std::abs(hit.t - truth->t) < 0.01f * box.diagonal() : hit.status == 0;
    }
    answers.unresolved /= kRays;
    answers.right /= kRays;
    return answers;
}

TEST(OpenGround, RaysFromWhereOneMayStandAreAnswered)
{
    const Scene scene = *makeBuiltinScene("plain");
    const RayScene rays = std::move(*RayScene::create(scene));
    Answers found[2];
    float leftOut[2];
    for (const bool ground : {false, true})
    {
        PlaceSettings settings;
        settings.count = 96;
        settings.voxels = 1u << 20;
        settings.candidates = 800;
        settings.surfels = settings.refineSurfels = 8000;
        if (!ground) settings.open.ground = 0.0f; // else as it is by default: hardly any of it is enclosed
        PlaceReport report;
        const auto set = placeProbes(scene, settings, report);
        ASSERT_TRUE(set) << set.error().message;
        EXPECT_EQ(report.ground, ground ? kStanding : 0.0f);
        std::vector<vec3> positions;
        for (const PlacedProbe& probe : set->probes) positions.push_back(probe.position);
        found[ground] = fromStandingPoints(scene, rays, fieldByRays(rays, positions, 64));
        leftOut[ground] = report.surfaceLeftOut;
        RecordProperty(ground ? "ground: unresolved, right, left out" : "enclosed: unresolved, right, left out",
                       std::to_string(found[ground].unresolved) + " " + std::to_string(found[ground].right) + " " +
                           std::to_string(leftOut[ground]));
    }
    EXPECT_LT(found[1].unresolved, 0.02);
    EXPECT_LT(found[1].unresolved, found[0].unresolved);
    EXPECT_GT(found[1].right, found[0].right);
    EXPECT_GT(leftOut[0], 0.9f) << "placement says what it doesn't answer for";
    EXPECT_LT(leftOut[1], 0.1f);
}

} // namespace
} // namespace sconce
