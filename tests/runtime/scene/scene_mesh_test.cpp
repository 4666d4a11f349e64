#include <gtest/gtest.h>

#include "runtime/field/field_space.h"
#include "runtime/scene/lights.h"
#include "runtime/scene/scene_mesh.h"
#include "scene/builtin_scenes.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using testing_support::ValidatedDevice;

uint32_t indexCount(const std::vector<SceneDraws::Run>& runs)
{
    uint32_t count = 0;
    for (const SceneDraws::Run& run : runs) count += run.count;
    return count;
}

// Six faces about a point see everything between them, and a cluster is seldom in more than two of them.
TEST(SceneMesh, SixFacesTogetherSeeEveryTriangle)
{
    ValidatedDevice device;
    auto scene = makeBuiltinScene("hall");
    ASSERT_TRUE(scene);
    const gpu::LightFieldInfo space = fieldSpace(scene->bounds());
    auto mesh = SceneMesh::create(device.gpu(), *scene, space);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(indexCount(mesh->everything().opaque) + indexCount(mesh->everything().masked), 3 * scene->triangles.size());
    SceneDraws draws;
    size_t seen = 0;
    for (int face = 0; face < 6; ++face)
    {
        mesh->cull(faceView(vec3(0.01f, 0.02f, 0.03f), face, 1e-4f), draws);
        const size_t here = indexCount(draws.opaque) + indexCount(draws.masked);
        EXPECT_LT(here, 3 * scene->triangles.size()) << "face " << face << " culls nothing";
        seen += here;
    }
    EXPECT_GE(seen, 3 * scene->triangles.size());
    EXPECT_LT(seen, 9 * scene->triangles.size());
}

TEST(SceneMesh, ViewThatLooksAwaySeesNothing)
{
    ValidatedDevice device;
    auto scene = makeBuiltinScene("cornell");
    ASSERT_TRUE(scene);
    auto mesh = SceneMesh::create(device.gpu(), *scene, fieldSpace(scene->bounds()));
    ASSERT_TRUE(mesh);
    SceneDraws draws;
    mesh->cull(faceView(vec3(3.0f, 0.0f, 0.0f), 0, 1e-4f), draws); // beyond the scene, looking further along +x
    EXPECT_TRUE(draws.opaque.empty() && draws.masked.empty());
    mesh->cull(faceView(vec3(3.0f, 0.0f, 0.0f), 1, 1e-4f), draws); // looking back at it
    EXPECT_EQ(indexCount(draws.opaque) + indexCount(draws.masked), 3 * scene->triangles.size());
}

} // namespace
} // namespace sconce
