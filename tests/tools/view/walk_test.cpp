#include "tools/view/walk.h"

#include <cmath>

#include <gtest/gtest.h>

using namespace sconce;
using namespace sconce::tools;

namespace
{

void expectNear(vec3 a, vec3 b, float within = 1e-5f)
{
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], within) << i;
}

void expectLevel(const Camera& camera)
{
    EXPECT_NEAR(glm::length(camera.forward), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(camera.up), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(camera.forward, camera.up), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::cross(camera.forward, camera.up).y, 0.0f, 1e-5f); // the horizon is level
    EXPECT_GT(camera.up.y, 0.0f);
}

} // namespace

TEST(Walk, KeysMoveAlongTheViewAndTheWorldsUp)
{
    const Camera start = lookAt({1, 2, 3}, {1, 2, -5}, 1.0f);
    Camera camera = start;
    walk(camera, {.move = {0, 0, 1}, .seconds = 0.5f}, 2.0f);
    expectNear(camera.eye, {1, 2, 2});
    walk(camera, {.move = {1, 0, 0}, .seconds = 0.5f}, 2.0f);
    expectNear(camera.eye, {2, 2, 2});
    walk(camera, {.move = {0, -1, 0}, .fast = true, .seconds = 0.5f}, 2.0f);
    expectNear(camera.eye, {2, 2 - kFastWalk, 2});
    // Two keys at once are no faster than one.
    camera = start;
    walk(camera, {.move = {1, 0, 1}, .seconds = 1.0f}, 3.0f);
    EXPECT_NEAR(glm::length(camera.eye - start.eye), 3.0f, 1e-5f);
    EXPECT_EQ(camera.forward, start.forward);
}

TEST(Walk, NothingPressedChangesNoBit)
{
    const Camera start = lookAt({0.1f, 0.2f, 0.3f}, {3, -1, 7}, 0.7f);
    Camera camera = start;
    walk(camera, {.seconds = 0.1f}, 5.0f);
    EXPECT_EQ(camera.eye, start.eye);
    EXPECT_EQ(camera.forward, start.forward);
    EXPECT_EQ(camera.up, start.up);
}

TEST(Walk, TheMouseTurnsAboutTheWorldsUpAndNeverOverTheZenith)
{
    Camera camera = lookAt({0, 0, 0}, {0, 0, -1}, 1.0f);
    walk(camera, {.turn = {0.5f * float(M_PI), 0.0f}}, 1.0f);
    expectNear(camera.forward, {1, 0, 0});
    expectLevel(camera);
    for (int i = 0; i < 50; ++i) walk(camera, {.turn = {0.01f, 0.2f}}, 1.0f);
    expectLevel(camera);
    EXPECT_GT(camera.forward.y, 0.99f);
    for (int i = 0; i < 50; ++i) walk(camera, {.turn = {0.0f, -0.2f}}, 1.0f);
    expectLevel(camera);
    EXPECT_LT(camera.forward.y, -0.99f);
}

TEST(Walk, LooksWhereItIsTold)
{
    const Camera camera = lookAt({1, 1, 1}, {4, 1, 5}, 0.9f);
    expectNear(camera.forward, {0.6f, 0, 0.8f});
    expectNear(camera.up, {0, 1, 0});
    EXPECT_EQ(camera.verticalFov, 0.9f);
    const Camera down = lookAt({0, 3, 0}, {0, 0, 0}, 0.9f); // has a picture all the same
    EXPECT_NEAR(glm::dot(down.forward, down.up), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::length(down.up), 1.0f, 1e-5f);
}

TEST(Walk, SpeedFollowsTheSceneAndStaysARuns)
{
    Scene small, large;
    small.positions = {{0, 0, 0}, {0.3f, 0, 0}, {0.3f, 0, 0.4f}};
    large.positions = {{0, 0, 0}, {3000, 0, 0}, {3000, 0, 4000}};
    small.triangles = large.triangles = {{0, 1, 2}};
    EXPECT_NEAR(walkSpeed(small), 0.05f, 1e-6f);
    EXPECT_EQ(walkSpeed(large), 8.0f);
}
