#include "runtime/field/octree_builder.h"

#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/scene_gltf.h"
#include "tests/support/cornell_field.h"
#include "tests/support/device.h"
#include "tests/support/divided_box.h"
#include "tests/support/files.h"

namespace sconce
{
namespace
{

using namespace testing_support;

class OctreeBuilder : public DeviceTest
{
protected:
    PacedWork work{gpu(), 0.2};
    /// Builds on the device and on the host and compares every byte.
    void expectTwins(const FieldData& field, const OctreeSettings& settings)
    {
        const ProbeMaps maps{field.info, field.probes, field.distance};
        const auto device = buildOctreeOnDevice(gpu(), work, maps, settings);
        const auto host = buildOctree(maps, settings);
        ASSERT_TRUE(device) << device.error().message;
        ASSERT_TRUE(host) << host.error().message;
        EXPECT_EQ(device->leaves, host->leaves);
        EXPECT_EQ(device->nodes, host->nodes);
        EXPECT_EQ(device->bricks, host->bricks);
        EXPECT_EQ(device->boundsLow, host->boundsLow);
        EXPECT_TRUE(device->texels == host->texels) << "the lists differ";
        EXPECT_GT(host->nodes, 0u);
    }
};

TEST_F(OctreeBuilder, GivesTheBytesOfItsTwinInADividedBox)
{
    expectTwins(dividedBox(64), {.voxels = 32});
    expectTwins(dividedBox(16, 255), {.voxels = 16, .topShift = 1});
    expectTwins(dividedBox(16, 256), {.voxels = 16, .topShift = 3});
    expectTwins(dividedBox(8, 65535), {.voxels = 16});
}

TEST_F(OctreeBuilder, GivesTheBytesOfItsTwinInTheCornellBox)
{
    expectTwins(cornell().field, {.voxels = 64});
}

TEST_F(OctreeBuilder, GivesTheBytesOfItsTwinInSponza)
{
    const std::filesystem::path file = testing_support::scenesFolder() / "sponza" / "Sponza.gltf";
    if (!std::filesystem::exists(file.parent_path())) GTEST_SKIP() << "the scene sponza is not in " << file.parent_path();
    auto scene = loadGltf(file);
    ASSERT_TRUE(scene) << scene.error().message;
    const Bounds bounds = scene->bounds();
    std::vector<vec3> probes; // in rows through the building, some of them in its walls
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 4; ++x)
                probes.push_back(bounds.low + (bounds.high - bounds.low) * (vec3(x + 0.6f, y + 0.4f, z + 0.5f) / vec3(4, 2, 3)));
    const auto rays = RayScene::create(*scene);
    ASSERT_TRUE(rays);
    expectTwins(fieldByRays(*rays, probes, 64), {.voxels = 64});
}

TEST_F(OctreeBuilder, RefusesAndCancelsAsItsTwinDoes)
{
    FieldData field = dividedBox(16);
    const auto refused = buildOctreeOnDevice(gpu(), work, {field.info, {}, field.distance}, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, buildOctree({field.info, {}, field.distance}, {}).error().message);
    const auto cancelled =
        buildOctreeOnDevice(gpu(), work, {field.info, field.probes, field.distance}, {}, [](std::string_view, double) { return false; });
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace sconce
