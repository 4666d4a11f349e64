#include "runtime/field/probe_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"
#include "tests/support/field_by_rays.h"

namespace sconce
{
namespace
{

FieldData boxSeenFrom(const std::vector<vec3>& probes, float wall = 0.0f)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-1.0f), vec3(1.0f), white);
    if (wall > 0.0f) mesh.box(vec3(-wall, -1.0f, -1.0f), vec3(wall, 1.0f, 1.0f), white);
    const RayScene rays = std::move(*RayScene::create(scene));
    return testing_support::fieldByRays(rays, probes, 96);
}

// The inside of a cube of 2 m, from its middle: 24 m^2, from 1 m off to its corners.
TEST(ProbeView, OfABoxHasItsClosedForms)
{
    const ProbeView view = viewOfProbe(boxSeenFrom({vec3(0.0f)}), 0, 256);
    EXPECT_EQ(view.width, 256u);
    EXPECT_EQ(view.height, 128u);
    EXPECT_EQ(view.sky, 0.0f);
    EXPECT_NEAR(view.area, 24.0f, 0.05f);
    EXPECT_NEAR(view.areaAlone, view.area, 1e-4f) << "there is no other";
    EXPECT_NEAR(view.nearest, 1.0f, 0.002f);
    EXPECT_NEAR(view.farthest, std::sqrt(3.0f), 0.03f) << "the texel at a corner is of 96";
    EXPECT_EQ(view.first, 1.0f);
    EXPECT_EQ(view.named, 1.0f);
    const auto at = [&](uint32_t x, uint32_t y) { return y * view.width + x; };
    const auto isNear = [](vec3 a, vec3 b) { return glm::distance(a, b) < 0.02f; };
    EXPECT_TRUE(isNear(view.normal[at(128, 64)], {0, 0, 1})) << "the middle looks towards -z";
    EXPECT_TRUE(isNear(view.normal[at(192, 64)], {-1, 0, 0})) << "a quarter to the right towards +x";
    EXPECT_TRUE(isNear(view.normal[at(128, 0)], {0, -1, 0})) << "the top is up";
}

// Two in one half of the box and one in the other, which a wall parts: that one alone sees its half.
TEST(ProbeView, AloneIsWhatNoOtherSees)
{
    const FieldData field = boxSeenFrom({{-0.5f, 0.0f, 0.2f}, {-0.4f, 0.3f, -0.3f}, {0.5f, 0.0f, 0.0f}}, 0.05f);
    const ProbeView first = viewOfProbe(field, 0, 128), last = viewOfProbe(field, 2, 128);
    const float half = 2.0f * (4.0f + 2.0f * 0.95f * 2.0f); // m^2, of a half's six sides
    EXPECT_NEAR(first.area, half, 0.2f) << "by pixels of 2.8 degrees";
    EXPECT_LT(first.areaAlone, 0.02f * half) << "but for what the other sees too flatly";
    EXPECT_NEAR(last.area, half, 0.2f);
    EXPECT_NEAR(last.areaAlone, last.area, 1e-3f);
    EXPECT_NEAR(last.first, 0.5f, 0.1f);
}

// One that stands in the open sees sky above, and a floor below that a second one sees, too.
TEST(ProbeView, SkyIsAShareOfAllDirections)
{
    Scene scene;
    MeshBuilder mesh(scene);
    scene.sky = vec3(0.25f, 0.5f, 1.0f);
    mesh.box(vec3(-50.0f, -1.0f, -50.0f), vec3(50.0f, 0.0f, 50.0f), mesh.material("ground", vec3(0.5f)));
    const RayScene rays = std::move(*RayScene::create(scene));
    FieldData field = testing_support::fieldByRays(rays, std::vector<vec3>{{0.0f, 1.0f, 0.0f}}, 96);
    field.info.sky = scene.sky;
    const ProbeView view = viewOfProbe(field, 0, 128);
    EXPECT_NEAR(view.sky, 0.5f + 0.5f / std::sqrt(1.0f + 2500.0f), 0.02f) << "all above the plate, and what is seen past its rim";
    EXPECT_EQ(view.radiance[64], scene.sky);
    EXPECT_EQ(view.depth[64], 0.0f);
}

} // namespace
} // namespace sconce
