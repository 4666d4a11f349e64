#include "placement/visibility.h"
#include "scene/closest_point.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

TEST(Visibility, DistanceEqualsBruteForceOverAllTriangles)
{
    const Scene scene = furnishedRoom();
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility) << visibility.error().message;
    Random random(3, 0);
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 point = vec3(random.uniform(), random.uniform(), random.uniform()) * vec3(8, 5, 6) - 1.0f;
        EXPECT_NEAR(visibility->distance(point, 100.0f), bruteDistance(scene, point), 2e-6) << point.x << ' ' << point.y << ' ' << point.z;
    }
    EXPECT_FLOAT_EQ(visibility->distance({2, 1.5f, 3}, 0.25f), 0.25f); // nothing nearer
}

TEST(Visibility, WallHidesAndItsEndShows)
{
    const Scene scene = furnishedRoom();
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    EXPECT_FALSE(visibility->unoccluded({2, 1, 1}, {4, 1, 1}));
    EXPECT_TRUE(visibility->unoccluded({2, 1, 3.5f}, {4, 1, 3.5f}));
    EXPECT_TRUE(visibility->sees({2, 1, 2.5f}, {0, 1, 2}, {1, 0, 0})); // the surface does not hide itself
}

TEST(Visibility, RayReportsTheSideItCameFrom)
{
    Scene scene = closedRoom({2, 2, 2});
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    RayHit hit;
    ASSERT_TRUE(visibility->cast({1, 1, 1}, {1, 0, 0}, hit));
    EXPECT_FLOAT_EQ(hit.t, 1.0f);
    EXPECT_EQ(hit.normal, vec3(-1, 0, 0));
    EXPECT_FALSE(hit.back);
    ASSERT_TRUE(visibility->cast({5, 1, 1}, {-1, 0, 0}, hit));
    EXPECT_EQ(hit.normal, vec3(1, 0, 0));
    EXPECT_TRUE(hit.back);
    EXPECT_FALSE(visibility->cast({5, 1, 1}, {1, 0, 0}, hit));
}

TEST(Visibility, ClearGlassIsNotThere)
{
    Scene scene = closedRoom({2, 2, 2});
    Material glass;
    glass.baseColor.a = 0.1f;
    glass.alphaCutoff = 0.5f;
    scene.materials.push_back(glass);
    addQuad(scene, {1, 0, 0}, {0, 2, 0}, {0, 0, 2}, 1);
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    EXPECT_TRUE(visibility->unoccluded({0.5f, 1, 1}, {1.5f, 1, 1}));
    EXPECT_NEAR(visibility->distance({0.9f, 1, 1}, 9.0f), 0.9f, 1e-6f);
}

// A leaf card whose left half is cut out.
TEST(Visibility, CutOutTexelsAreLookedThrough)
{
    Scene scene = closedRoom({2, 2, 2});
    Image image;
    image.width = 2, image.height = 1;
    image.rgba = {255, 255, 255, 0, 255, 255, 255, 255};
    scene.images.push_back(image);
    Material leaf;
    leaf.alphaCutoff = 0.5f;
    leaf.baseColorTexture.image = 0;
    leaf.baseColorTexture.wrapU = leaf.baseColorTexture.wrapV = Wrap::clamp;
    scene.materials.push_back(leaf);
    addQuad(scene, {1, 0, 0}, {0, 0, 2}, {0, 2, 0}, 1); // u runs along z
    EXPECT_EQ(trianglePresence(scene).back(), Presence::masked);
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    EXPECT_TRUE(visibility->unoccluded({0.5f, 1, 0.2f}, {1.5f, 1, 0.2f}));
    EXPECT_FALSE(visibility->unoccluded({0.5f, 1, 1.8f}, {1.5f, 1, 1.8f}));
}

TEST(Visibility, NoTrianglesIsRefusedWithASentence)
{
    const Scene scene = emptyScene();
    const auto visibility = Visibility::build(scene);
    ASSERT_FALSE(visibility);
    EXPECT_EQ(visibility.error().code, ErrorCode::badInput);
    EXPECT_NE(visibility.error().message.find("0 triangles"), std::string::npos) << visibility.error().message;
}

TEST(Visibility, RaysTracedTogetherAnswerLikeEveryTriangleLookedAt)
{
    const Scene scene = furnishedRoom();
    const auto visibility = Visibility::build(scene);
    const vec3 from(0.6f, 1.1f, 0.7f);
    std::vector<vec3> to;
    for (int i = 0; i < 203; ++i)
        to.emplace_back(0.1f + 0.0287f * float(i), 0.1f + 0.0137f * float(i * 7 % 203), 0.05f + 0.0193f * float(i * 31 % 203));
    std::vector<uint8_t> seen(to.size(), 1);
    seen[5] = seen[100] = 0; // not asked: stays 0
    visibility->unoccluded(from, to, seen);
    for (size_t i = 0; i < to.size(); ++i) EXPECT_EQ(seen[i] != 0, i != 5 && i != 100 && !bruteBlocked(scene, from, to[i])) << i;
}

TEST(ClosestPointOnTriangle, DegenerateTriangleIsItsLongestEdge)
{
    const vec3 nearest = closestPointOnTriangle({1, 1, 0}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0});
    EXPECT_EQ(nearest, vec3(1, 0, 0));
    EXPECT_EQ(closestPointOnTriangle({1, 1, 0}, {3, 0, 0}, {3, 0, 0}, {3, 0, 0}), vec3(3, 0, 0));
}

} // namespace
} // namespace sconce
