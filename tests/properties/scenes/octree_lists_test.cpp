// What the octree's lists are worth to rays, on a scene made for the purpose: two rooms, one above the other, with a floor of no thickness
// between them. A probe below the floor sees half the free space of the voxels that the floor divides, but nothing of the room above.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bench/reference/ray_scene.h"
#include "runtime/field/quality.h"
#include "runtime/field/tracer_cpu.h"
#include "tests/support/field_by_rays.h"

namespace sconce
{
namespace
{

constexpr float kSide = 4.0f, kHeight = 2.5f; // of a room, metres
constexpr int kVoxels = 32;

void addQuad(Scene& scene, vec3 corner, vec3 u, vec3 v)
{
    const auto first = uint32_t(scene.positions.size());
    for (const vec3 p : {corner, corner + u, corner + u + v, corner + v})
    {
        scene.positions.push_back(p);
        scene.normals.push_back(glm::normalize(glm::cross(u, v)));
        scene.uvs.emplace_back(0.0f);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangles.push_back({first, first + 2, first + 3});
    scene.triangleMaterial.insert(scene.triangleMaterial.end(), 2, 0);
}

/// Two rooms from y = -kHeight to kHeight, the floor between them at `floor`.
Scene twoRooms(float floor)
{
    Scene scene;
    scene.name = "two rooms";
    scene.materials.emplace_back();
    const vec3 low(0.0f, -kHeight, 0.0f), x(kSide, 0, 0), y(0, 2 * kHeight, 0), z(0, 0, kSide);
    addQuad(scene, low, x, z);
    addQuad(scene, low + y, x, z);
    addQuad(scene, low, x, y);
    addQuad(scene, low + z, x, y);
    addQuad(scene, low, z, y);
    addQuad(scene, low + x, z, y);
    addQuad(scene, vec3(0.0f, floor, 0.0f), x, z);
    return scene;
}

class TwoRooms : public testing::TestWithParam<float>
{
protected:
    // the lower room's probes come first and lie nearer to the floor than the upper room's
    const std::vector<vec3> probes = {{1.0f, -0.7f, 1.0f}, {3.0f, -0.7f, 3.0f}, {1.0f, 1.2f, 3.0f}, {3.0f, 1.2f, 1.0f}};
    const Scene scene = twoRooms(GetParam());
    const RayScene truth = std::move(*RayScene::create(scene));
    const FieldData field = testing_support::fieldByRays(truth, probes, 128, {.voxels = kVoxels});
    twin::LightFieldTwin<float> text{field, Quality{}.trace};
    std::mt19937 random{11};
    std::uniform_real_distribution<float> unit{0.0f, 1.0f};

    glm::uvec4 listAt(vec3 world)
    {
        int reads = 0;
        return text.rankedProbesAt((world - vec3(field.info.origin)) / field.info.scale, reads);
    }
    vec3 floorPoint() { return {0.2f + (kSide - 0.4f) * unit(random), GetParam(), 0.2f + (kSide - 0.4f) * unit(random)}; }
};

TEST_P(TwoRooms, AVoxelOffTheFloorListsOnlyProbesOfItsRoom)
{
    const float voxel = field.info.voxel * field.info.scale;
    for (int i = 0; i < 2000; ++i)
        for (const float side : {-1.0f, 1.0f})
        {
            const vec3 point = floorPoint() + vec3(0.0f, side * voxel * (1.01f + unit(random)), 0.0f);
            const glm::uvec4 list = listAt(point);
            for (int k = 0; k < 4; ++k) EXPECT_EQ(list[k] < 2, side < 0.0f) << "rank " << k << " at " << point.x << " " << point.y;
        }
}

TEST_P(TwoRooms, AVoxelThatTheFloorDividesListsProbesOfBothRooms)
{
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 point = floorPoint() + vec3(0.0f, 1e-4f, 0.0f);
        const glm::uvec4 list = listAt(point);
        bool upper = false;
        for (int k = 0; k < 4; ++k) upper = upper || list[k] >= 2;
        EXPECT_TRUE(upper) << point.x << " " << point.z;
    }
}

TEST_P(TwoRooms, RaysFromTheFloorEndInTheRoomAbove)
{
    int wrong = 0;
    constexpr int kRays = 2000;
    for (int i = 0; i < kRays; ++i)
    {
        const vec3 origin = floorPoint() + vec3(0.0f, 5e-4f, 0.0f);
        const vec3 direction = glm::normalize(vec3(2.0f * unit(random) - 1.0f, 0.1f + unit(random), 2.0f * unit(random) - 1.0f));
        const gpu::RayHit hit = text.queryRay(origin, direction);
        const vec3 t =
            (glm::mix(vec3(0.0f, GetParam(), 0.0f), vec3(kSide, kHeight, kSide), glm::greaterThan(direction, vec3(0.0f))) - origin) /
            direction;
        const float exact = std::min({t.x, t.y, t.z});
        wrong += hit.status != 1 || hit.probe < 2 || std::abs(hit.t - exact) > 0.01f * 7.5f;
    }
    EXPECT_LE(wrong, kRays / 100);
}

INSTANTIATE_TEST_SUITE_P(Heights, TwoRooms, testing::Values(0.0f, 0.03f, 0.06f, 0.09f, 0.12f));

} // namespace
} // namespace sconce
