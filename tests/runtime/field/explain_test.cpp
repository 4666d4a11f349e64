#include "runtime/field/explain.h"

#include <random>

#include <gtest/gtest.h>

#include "runtime/field/quality.h"
#include "scene/mesh_builder.h"
#include "tests/support/cornell_field.h"
#include "tests/support/lit_field.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

/// Two rooms with a wall of 1 cm between them, two probes in each.
Scene twoRooms()
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-2.0f, 0.0f, -1.0f), vec3(2.0f, 2.0f, 1.0f), white);
    mesh.box(vec3(-0.005f, 0.0f, -1.0f), vec3(0.005f, 2.0f, 1.0f), white);
    return scene;
}
const std::vector<vec3> kProbes = {{-1.0f, 1.0f, 0.0f}, {-0.6f, 0.6f, -0.3f}, {1.0f, 1.0f, 0.0f}, {0.5f, 1.2f, 0.3f}};

FieldData twoRoomsField()
{
    return testing_support::litField(twoRooms(), kProbes, [](vec3 p) { return 1.0f + p.y; });
}

TEST(Explain, ARayIsTheTracersAndItsWayHasNoGap)
{
    const FieldData& field = testing_support::cornell().field;
    Text text(field, Quality{}.trace);
    const RaySet rays = testing_support::cornellRays(2000);
    size_t met = 0, left = 0, handedOn = 0;
    for (size_t r = 0; r < rays.size(); ++r)
    {
        const gpu::Ray ray{rays.origins[r], rays.directions[r], rays.normals[r]};
        const ExplainedRay way = explainRay(field, ray);
        const gpu::RayHit hit = text.queryRay(ray.origin, ray.direction, ray.normal);
        ASSERT_EQ(way.hit.status, hit.status);
        ASSERT_EQ(way.hit.t, hit.t);
        ASSERT_EQ(way.hit.probe, hit.probe);
        ASSERT_EQ(way.hit.distanceReads, hit.distanceReads);
        ASSERT_EQ(way.way.size(), size_t(hit.handoffs) + 1) << "a stretch a probe";
        for (size_t i = 1; i < way.way.size(); ++i)
            EXPECT_LE(way.way[i].from, way.way[i - 1].to + 1e-4f) << "what one left the next takes up";
        if (way.way.size() == 1 && hit.status == Text::kHit)
        {
            EXPECT_EQ(way.way.back().end, StretchEnd::met);
        }
        if (hit.status == Text::kMiss)
        {
            EXPECT_EQ(way.way.back().end, StretchEnd::left);
        }
        met += way.way.back().end == StretchEnd::met ? 1 : 0;
        left += way.way.back().end == StretchEnd::left ? 1 : 0;
        handedOn += way.way.size() > 1 ? 1 : 0;
    }
    EXPECT_GT(met, 1000u);
    EXPECT_GT(left, 50u);
    EXPECT_GT(handedOn, 200u);
}

TEST(Explain, APointsLightIsTheFramesAndSharesAddUp)
{
    const FieldData field = twoRoomsField();
    Text text(field, Quality{}.trace);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> x(-1.9f, 1.9f), z(-0.9f, 0.9f);
    for (int i = 0; i < 500; ++i)
    {
        const vec3 point(x(random), 0.0f, z(random)), up(0.0f, 1.0f, 0.0f);
        const ExplainedSurface explained = explainSurface(field, point, up, up);
        const vec3 p = (point - field.info.origin) / field.info.scale;
        int reads = 0;
        const auto light = text.surfaceLightAt(p, up, up, p + 0.5f * field.info.voxel * up, reads);
        ASSERT_EQ(explained.from, light.probes);
        ASSERT_EQ(explained.light, light.light);
        float shares = 0.0f;
        vec3 sum(0.0f);
        int lighting = 0;
        for (const AskedProbe& asked : explained.asked)
        {
            shares += asked.share;
            sum += asked.share * asked.light;
            lighting += asked.verdict == Verdict::lights ? 1 : 0;
        }
        ASSERT_EQ(lighting, explained.from);
        EXPECT_NEAR(shares, 1.0f, 1e-5f);
        EXPECT_NEAR(sum.g, light.light.g, 1e-4f) << "the light is its probes', by their shares";
    }
}

// By closed forms: half way along is the wall, behind which the others stand.
TEST(Explain, AProbeBehindAWallIsHiddenByIt)
{
    const FieldData field = twoRoomsField();
    const vec3 point(-1.0f, 0.0f, 0.0f), up(0.0f, 1.0f, 0.0f);
    const ExplainedSurface explained = explainSurface(field, point, up, up);
    EXPECT_EQ(explained.from, 2);
    EXPECT_TRUE(explained.others.empty()) << "none of the other room sees it";
    EXPECT_EQ(probesThatSee(field, point, up), (std::vector<uint32_t>{1, 0})) << "nearest first";

    // From the other room, along the floor's level, to the wall's near side: 1 m of the way is free.
    const gpu::Ray ray{{0.9f, 0.5f, 0.0f}, {-1.0f, 0.0f, 0.0f}, vec3(0.0f)};
    const ExplainedRay way = explainRay(field, ray);
    ASSERT_FALSE(way.way.empty());
    EXPECT_EQ(way.way.back().end, StretchEnd::met);
    EXPECT_NEAR(way.hit.t, 0.895f, 0.01f);
}

TEST(Explain, VerdictsAreThoseOfPlacesMadeForThem)
{
    // One probe low in a room with a table: below the table's top it sees the floor, above it the walls alone.
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-1.0f, 0.0f, -1.0f), vec3(1.0f, 2.0f, 1.0f), white);
    mesh.box(vec3(-0.3f, 0.95f, -0.3f), vec3(0.3f, 1.0f, 0.3f), white);
    const FieldData field = testing_support::litField(scene, {{0.0f, 0.5f, 0.0f}}, [](vec3) { return 1.0f; });
    const vec3 up(0.0f, 1.0f, 0.0f);

    const ExplainedSurface below = explainSurface(field, {0.2f, 0.0f, 0.1f}, up, up);
    ASSERT_EQ(below.asked.size(), 1u);
    EXPECT_EQ(below.asked[0].verdict, Verdict::lights);
    EXPECT_NEAR(below.asked[0].distance, std::sqrt(0.25f + 0.05f), 1e-4f);
    EXPECT_EQ(below.from, 1);

    const ExplainedSurface top = explainSurface(field, {0.1f, 1.0f, 0.1f}, up, up);
    EXPECT_EQ(top.asked[0].verdict, Verdict::grazes) << "it is below the top";
    EXPECT_LT(top.asked[0].cosine, 0.0f);
    EXPECT_LE(top.from, 0);

    // The ceiling above the table: the table's underside is 0.45 m from the probe, in the middle straight on.
    const vec3 down(0.0f, -1.0f, 0.0f);
    const ExplainedSurface above = explainSurface(field, {0.0f, 2.0f, 0.0f}, down, down);
    ASSERT_EQ(above.asked[0].verdict, Verdict::hidden);
    EXPECT_NEAR(above.asked[0].seen, 0.45f, 0.002f);
    EXPECT_NE(above.asked[0].sentence().find("0.45 m"), std::string::npos) << above.asked[0].sentence();
    EXPECT_TRUE(probesThatSee(field, {0.0f, 2.0f, 0.0f}, down).empty());
}

TEST(Explain, AFieldWithoutSurfaceLightHasNothingToTell)
{
    const FieldData& field = testing_support::cornell().field;
    const ExplainedSurface explained = explainSurface(field, {0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
    EXPECT_TRUE(explained.asked.empty());
    EXPECT_EQ(explained.light, vec3(0.0f));
}

} // namespace
} // namespace sconce
