#include "placement/free_space.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "placement/surface_samples.h"
#include "tests/placement/box_scenes.h"

namespace sconce
{
namespace
{

using namespace test;

FreeSpace spaceOf(const Scene& scene, std::vector<vec3> inside = {}, uint32_t voxels = 200000)
{
    const auto visibility = Visibility::build(scene);
    EXPECT_TRUE(visibility);
    auto space = findFreeSpace(scene, *visibility, inside, voxels);
    EXPECT_TRUE(space) << (space ? "" : space.error().message);
    return space ? std::move(*space) : FreeSpace{};
}

void expectBox(const FreeSpace& space, vec3 low, vec3 high)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(space.bounds.low[axis], low[axis], 1.1f * space.field.voxel) << axis;
        EXPECT_NEAR(space.bounds.high[axis], high[axis], 1.1f * space.field.voxel) << axis;
    }
}

// A viewer who walks on the bare plane is in the space that counts once it is said that the ground does.
TEST(FreeSpace, OpenGroundCountsUpToItsHeightWhenAskedFor)
{
    Scene scene = emptyScene();
    scene.materials[0].doubleSided = true;
    addQuad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
    addQuad(scene, {-2, 0, -2}, {0, 4, 0}, {4, 0, 0}); // four walls
    addQuad(scene, {-2, 0, 2}, {0, 4, 0}, {4, 0, 0});
    addQuad(scene, {-2, 0, -2}, {0, 4, 0}, {0, 0, 4});
    addQuad(scene, {2, 0, -2}, {0, 4, 0}, {0, 0, 4});
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const std::vector<vec3> inside = {{10, 1, 10}};
    const auto found = [&](const OpenSpace& open) { return std::move(*findFreeSpace(scene, *visibility, inside, 400000, {}, open)); };
    const FreeSpace ground = found({.ground = 2.0f});
    for (const vec3 p : {vec3(10, 1, 10), vec3(-18, 1.5f, 17), vec3(3, 1, 0)}) EXPECT_TRUE(ground.contains(p)) << p.x;
    EXPECT_FALSE(ground.contains({10, 3.5f, 10})) << "the air above";
    const FreeSpace box = found({.box = Bounds{{5, 0, 5}, {15, 3, 15}}});
    EXPECT_TRUE(box.contains({10, 2, 10}));
    EXPECT_FALSE(box.contains({-10, 1, -10}));
    EXPECT_LT(shareLeftOut(scene, *visibility, ground, 1), 0.05f);
    EXPECT_NEAR(shareLeftOut(scene, *visibility, box, 1), 1.0f - 100.0f / 1664.0f, 0.03f) << "100 of 1,664 square metres";
}

// A mesh that one can walk on says where that is: a path, a little below the ground, and what is below a floor isn't above it.
TEST(FreeSpace, AboveAMeshToWalkOnItCounts)
{
    Scene scene = emptyScene();
    scene.materials[0].doubleSided = true;
    addQuad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
    addQuad(scene, {-16, 1, -16}, {0, 0, 4}, {4, 0, 0}); // a table over the path
    Scene path = emptyScene();
    addQuad(path, {-18, -0.1f, -15}, {0, 0, 2}, {36, 0, 0});
    const auto visibility = Visibility::build(scene), walk = Visibility::build(path);
    ASSERT_TRUE(visibility && walk);
    const std::vector<vec3> inside = {{10, 1, 10}};
    const auto space = findFreeSpace(scene, *visibility, inside, 400000, {}, {.ground = 2.5f, .walk = &*walk});
    ASSERT_TRUE(space) << space.error().message;
    for (const vec3 p : {vec3(10, 1, -14), vec3(-10, 1.5f, -14), vec3(-14, 0.5f, -14)}) EXPECT_TRUE(space->contains(p)) << p.x;
    for (const vec3 p : {vec3(10, 1, 10), vec3(10, 1, -10), vec3(10, 3.5f, -14), vec3(-14, 2, -14)})
        EXPECT_FALSE(space->contains(p)) << p.x;
}

TEST(FreeSpace, ClosedRoomIsFreeUpToItsWalls)
{
    const FreeSpace space = spaceOf(closedRoom({4, 2, 3}));
    expectBox(space, vec3(0), {4, 2, 3});
    EXPECT_NEAR(space.volume, 24.0, 24.0 * 0.12);
}

// Two rooms of 4 m, both sides of every surface visible, with a hollow wall of 0.2 m between them that is open to the first room through a
// slit under the ceiling, and a doorway of 1 m through it.
TEST(FreeSpace, HollowWallsAreNotEnteredButDoorwaysAre)
{
    Scene scene = emptyScene();
    scene.materials[0].doubleSided = true;
    addRoom(scene, {0, 0, 0}, {8.2f, 3, 4});
    for (const float x : {4.0f, 4.2f})
        for (const auto& [low, high] :
             {std::pair{vec3(x, 0, 0), vec3(x, x < 4.1f ? 2.7f : 3.0f, 1)}, {vec3(x, 0, 2), vec3(x, 3, 4)}, {vec3(x, 2, 1), vec3(x, 3, 2)}})
            addQuad(scene, low, {0, high.y - low.y, 0}, {0, 0, high.z - low.z});
    addQuad(scene, {4, 0, 1}, {0.2f, 0, 0}, {0, 2, 0}); // the door's frame
    addQuad(scene, {4, 0, 2}, {0.2f, 0, 0}, {0, 2, 0});
    addQuad(scene, {4, 2, 1}, {0.2f, 0, 0}, {0, 0, 1});
    scene.cameras.push_back({});
    scene.cameras.back().eye = {2, 1.5f, 2};
    const FreeSpace space = spaceOf(scene, {}, 400000);
    EXPECT_TRUE(space.contains({2, 1, 2}));
    EXPECT_TRUE(space.contains({4.1f, 1, 1.5f})); // in the doorway
    EXPECT_TRUE(space.contains({6, 1, 2}));
    EXPECT_FALSE(space.contains({4.1f, 1, 0.5f})); // in the wall
    EXPECT_FALSE(space.contains({4.1f, 1.5f, 3.5f}));
}

// Two rooms like those of a game map: single-sided walls, one of them with a hole to the void between the rooms. The void is joined to the
// rooms, and blocks of cells straddle the walls.
TEST(FreeSpace, TheVoidBetweenRoomsIsNotPartOfThem)
{
    Scene scene = emptyScene();
    addRoom(scene, {0, 0, 0}, {4, 3, 4});
    addRoom(scene, {5, 0, 0}, {9, 3, 4});
    // A hole of 1 m in the wall x = 4: the wall's two triangles give way to four strips around it.
    std::erase_if(scene.triangles,
                  [&](const uvec3& corners)
                  {
                      for (int corner = 0; corner < 3; ++corner)
                          if (scene.positions[corners[corner]].x != 4.0f) return false;
                      return true;
                  });
    scene.triangleMaterial.resize(scene.triangles.size());
    for (const auto& [low, high] : {std::pair{vec3(4, 0, 0), vec3(4, 3, 1)},
                                    {vec3(4, 0, 2), vec3(4, 3, 4)},
                                    {vec3(4, 2, 1), vec3(4, 3, 2)},
                                    {vec3(4, 0, 1), vec3(4, 1, 2)}})
        addQuad(scene, low, {0, 0, high.z - low.z}, {0, high.y - low.y, 0});
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const FreeSpace space = spaceOf(scene, {{2, 1.5f, 2}});
    size_t outside = 0;
    for (uint32_t at : space.cells) outside += space.field.centre(space.field.cell(at)).x > 4.0f + 2.0f * space.field.voxel;
    EXPECT_LT(double(outside), 0.01 * double(space.cells.size()));
    EXPECT_GT(space.volume, 0.8 * 48.0);
}

TEST(FreeSpace, ThinWallSeparatesAndAPointInsideChooses)
{
    const Scene scene = dividedRoom();
    expectBox(spaceOf(scene, {{5, 1, 2}}), {4, 0, 0}, {6, 3, 4});
    expectBox(spaceOf(scene, {{1, 1, 2}}), {0, 0, 0}, {4, 3, 4});
    expectBox(spaceOf(scene, {{1, 1, 2}, {5, 1, 2}}), {0, 0, 0}, {6, 3, 4});
}

// Within half a cell of a wall the nearest free cell may be the one behind it.
TEST(FreeSpace, APointCloseToAThinWallMeansItsOwnSide)
{
    const Scene scene = dividedRoom();
    for (const float away : {0.002f, 0.01f, 0.03f})
    {
        expectBox(spaceOf(scene, {{4.0f - away, 1, 2}}), {0, 0, 0}, {4, 3, 4});
        expectBox(spaceOf(scene, {{4.0f + away, 1, 2}}), {4, 0, 0}, {6, 3, 4});
    }
}

// A box is all free space in it, wherever the camera is.
TEST(FreeSpace, ABoxBesideTheCamerasRoomIsFilled)
{
    Scene scene = closedRoom({8, 3, 4});
    addQuad(scene, {4, 0, 0}, {0, 3, 0}, {0, 0, 3}); // a wall with an opening at its end
    addQuad(scene, {4, 0, 0}, {0, 0, 3}, {0, 3, 0});
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const std::vector<vec3> inside = {{1, 1, 1}};
    const auto space = findFreeSpace(scene, *visibility, inside, 200000, {}, {.box = Bounds{{5, 0, 0}, {8, 3, 4}}});
    ASSERT_TRUE(space) << space.error().message;
    expectBox(*space, {5, 0, 0}, {8, 3, 4});
}

TEST(FreeSpace, SlantedThinWallSeparates)
{
    Scene scene = closedRoom({4, 4, 4});
    addQuad(scene, {0.7f, 0, 0}, {2.9f, 0, 4.0f}, {0, 4, 0});
    const FreeSpace space = spaceOf(scene, {{3.5f, 2, 0.5f}});
    for (uint32_t at : space.cells)
    {
        const vec3 p = space.field.centre(space.field.cell(at));
        ASSERT_GT((p.x - 0.7f) * 4.0f - p.z * 2.9f, 0.0f) << p.x << ' ' << p.z;
    }
}

TEST(FreeSpace, WithoutSeedsTheLargestRoomCounts)
{
    expectBox(spaceOf(dividedRoom()), {0, 0, 0}, {4, 3, 4});
}

TEST(FreeSpace, CameraChoosesTheRoom)
{
    Scene scene = dividedRoom();
    Camera camera;
    camera.eye = {5, 1, 2};
    scene.cameras.push_back(camera);
    expectBox(spaceOf(scene), {4, 0, 0}, {6, 3, 4});
}

// The usual Cornell box: no front wall, and the camera stands before it.
TEST(FreeSpace, CameraBeforeAnOpenFrontMeansTheInside)
{
    Scene scene = closedRoom({2, 2, 2});
    scene.triangles.resize(10), scene.triangleMaterial.resize(10); // the last wall added is z = 2
    Camera camera;
    camera.eye = {1, 1, 6};
    scene.cameras.push_back(camera);
    expectBox(spaceOf(scene), vec3(0), vec3(2));
}

TEST(FreeSpace, RoomOnAWidePlaneIsTheRoom)
{
    Scene scene = closedRoom({6, 3, 4});
    for (vec3& position : scene.positions) position.y += 0.01f;
    scene.triangles.resize(10), scene.triangleMaterial.resize(10); // open at z = 4
    addQuad(scene, {-100, 0, -100}, {0, 0, 200}, {200, 0, 0});
    const FreeSpace space = spaceOf(scene, {{3, 1.5f, 2}}, 400000);
    EXPECT_TRUE(space.contains({3, 1.5f, 2}));
    EXPECT_GT(space.bounds.low.x, -8.0f);
    EXPECT_LT(space.bounds.high.x, 14.0f);
    EXPECT_LT(space.bounds.high.z, 12.0f);
    EXPECT_LT(space.field.voxel, 0.2f) << "cells were spent on the plane";
}

// A closed room with a small window, and outer walls that make the outside look half enclosed.
TEST(FreeSpace, SeedIndoorsKeepsIndoorsAndASeedInTheYardKeepsTheYard)
{
    Scene scene = emptyScene();
    scene.materials[0].doubleSided = true;
    addQuad(scene, {-6, 0, -6}, {0, 0, 12}, {12, 0, 0});
    addCrate(scene, {-2, 0.01f, -2}, {2, 3, 2});
    // A window in the wall at x = 2.
    scene.triangles.erase(scene.triangles.begin() + 4, scene.triangles.begin() + 6);
    scene.triangleMaterial.resize(scene.triangles.size());
    for (const float z : {-2.0f, 0.3f}) addQuad(scene, {2, 0.01f, z}, {0, 3, 0}, {0, 0, 1.7f});
    for (const float y : {0.01f, 1.8f}) addQuad(scene, {2, y, -0.3f}, {0, 1.2f, 0}, {0, 0, 0.6f});
    addQuad(scene, {-6, 0, -6}, {12, 0, 0}, {0, 2, 0}), addQuad(scene, {-6, 0, 6}, {12, 0, 0}, {0, 2, 0});
    addQuad(scene, {-6, 0, -6}, {0, 0, 12}, {0, 2, 0}), addQuad(scene, {6, 0, -6}, {0, 0, 12}, {0, 2, 0});
    const FreeSpace house = spaceOf(scene, {{-1.5f, 1.5f, -1.5f}}, 400000);
    EXPECT_TRUE(house.contains({0, 1.5f, 0}));
    EXPECT_FALSE(house.contains({4, 1, 3}));
    EXPECT_LT(house.bounds.high.x, 3.0f);
    const FreeSpace both = spaceOf(scene, {{-1.5f, 1.5f, -1.5f}, {4, 1, 3}}, 400000);
    EXPECT_TRUE(both.contains({0, 1.5f, 0}));
    EXPECT_TRUE(both.contains({4, 1, 3}));
    EXPECT_FALSE(both.contains({0, 3.3f, 0})) << "the air above the roof";
}

TEST(FreeSpace, UndersideOfATerrainDoesNotCount)
{
    // A sheet with its front upward, walls around the yard above it, and a cellar of backs below.
    Scene scene = emptyScene();
    addQuad(scene, {0, 0, 0}, {0, 0, 10}, {10, 0, 0});
    addQuad(scene, {0, 0, 0}, {10, 0, 0}, {0, 4, 0}), addQuad(scene, {0, 0, 10}, {0, 4, 0}, {10, 0, 0});
    addQuad(scene, {0, 0, 0}, {0, 4, 0}, {0, 0, 10}), addQuad(scene, {10, 0, 0}, {0, 0, 10}, {0, 4, 0});
    addCrate(scene, {0, -9, 0}, {10, -8, 10});
    addQuad(scene, {0, -8, 0}, {0, 8, 0}, {10, 0, 0}), addQuad(scene, {0, -8, 10}, {10, 0, 0}, {0, 8, 0});
    addQuad(scene, {0, -8, 0}, {0, 0, 10}, {0, 8, 0}), addQuad(scene, {10, -8, 0}, {0, 8, 0}, {0, 0, 10});
    const FreeSpace space = spaceOf(scene);
    EXPECT_GT(space.bounds.low.y, -0.5f);
    EXPECT_TRUE(space.contains({5, 1, 5}));
}

TEST(FreeSpace, RandomPointsStayOnTheirSideOfAThinWall)
{
    const FreeSpace space = spaceOf(dividedRoom(), {{1, 1, 2}}, 5000);
    Random random(5, 0);
    for (int i = 0; i < 20000; ++i)
    {
        const vec3 p = space.randomPoint(random);
        ASSERT_TRUE(p.x > 0 && p.x < 4 && p.y > 0 && p.y < 3 && p.z > 0 && p.z < 4) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(FreeSpace, PointOutsideTheSceneIsRefusedWithItsNumbers)
{
    const Scene scene = closedRoom({4, 2, 3});
    const auto visibility = Visibility::build(scene);
    ASSERT_TRUE(visibility);
    const std::vector<vec3> inside{{40, 1, 1}};
    const auto space = findFreeSpace(scene, *visibility, inside, 50000);
    ASSERT_FALSE(space);
    EXPECT_EQ(space.error().code, ErrorCode::badArgument);
    EXPECT_NE(space.error().message.find("(40, 1, 1)"), std::string::npos) << space.error().message;
}

} // namespace
} // namespace sconce
