// Light of surfaces that no probe sees, against rays to the sky.
#include "runtime/bake/hidden_surfaces.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"
#include "runtime/bake/bake.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

constexpr float kGap = 0.3f; // metres under the slab

class HiddenSurfaces : public testing::Test
{
protected:
    /// Of a black scene under a sky of radiance 1.
    FieldData bake(const Scene& scene, const std::vector<vec3>& probes)
    {
        const auto rays = TriangleRays::build(scene);
        BakeSettings settings;
        settings.resolution = 256;
        settings.bounces = 1;
        settings.surfaceTexels = 52;
        settings.surfaceRefined = 0.0f;
        settings.rays = &*rays;
        settings.octree.voxels = 32;
        BakeReport report;
        auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, report);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }

    /// Share of the sky that a place sees, weighted by the cosine.
    static double skyAt(const TriangleRays& rays, vec3 at, Random& random)
    {
        constexpr int kRays = 400;
        int open = 0;
        for (int i = 0; i < kRays; ++i)
        {
            const vec2 lots = random.uniform2();
            const float out = std::sqrt(lots.x), turn = 2.0f * std::numbers::pi_v<float> * lots.y;
            const vec3 direction(out * std::cos(turn), std::sqrt(1.0f - lots.x), out * std::sin(turn));
            open += !rays.occluded(at + vec3(0.0f, 1e-3f, 0.0f), direction, 1e3f);
        }
        return double(open) / kRays;
    }

    testing_support::SharedDevice device;
};

// A slab over a floor: the floor under it is seen from beside it by whoever looks, and by no probe, which stand above.
TEST_F(HiddenSurfaces, TheFloorUnderASlabHasItsOwnLight)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t black = mesh.material("black", vec3(0.01f), 1.0f);
    scene.sky = vec3(1.0f);
    mesh.box(vec3(-4.0f, -0.5f, -4.0f), vec3(4.0f, 0.0f, 4.0f), black);
    mesh.box(vec3(-1.0f, kGap, -1.0f), vec3(1.0f, kGap + 1.0f, 1.0f), black);
    const FieldData field = bake(scene, {vec3(0.0f, 2.5f, 0.0f), vec3(2.5f, 2.5f, 0.3f)});
    ASSERT_NE(field.info.hidden, 0u);
    const auto rays = TriangleRays::build(scene);
    FieldData without = field; // as it was: the table is the last of the words
    without.surfaceLight.resize(field.surfaceLight.size() - hiddenWords(field.info));
    without.info.hidden = 0;
    Random random(9, 0);
    double off = 0.0, offWithout = 0.0, all = 0.0, sum = 0.0;
    int hidden = 0;
    for (int i = 0; i < 400; ++i)
    {
        const vec2 at = 1.9f * random.uniform2() - 0.95f;
        const vec3 place(at.x, 0.0f, at.y), up(0, 1, 0), point = (place - field.info.origin) / field.info.scale;
        const auto lightIn = [&](const FieldData& lit)
        {
            int reads = 0;
            return twin::LightFieldTwin<float>(lit, {}).surfaceLightAt(point, up, up, point + 0.5f * lit.info.voxel * up, reads);
        };
        const auto found = lightIn(field);
        if (found.probes > 0) continue;
        hidden += found.probes == -1;
        const double truth = skyAt(*rays, place, random);
        off += std::abs(double(found.light.g) - truth);
        offWithout += std::abs(double(lightIn(without).light.g) - truth);
        sum += double(found.light.g);
        all += truth;
    }
    EXPECT_GT(hidden, 200);
    EXPECT_NEAR(sum / all, 1.0, 0.05);
    EXPECT_LT(off / all, 0.25) << "means of voxels of a quarter of a metre, where light falls by half in that";
    EXPECT_LT(off, 0.5 * offWithout);
    RecordProperty("error, with and without; mean",
                   std::to_string(off / all) + " " + std::to_string(offWithout / all) + " " + std::to_string(sum / all));
}

// The same of a floor on five others, two millimetres apart: of each the upper side faces as the floor does, and nothing comes there.
TEST_F(HiddenSurfaces, WhatIsSealedUpBehindASurfaceDoesNotDarkenIt)
{
    constexpr int kLayers = 6;
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t black = mesh.material("black", vec3(0.01f), 1.0f);
    scene.sky = vec3(1.0f);
    for (int i = 0; i < kLayers; ++i)
    {
        const float y = -0.002f * float(i);
        mesh.quad(vec3(-4.0f, y, 4.0f), vec3(4.0f, y, 4.0f), vec3(4.0f, y, -4.0f), vec3(-4.0f, y, -4.0f), black);
    }
    mesh.box(vec3(-1.0f, kGap, -1.0f), vec3(1.0f, kGap + 1.0f, 1.0f), black);
    const FieldData field = bake(scene, {vec3(0.0f, 2.5f, 0.0f), vec3(2.5f, 2.5f, 0.3f)});
    const auto rays = TriangleRays::build(scene);
    Random random(9, 0);
    double all = 0.0, sum = 0.0;
    int hidden = 0, dark = 0;
    for (int i = 0; i < 400; ++i)
    {
        const vec2 at = 1.9f * random.uniform2() - 0.95f;
        const vec3 place(at.x, 0.0f, at.y), up(0, 1, 0), point = (place - field.info.origin) / field.info.scale;
        int reads = 0;
        const auto found =
            twin::LightFieldTwin<float>(field, {}).surfaceLightAt(point, up, up, point + 0.5f * field.info.voxel * up, reads);
        if (found.probes > 0) continue;
        const double truth = skyAt(*rays, place, random);
        ++hidden;
        dark += double(found.light.g) < 0.1 * truth;
        sum += double(found.light.g);
        all += truth;
    }
    ASSERT_GT(hidden, 200);
    EXPECT_NEAR(sum / all, 1.0, 0.1);
    EXPECT_LE(dark, hidden / 12) << "where chance found nothing but what is sealed up";
    RecordProperty("dark of hidden; mean", std::to_string(dark) + " " + std::to_string(hidden) + " " + std::to_string(sum / all));
}

// A column on a base that is a little wider: beside the rim, which the eye sees and no probe does, of what faces up there nearly all is
// within the column, where no light is.
TEST_F(HiddenSurfaces, WhatStandsInOneAnotherDoesNotDarkenItsRim)
{
    constexpr float kBase = 0.4f, kOuter = 0.52f, kInner = 0.48f; // metres
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t black = mesh.material("black", vec3(0.01f), 1.0f);
    scene.sky = vec3(1.0f);
    mesh.box(vec3(-4.0f, -0.5f, -4.0f), vec3(4.0f, 0.0f, 4.0f), black);
    mesh.box(vec3(-0.7f, 0.0f, -0.7f), vec3(0.7f, 0.2f, 0.7f), black);
    mesh.cylinder(vec3(0.0f, 0.2f, 0.0f), kOuter, 0.2f, 40, black);
    mesh.cylinder(vec3(0.0f, kBase, 0.0f), kInner, 2.0f, 40, black);
    const FieldData field = bake(scene, {vec3(2.0f, 0.35f, 0.1f), vec3(-1.5f, 0.3f, 1.4f), vec3(-0.9f, 0.35f, -1.8f)});
    const auto rays = TriangleRays::build(scene);
    Random random(9, 0);
    double all = 0.0, sum = 0.0;
    int hidden = 0, dark = 0;
    for (int i = 0; i < 200; ++i)
    {
        const float turn = 2.0f * std::numbers::pi_v<float> * random.uniform();
        const vec3 place = 0.5f * vec3(std::cos(turn), 0.0f, std::sin(turn)) + vec3(0.0f, kBase, 0.0f), up(0, 1, 0);
        const vec3 point = (place - field.info.origin) / field.info.scale;
        int reads = 0;
        const auto found =
            twin::LightFieldTwin<float>(field, {}).surfaceLightAt(point, up, up, point + 0.5f * field.info.voxel * up, reads);
        const double truth = skyAt(*rays, place, random);
        hidden += found.probes <= 0;
        dark += double(found.light.g) < 0.5 * truth;
        sum += double(found.light.g);
        all += truth;
    }
    EXPECT_GT(hidden, 150);
    EXPECT_EQ(dark, 0);
    EXPECT_NEAR(sum / all, 1.0, 0.25) << "cells in the open don't know how near the column is";
    RecordProperty("dark of hidden; mean", std::to_string(dark) + " " + std::to_string(hidden) + " " + std::to_string(sum / all));
}

// A sealed room between lit ones, whose light is all that probes know.
TEST_F(HiddenSurfaces, ADarkRoomStaysDark)
{
    // Walls that pierce each other, as they do; and such as stand on each other, their triangles wound the wrong way round.
    for (const bool turned : {false, true})
    {
        SCOPED_TRACE(turned ? "turned" : "pierced");
        const float end = turned ? 1.0f : 1.05f, across = turned ? 1.0f : 1.04f;
        Scene scene;
        MeshBuilder mesh(scene);
        const uint32_t grey = mesh.material("grey", vec3(0.5f), 1.0f), lamp = mesh.material("lamp", vec3(0.5f), 1.0f);
        scene.materials[lamp].emission = vec3(1.0f);
        for (const float side : {-1.1f, 1.0f}) // floor and ceiling, front and back, of three rooms
        {
            mesh.box(vec3(-3.2f, side, -1.2f), vec3(3.2f, side + 0.1f, 1.2f), grey);
            mesh.box(vec3(-3.2f, -end, side), vec3(3.2f, end, side + 0.1f), grey);
        }
        for (const float x : {-3.1f, -1.0f, 0.9f, 3.0f})
            mesh.box(vec3(x, -across, -across), vec3(x + 0.1f, across, across), std::abs(x) > 2.0f ? lamp : grey);
        if (turned)
            for (glm::uvec3& triangle : scene.triangles) std::swap(triangle.y, triangle.z);
        const FieldData field = bake(scene, {vec3(-2.0f, 0.0f, 0.1f), vec3(-1.5f, 0.2f, -0.3f), vec3(2.0f, -0.1f, 0.1f)});
        const auto lightOf = [&](vec3 place, vec3 normal)
        {
            int reads = 0;
            const vec3 point = (place - field.info.origin) / field.info.scale;
            return twin::LightFieldTwin<float>(field, {}).surfaceLightAt(point, normal, normal, point + 0.5f * field.info.voxel * normal,
                                                                         reads);
        };
        Random random(5, 0);
        int known = 0;
        double lit = 0.0, dark = 0.0, most = 0.0;
        for (int i = 0; i < 300; ++i)
        {
            const vec2 at = 1.76f * random.uniform2() - 0.88f;
            lit += double(lightOf(vec3(-2.0f + at.x, -1.0f, at.y), vec3(0, 1, 0)).light.g) / 300.0;
            for (const auto& [place, normal] :
                 {std::pair(vec3(at.x, -1.0f, at.y), vec3(0, 1, 0)), std::pair(vec3(at.x, 1.0f, at.y), vec3(0, -1, 0)),
                  std::pair(vec3(-0.9f, at), vec3(1, 0, 0)), std::pair(vec3(0.9f, at), vec3(-1, 0, 0))})
            {
                const auto found = lightOf(place, normal);
                known += found.probes == -1;
                dark += double(found.light.g) / 1200.0;
                most = std::max(most, double(found.light.g));
            }
        }
        EXPECT_EQ(known, 1200);
        EXPECT_LT(dark, 0.002 * lit);
        EXPECT_LT(most, 0.15 * lit) << "a voxel is wider than a wall here";
        RecordProperty("light of the lit room, share of it in the dark one, at most",
                       std::to_string(lit) + " " + std::to_string(dark / lit) + " " + std::to_string(most / lit));
    }
}

// Outside of a closed room nobody stands, and no probe tells.
TEST_F(HiddenSurfaces, TheOutsideOfARoomIsLeftOut)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.3f), 1.0f);
    scene.materials[grey].emission = vec3(1.0f);
    scene.sky = vec3(1.0f);
    mesh.box(vec3(-1.0f), vec3(1.0f), grey);
    const FieldData field = bake(scene, {vec3(0.1f, 0.0f, 0.1f)});
    Random random(3, 0);
    int known = 0;
    for (int i = 0; i < 300 && field.info.hidden != 0; ++i)
    {
        const vec2 at = 2.0f * random.uniform2() - 1.0f;
        const vec3 place = (vec3(1.0f, at.x, at.y) - field.info.origin) / field.info.scale;
        known += twin::LightFieldTwin<float>(field, {}).hiddenLightAt(place, vec3(1, 0, 0)).w > 0.0f;
    }
    EXPECT_EQ(known, 0);
}

} // namespace
} // namespace sconce
