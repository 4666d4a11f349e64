#include <gtest/gtest.h>

#include "runtime/bake/probe_clearance.h"
#include "scene/closest_point.h"
#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

constexpr float kClearance = 1e-3f;

Scene box()
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box({-1, -1, -1}, {1, 1, 1}, mesh.material("wall", vec3(0.5f)));
    return scene;
}

/// By brute force over all triangles.
float distanceToSurface(const Scene& scene, vec3 p)
{
    float nearest = 1e30f;
    for (const uvec3& t : scene.triangles)
        nearest = std::min(nearest,
                           glm::distance(p, closestPointOnTriangle(p, scene.positions[t.x], scene.positions[t.y], scene.positions[t.z])));
    return nearest;
}

TEST(ProbeClearance, ProbesOnWallsEdgesCornersAndNearThemGetClear)
{
    const Scene scene = box();
    const std::vector<vec3> probes = {{1, 0.1f, 0.2f},           {1, 1, 0.3f}, {-1, -1, -1}, {0.99999f, 0, 0}, {1.00001f, 0, 0},
                                      {0.5f, -0.9995f, 0.9995f}, {0, 1, 0},    {3, 0, 0},    {0, 0, 0}};
    const ClearedProbes cleared = clearedOfSurfaces(scene, probes, kClearance);
    EXPECT_EQ(cleared.moved, 7u);
    EXPECT_EQ(cleared.tight, 0u);
    for (size_t i = 0; i < probes.size(); ++i)
    {
        EXPECT_GE(distanceToSurface(scene, cleared.positions[i]), 0.98f * kClearance) << i;
        EXPECT_LE(glm::distance(cleared.positions[i], probes[i]), 4.0f * kClearance) << i;
    }
    EXPECT_LT(cleared.positions[3].x, 1.0f); // on its own side
    EXPECT_GT(cleared.positions[4].x, 1.0f);
    for (const size_t i : {size_t(7), size_t(8)}) EXPECT_EQ(cleared.positions[i], probes[i]); // to the bit
}

TEST(ProbeClearance, SaysWhichFindNoPlace)
{
    Scene scene = box();
    MeshBuilder mesh(scene);
    mesh.quad({-0.5f, 0, -0.5f}, {0.5f, 0, -0.5f}, {0.5f, 0, 0.5f}, {-0.5f, 0, 0.5f}, 0);
    mesh.quad({-0.5f, 1.5e-3f, -0.5f}, {0.5f, 1.5e-3f, -0.5f}, {0.5f, 1.5e-3f, 0.5f}, {-0.5f, 1.5e-3f, 0.5f}, 0);
    const ClearedProbes cleared = clearedOfSurfaces(scene, std::vector<vec3>{{0, 7e-4f, 0}, {0, 0.5f, 0}}, kClearance);
    EXPECT_EQ(cleared.moved, 1u);
    EXPECT_EQ(cleared.tight, 1u);
}

TEST(ProbeClearance, NoClearanceMovesNothing)
{
    const ClearedProbes cleared = clearedOfSurfaces(box(), std::vector<vec3>{{1, 0, 0}}, 0.0f);
    EXPECT_EQ(cleared.moved, 0u);
    EXPECT_EQ(cleared.positions[0], vec3(1, 0, 0));
}

} // namespace
} // namespace sconce
