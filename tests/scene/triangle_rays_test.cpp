#include "scene/triangle_rays.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "scene/closest_point.h"
#include "scene/mesh_builder.h"

namespace sconce
{
namespace
{

std::string text(vec3 v)
{
    return std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + "; ";
}

constexpr float kInfinite = std::numeric_limits<float>::infinity();

vec3 randomIn(std::mt19937& random, float reach)
{
    std::uniform_real_distribution<float> across(-reach, reach);
    const float x = across(random), y = across(random);
    return {x, y, across(random)};
}

vec3 randomDirection(std::mt19937& random)
{
    std::normal_distribution<float> normal;
    const float x = normal(random), y = normal(random);
    return glm::normalize(vec3(x, y, normal(random)));
}

/// The box [-1,1]^3, seen from both sides.
Scene unitBox()
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("grey", vec3(0.5f)));
    return scene;
}

/// Where a ray enters the box [-1,1]^3, or leaves it when it starts inside: the slab test (Kay and Kajiya 1986), in double.
double slabs(vec3 origin, vec3 direction)
{
    double enter = -INFINITY, leave = INFINITY;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double a = (-1.0 - double(origin[axis])) / double(direction[axis]),
                     b = (1.0 - double(origin[axis])) / double(direction[axis]);
        enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave || leave < 0.0) return INFINITY;
    return enter > 0.0 ? enter : leave;
}

TEST(TriangleRays, HitsOfABoxAreItsClosedForm)
{
    const Scene scene = unitBox();
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays.ok()) << rays.error().message;
    std::mt19937 random(1);
    int hits = 0;
    for (int i = 0; i < 20000; ++i)
    {
        const vec3 origin = randomIn(random, i % 2 ? 0.99f : 3.0f), direction = randomDirection(random);
        const double truth = slabs(origin, direction);
        const double error = 1e-5 * (1.0 + truth);
        if (std::abs(slabs(origin + 1e-4f * randomDirection(random), direction) - truth) > 1e-2) continue; // grazes an edge
        const auto hit = rays->closest(origin, direction);
        ASSERT_EQ(hit.has_value(), std::isfinite(truth)) << text(origin) << text(direction);
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->t, truth, error);
        const uvec3 corners = scene.triangles[hit->triangle];
        const float u = hit->barycentrics.x, v = hit->barycentrics.y;
        const vec3 point = (1.0f - u - v) * scene.positions[corners.x] + u * scene.positions[corners.y] + v * scene.positions[corners.z];
        EXPECT_LT(glm::distance(point, origin + hit->t * direction), error);
        EXPECT_TRUE(rays->occluded(origin, direction, hit->t * 1.001f));
        EXPECT_FALSE(rays->occluded(origin, direction, hit->t * 0.999f));
        EXPECT_FALSE(rays->closest(origin, direction, hit->t * 0.999f).has_value());
        const auto twice = rays->closest(origin, 2.0f * direction); // t counts lengths of the direction
        ASSERT_TRUE(twice.has_value());
        EXPECT_NEAR(twice->t, 0.5 * truth, error);
    }
    EXPECT_GT(hits, 10000);
}

TEST(TriangleRays, ManyAtOnceAnswerAsOneByOne)
{
    const Scene scene = unitBox();
    const auto rays = TriangleRays::build(scene);
    std::mt19937 random(2);
    for (const size_t count : {size_t(0), size_t(1), size_t(7), size_t(8), size_t(9), size_t(1000)}) // calls of eight, part empty, too
    {
        const vec3 from = randomIn(random, 3.0f);
        std::vector<vec3> to(count), origins(count, from), directions(count);
        std::vector<uint8_t> seen(count), skipped(count);
        std::vector<float> one(count), eight(count);
        for (size_t i = 0; i < count; ++i)
        {
            to[i] = randomIn(random, 3.0f);
            directions[i] = to[i] - from;
            seen[i] = skipped[i] = i % 5 != 0;
        }
        rays->unoccluded(from, to, seen);
        rays->distances(origins, directions, 1, one);
        rays->distances(origins, directions, 8, eight);
        for (size_t i = 0; i < count; ++i)
        {
            const bool clear = !rays->occluded(from, directions[i], 1.0f);
            EXPECT_EQ(seen[i] != 0, skipped[i] && clear) << i;
            const auto hit = rays->closest(from, directions[i]);
            EXPECT_EQ(one[i], hit ? hit->t : kInfinite) << i;
            if (hit)
                EXPECT_NEAR(eight[i], hit->t, 1e-5f * hit->t) << i;
            else
                EXPECT_EQ(eight[i], kInfinite) << i;
        }
    }
}

TEST(TriangleRays, NearestIsTheLeastOverAllTriangles)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.5f));
    mesh.boxTurned({0.5f, 0, 0}, {1, 2, 0.5f}, 0.4f, grey);
    mesh.sphere({-1, 0.5f, 0}, 0.7f, 24, 12, grey);
    const auto rays = TriangleRays::build(scene);
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i)
    {
        const vec3 p = randomIn(random, 3.0f);
        float truth = kInfinite;
        for (const uvec3 t : scene.triangles)
            truth = std::min(truth,
                             glm::distance(p, closestPointOnTriangle(p, scene.positions[t.x], scene.positions[t.y], scene.positions[t.z])));
        EXPECT_NEAR(rays->nearest(p, 100.0f), truth, 1e-5f);
        EXPECT_EQ(rays->nearest(p, 0.5f * truth), 0.5f * truth) << "none is nearer: the largest distance asked for";
    }
}

/// Two triangles of a quad at z = 0 whose picture is clear (alpha 0) where u < 0.5; behind it at z = -1 a solid one, and one of glass that
/// is clear everywhere at z = 1.
Scene curtains()
{
    Scene scene;
    Image image{"mask", 64, 1, {}};
    for (int i = 0; i < 64; ++i) image.rgba.insert(image.rgba.end(), {255, 255, 255, uint8_t(i < 32 ? 0 : 255)});
    scene.images = {image};
    MeshBuilder mesh(scene);
    const uint32_t curtain = mesh.material("curtain", vec3(0.5f)), wall = mesh.material("wall", vec3(0.5f)),
                   glass = mesh.material("glass", vec3(0.5f)), dense = mesh.material("dense", vec3(0.5f));
    scene.materials[curtain].baseColorTexture.image = 0;
    scene.materials[curtain].baseColorTexture.wrapU = Wrap::clamp;
    scene.materials[curtain].alphaCutoff = 0.5f;
    scene.materials[glass].baseColor.a = 0.2f;
    scene.materials[glass].alphaCutoff = 0.5f;
    scene.materials[dense].baseColor.a = 0.5f; // equal to its cutoff: there
    scene.materials[dense].alphaCutoff = 0.5f;
    const auto quad = [&](float z, float size, uint32_t material) // uvs are metres: u = 0.5 lies half a metre from the left
    {
        mesh.quad({0, 0, z}, {size, 0, z}, {size, size, z}, {0, size, z}, material);
    };
    quad(0.0f, 1.0f, curtain);
    quad(-1.0f, 1.0f, wall);
    quad(1.0f, 1.0f, glass);
    quad(-2.0f, 4.0f, dense);
    return scene;
}

TEST(TriangleRays, PointsBelowTheAlphaCutoffAreNotThere)
{
    const Scene scene = curtains();
    EXPECT_EQ(trianglePresence(scene), (std::vector{Presence::masked, Presence::masked, Presence::solid, Presence::solid, Presence::absent,
                                                    Presence::absent, Presence::solid, Presence::solid}));
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays.ok());
    EXPECT_EQ(rays->presence(), trianglePresence(scene));
    EXPECT_EQ(&rays->scene(), &scene);
    const vec3 back(0, 0, -1);
    const auto distance = [&](float x) { return rays->closest({x, 0.3f, 2}, back)->t; };
    EXPECT_FLOAT_EQ(distance(0.25f), 3.0f) << "the glass, then the curtain's clear half";
    EXPECT_FLOAT_EQ(distance(0.75f), 2.0f);
    EXPECT_FLOAT_EQ(distance(2.0f), 4.0f);
    EXPECT_FALSE(rays->occluded({0.25f, 0.3f, 2}, back, 2.5f));
    EXPECT_TRUE(rays->occluded({0.75f, 0.3f, 2}, back, 2.5f));
    const vec3 ends[] = {{0.25f, 0.3f, -0.5f}, {0.75f, 0.3f, -0.5f}};
    std::vector<uint8_t> seen{1, 1};
    rays->unoccluded({0.25f, 0.3f, 2}, std::span(ends, 1), std::span(seen).first(1));
    rays->unoccluded({0.75f, 0.3f, 2}, std::span(ends + 1, 1), std::span(seen).last(1));
    EXPECT_EQ(seen, (std::vector<uint8_t>{1, 0}));
    EXPECT_FLOAT_EQ(rays->nearest({0.25f, 0.3f, 0.8f}, 9.0f), 0.8f) << "masked triangles count whole, glass doesn't";
}

TEST(TriangleRays, SceneWithoutTrianglesMissesEverything)
{
    const Scene scene;
    const auto rays = TriangleRays::build(scene);
    ASSERT_TRUE(rays.ok()) << rays.error().message;
    EXPECT_FALSE(rays->closest(vec3(0.0f), {0, 0, 1}).has_value());
    EXPECT_FALSE(rays->occluded(vec3(0.0f), {0, 0, 1}, 1e9f));
    EXPECT_EQ(rays->nearest(vec3(0.0f), 5.0f), 5.0f);
    const vec3 to(1.0f);
    uint8_t seen = 1;
    rays->unoccluded(vec3(0.0f), {&to, 1}, {&seen, 1});
    EXPECT_EQ(seen, 1);
    float t = 0.0f;
    rays->distances({&to, 1}, {&to, 1}, 8, {&t, 1});
    EXPECT_EQ(t, kInfinite);
}

} // namespace
} // namespace sconce
