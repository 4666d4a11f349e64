#include "placement/distance_field.h"

#include <gtest/gtest.h>

#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

// The distance to the walls of a box is the least of six coordinate differences.
TEST(DistanceField, ClosedRoomHasTheDistanceToItsNearestWall)
{
    const vec3 size(4, 2, 3);
    const Scene scene = closedRoom(size);
    const DistanceField field = buildDistanceField(scene, trianglePresence(scene), {vec3(0), size}, 60000);
    EXPECT_LE(field.cells(), 60000u);
    EXPECT_GT(field.cells(), 40000u);
    for (size_t at = 0; at < field.cells(); ++at)
    {
        const vec3 p = field.centre(field.cell(at));
        const vec3 least = glm::min(p, size - p);
        const float expected = std::min({least.x, least.y, least.z});
        if (expected < -field.voxel) continue; // the last layer may stand out of the room
        const float allowed = std::abs(expected) < 2.9f * field.voxel ? 1e-4f : 1.0f * field.voxel;
        ASSERT_NEAR(field.distance[at], std::abs(expected), allowed) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(DistanceField, IndexAndCellAreInverse)
{
    const Scene scene = closedRoom({4, 2, 3});
    const DistanceField field = buildDistanceField(scene, trianglePresence(scene), {vec3(0), {4, 2, 3}}, 5000);
    for (size_t at = 0; at < field.cells(); ++at)
    {
        ASSERT_EQ(field.index(field.cell(at)), at);
        ASSERT_EQ(field.cellAt(field.centre(field.cell(at))), field.cell(at));
    }
}

TEST(DistanceField, BoxWithoutSurfaceIsAllFree)
{
    const Scene scene = closedRoom({1, 1, 1});
    const DistanceField field = buildDistanceField(scene, trianglePresence(scene), {vec3(10), vec3(12)}, 5000);
    for (float distance : field.distance) ASSERT_GT(distance, 2.0f);
}

} // namespace
} // namespace sconce
