#include "bench/race/ray_sets.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bench/opponents/baselines.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

Scene room()
{
    Scene scene;
    scene.materials = {Material{}};
    test::addBox(scene, vec3(0.0f), 1.0f, 0);
    test::addSphere(scene, 0.3f, 12, 0);
    return scene;
}

TEST(GlossyRays, LeaveTheirSurfaceAndHitWhatAClosedRoomHas)
{
    const Scene scene = room();
    const auto rays = RayScene::create(scene);
    const vec3 point(0.7f, 0.1f, 0.2f);
    const auto set = glossyRays(*rays, {}, {&point, 1}, {.count = 5000});
    ASSERT_TRUE(set.ok()) << set.error().message;
    ASSERT_EQ(set->size(), 5000u);
    size_t hits = 0;
    for (size_t i = 0; i < set->size(); ++i)
    {
        EXPECT_NEAR(glm::length(set->directions[i]), 1.0f, 1e-5f);
        EXPECT_GT(set->startCosine[i], 0.0f);
        hits += set->truth[i].hit;
        EXPECT_LT(glm::dot(set->truth[i].normal, set->directions[i]), 1e-6f);
        EXPECT_LT(glm::length(set->origins[i] + set->truth[i].t * set->directions[i] - set->truth[i].position), 1e-4f) << i;
        // Opponents that start further off are judged by what a ray from there meets.
        const auto farther = rays->closest(set->origins[i] + kFartherStart * set->normals[i], set->directions[i]);
        ASSERT_EQ(farther.has_value(), set->fartherTruth[i].hit) << i;
        EXPECT_EQ(farther ? farther->t : 0.0f, set->fartherTruth[i].hit ? set->fartherTruth[i].t : 0.0f) << i;
    }
    EXPECT_GE(hits, 4999u); // closed; robust Embree may lose one on an edge
}

TEST(GlossyRays, SameForOneAndTwoThreads)
{
    const Scene scene = room();
    const auto rays = RayScene::create(scene);
    Camera camera;
    camera.eye = {0, 0, 0.9f};
    const auto with = [&](size_t threads)
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return glossyRays(*rays, {&camera, 1}, {}, {.count = 2000, .seed = 3});
    };
    const auto one = with(1), two = with(2);
    EXPECT_EQ(one->origins, two->origins);
    EXPECT_EQ(one->directions, two->directions);
}

// Neighbours in the list are neighbours in a picture: what the benches call coherent.
TEST(GlossyRays, ComeInTheOrderOfTheirPictures)
{
    const Scene scene = room();
    const auto rays = RayScene::create(scene);
    const vec3 points[] = {{0.7f, 0.1f, 0.2f}, {-0.6f, 0.2f, 0.1f}};
    const auto set = glossyRays(*rays, {}, points, {.count = 4000});
    double apart = 0.0, far = 0.0;
    for (size_t i = 1; i < set->size(); ++i)
    {
        apart += glm::distance(set->origins[i], set->origins[i - 1]);
        far += glm::distance(set->origins[i], set->origins[i * 1999 % set->size()]);
    }
    EXPECT_LT(apart, 0.15 * far);
}

// The narrow lobe stays near the mirror direction of the floor; the wide one doesn't.
TEST(GlossyRays, AlphaWidensTheLobe)
{
    Scene scene;
    scene.materials = {Material{}};
    test::addQuad(scene, vec3(0.0f), {0, 0, 10}, {10, 0, 0}, 0);
    const auto rays = RayScene::create(scene);
    Camera camera;
    camera.eye = {0, 1, 1};
    camera.forward = glm::normalize(vec3(0, -1, -1));
    camera.up = glm::normalize(vec3(0, 1, -1));
    camera.verticalFov = 0.01f;
    const vec3 mirror = glm::normalize(vec3(0, 1, -1));
    const auto spread = [&](float alpha)
    {
        const auto set = glossyRays(*rays, {&camera, 1}, {}, {.count = 2000, .alphaLow = alpha, .alphaHigh = alpha});
        double sum = 0.0;
        for (vec3 d : set->directions) sum += glm::dot(d, mirror) / 2000.0;
        return sum;
    };
    EXPECT_GT(spread(0.01f), 0.995);
    EXPECT_LT(spread(0.5f), 0.9);
}

TEST(GlossyRays, RefuseNoViewpointAndBlindOnes)
{
    const Scene scene = room();
    const auto rays = RayScene::create(scene);
    EXPECT_FALSE(glossyRays(*rays, {}, {}, {}).ok());
    Camera away;
    away.eye = {0, 0, -5};
    const auto blind = glossyRays(*rays, {&away, 1}, {}, {.count = 10});
    ASSERT_FALSE(blind.ok());
    EXPECT_EQ(blind.error().code, ErrorCode::badInput);
}

} // namespace
} // namespace sconce
