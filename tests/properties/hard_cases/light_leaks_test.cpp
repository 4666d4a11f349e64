// Light where none may be: a dark room behind walls of 1 to 20 cm, the sun outside. Probes as the default placement sets them.
#include <gtest/gtest.h>

#include "placement/place.h"
#include "runtime/bake/bake.h"
#include "runtime/scene/scene_renderer.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_frames.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using namespace testing_support;

class LightLeaks : public DeviceTest, public testing::WithParamInterface<int>
{
};

/// A room without an opening on a sunlit yard with a wall about it.
Scene darkRoom(float wall)
{
    Scene scene;
    scene.name = "dark room";
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.7f), 0.3f);
    BlockSolid solid;
    solid.fill({-3, -0.3f, -3}, {9, 0, 3}, white); // ground
    solid.fill({-3, 0, -3}, {9, 1.5f, -2.8f}, white);
    solid.fill({8.8f, 0, -3}, {9, 1.5f, 3}, white);
    solid.fill({-2 - wall, 0, -2 - wall}, {2 + wall, 2.5f + wall, 2 + wall}, white);
    solid.carve({-2, 0, -2}, {2, 2.5f, 2});
    solid.addTo(mesh);
    Light sun;
    sun.direction = glm::normalize(vec3(-0.6f, -0.7f, -0.35f)); // on the room's wall at +x, its roof and the ground before it
    sun.intensity = vec3(10.0f);
    scene.lights.push_back(sun);
    mesh.camera("dark", {-1.5f, 1.3f, -1.2f}, {2.0f, 1.1f, 0.4f}, 75.0f);
    mesh.camera("lit", {7.0f, 1.3f, 1.5f}, {2.0f, 0.7f, 0.0f}, 60.0f);
    return scene;
}

TEST_P(LightLeaks, DarkRoomStaysDark)
{
    const float wall = 0.01f * float(GetParam());
    const Scene scene = darkRoom(wall);
    PlaceSettings place;
    place.inside = {vec3(0.0f, 1.2f, 0.0f), vec3(5.5f, 1.0f, 0.0f)};
    PlaceReport placed;
    const auto probes = placeProbes(scene, place, placed);
    ASSERT_TRUE(probes) << probes.error().message;
    std::vector<vec3> positions;
    for (const PlacedProbe& probe : probes->probes) positions.push_back(probe.position);
    BakeSettings settings;
    settings.resolution = 256;
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays) << rays.error().message;
    settings.rays = &*rays; // as `sconce bake` does by default
    BakeReport report;
    const auto field = bakeLightField(gpu(), scene, positions, settings, {}, report);
    ASSERT_TRUE(field) << field.error().message;
    const auto device = DeviceScene::create(gpu(), scene, field->info);
    ASSERT_TRUE(device) << device.error().message;
    const auto light = makeLightField(gpu(), *field);
    ASSERT_TRUE(light) << light.error().message;
    RenderSettings render;
    render.width = render.height = 112; // 12,544 pixels, a glossy ray each
    const auto renderer = SceneRenderer::create(gpu(), *device, *light, render);
    ASSERT_TRUE(renderer) << renderer.error().message;
    const auto dark = (*renderer)->render(scene.cameras[0]), lit = (*renderer)->render(scene.cameras[1]);
    ASSERT_TRUE(dark && lit);
    EXPECT_GT(mean(lit->diffuseIndirect), 0.05);
    EXPECT_GT(mean(lit->glossyIndirect), 0.005);
    // Found behind 1 cm 3e-4 of reflections, behind more none: there the bounds are what no eye can see.
    const bool thin = GetParam() == 1;
    const std::string name = "wall of " + std::to_string(GetParam()) + " cm between sun and dark room";
    expectAtMost(name + ": direct light, share of the lit side", dark->direct.size(), mean(dark->direct) / mean(lit->direct), 1e-5);
    expectAtMost(name + ": diffuse indirect, share of the lit side", dark->direct.size(),
                 mean(dark->diffuseIndirect) / mean(lit->diffuseIndirect), 1e-8);
    double brightest = 0.0;
    for (const vec3& pixel : dark->diffuseIndirect) brightest = std::max(brightest, double(pixel.y));
    expectAtMost(name + ": brightest pixel of diffuse indirect, share of the lit side's mean", dark->direct.size(),
                 brightest / mean(lit->diffuseIndirect), 1e-6);
    expectAtMost(name + ": glossy indirect, share of the lit side", dark->direct.size(),
                 mean(dark->glossyIndirect) / mean(lit->glossyIndirect), thin ? 6e-4 : 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Centimetres, LightLeaks, testing::Values(1, 2, 5, 10, 20), testing::PrintToStringParamName());

} // namespace
} // namespace sconce
