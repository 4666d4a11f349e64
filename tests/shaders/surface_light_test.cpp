// Surface light of the shared text, on fields whose light is known at every point.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "tests/support/lit_field.h"

namespace sconce
{
namespace
{

using testing_support::litField;
using Text = twin::LightFieldTwin<float>;
constexpr uint32_t kSize = testing_support::kLitTexels;

auto lightOf(const FieldData& field, vec3 point, vec3 normal)
{
    Text text(field, testing_support::defaultQuality());
    const vec3 p = (point - field.info.origin) / field.info.scale;
    int reads = 0;
    return text.surfaceLightAt(p, normal, normal, p + 0.5f * field.info.voxel * normal, reads);
}

TEST(SurfaceLight, TexelsLieOnTheWallsThatTheirProbesSee)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
    const FieldData field = litField(scene, {{0.3f, 0.2f, -0.1f}}, [](vec3) { return 1.0f; });
    Text text(field, testing_support::defaultQuality());
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < int(kSize * kSize); ++i)
        {
            const auto point = text.surfacePointAt(0, face, i % int(kSize), i / int(kSize));
            const vec3 at = field.info.origin + field.info.scale * (vec3(field.probes[0].centre) + point.at);
            EXPECT_NEAR(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}), 1.0f, 0.003f);
            EXPECT_GT(point.width, 0.0f);
        }
}

// Light that changes linearly over a box's walls: bilinear taps give it exactly, but for the words' steps and the half texels at a face's
// border.
TEST(SurfaceLight, ComesBackWhereItIsFromTwoProbes)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
    const auto light = [](vec3 p) { return 2.0f + p.x + 0.5f * p.y; };
    const FieldData field = litField(scene, {{0.3f, 0.2f, -0.1f}, {-0.4f, -0.3f, 0.2f}, {0.1f, -0.5f, -0.5f}}, light);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> across(-0.95f, 0.95f);
    double worst = 0.0;
    int one = 0;
    constexpr int kPoints = 6000;
    for (int i = 0; i < kPoints; ++i)
    {
        vec3 p(across(random), across(random), across(random)), n(0.0f);
        p[i % 3] = (i / 3) % 2 ? 1.0f : -1.0f;
        n[i % 3] = -p[i % 3];
        const auto found = lightOf(field, p, n);
        ASSERT_GE(found.probes, 1);
        one += found.probes == 1;
        worst = std::max(worst, double(std::abs(found.light.g / light(p) - 1.0f)));
    }
    RecordProperty("worst", std::to_string(worst));
    EXPECT_LT(worst, 0.08) << "at a border of two faces, half a texel of 24 away";
    EXPECT_EQ(one, 0) << "in a box every probe sees every point";
}

// Floor and walls run on in one plane behind a thin wall. What a pixel at its foot projects onto is coplanar with it, near, and of the
// other room.
TEST(SurfaceLight, DoesNotComeThroughAWallOf1CentimetreAlongTheFloor)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.5f));
    mesh.box(vec3(-2.0f, 0.0f, -1.0f), vec3(2.0f, 2.0f, 1.0f), white);
    mesh.box(vec3(-0.005f, 0.0f, -1.0f), vec3(0.005f, 2.0f, 1.0f), white);
    const FieldData field = litField(scene, {{-1.0f, 1.1f, 0.1f}, {-0.6f, 0.6f, -0.3f}, {1.0f, 0.9f, -0.1f}, {0.5f, 1.2f, 0.3f}},
                                     [](vec3 p) { return p.x < 0.0f ? 100.0f : 1.0f; });
    std::mt19937 random(6);
    std::uniform_real_distribution<float> along(-0.9f, 0.9f), away(0.006f, 0.1f);
    for (int i = 0; i < 4000; ++i)
    {
        const float x = away(random), z = along(random);
        EXPECT_NEAR(lightOf(field, vec3(x, 0.0f, z), vec3(0, 1, 0)).light.g, 1.0f, 0.02f) << "dark, " << x << " m off, z " << z;
        EXPECT_NEAR(lightOf(field, vec3(-x, 0.0f, z), vec3(0, 1, 0)).light.g, 100.0f, 2.0f) << "bright, " << x << " m off, z " << z;
    }
}

// What opposite facings share by the squares of the normal, what they differ by in proportion to it.
TEST(SurfaceLight, WhatNoProbeSeesHasTheLightOfTheCellsInTheOpen)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
    FieldData field = litField(scene, {{0.3f, 0.2f, -0.1f}, {-0.4f, -0.3f, 0.2f}}, [](vec3) { return 1.0f; });
    const vec3 open(0.0f, 0.1f, 0.5f); // where something moves
    Text text(field, testing_support::defaultQuality());
    for (size_t i = 0; i < field.irradiance.size(); i += 2)
    {
        field.irradiance[i] = text.packRadiance(vec3(7.0f));
        field.irradiance[i + 1] = text.realToHalf(2.0f);
    }
    const auto dark = lightOf(field, open, vec3(0, 0, -1));
    EXPECT_EQ(dark.probes, -3) << "no cell knows yet";
    EXPECT_NEAR(dark.light.g, 7.0f, 0.1f);
    for (size_t i = field.surfaceLight.size() - cellWords(field.info); i < field.surfaceLight.size(); i += gpu::kCellWords)
    {
        for (uint32_t facing = 0; facing < 6; ++facing) field.surfaceLight[i + facing] = text.packSharedExponent(vec3(float(1 + facing)));
        field.surfaceLight[i + 6] = 512u | 512u << 10 | 512u << 20 | gpu::kCellKnown; // its middle
    }
    for (const auto& [normal, light] : {std::pair{vec3(1, 0, 0), 1.0f},
                                        {vec3(-1, 0, 0), 2.0f},
                                        {vec3(0, 1, 0), 3.0f},
                                        {vec3(0, -1, 0), 4.0f},
                                        {vec3(0, 0, 1), 5.0f},
                                        {vec3(0, 0, -1), 6.0f},
                                        {vec3(0.6f, 0.0f, -0.8f), 0.36f * 1.5f + 0.64f * 5.5f - 0.6f * 0.5f + 0.8f * 0.5f}})
    {
        const auto found = lightOf(field, open, normal);
        EXPECT_EQ(found.probes, -2);
        EXPECT_NEAR(found.light.g, light, 0.01f);
    }
}

TEST(SurfaceLight, TiltsComeBackWithinHalfAStep)
{
    for (float x = -2.4f; x <= 2.4f; x += 0.3f)
        for (float y = -2.0f; y <= 2.0f; y += 0.25f)
        {
            const vec2 found = Text::unpackTilt(Text::packTilt(vec2(x, y)));
            EXPECT_NEAR(found.x, std::clamp(x, -2.0f, 2.0f), 1.001f / 127.0f);
            EXPECT_NEAR(found.y, std::clamp(y, -2.0f, 2.0f), 1.001f / 127.0f);
        }
    EXPECT_EQ(Text::unpackTilt(Text::packTilt(vec2(0.0f))), vec2(0.0f)) << "even light has none";
}

TEST(SurfaceLight, PointsThatAreNoneAreBlack)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("wall", vec3(0.5f)));
    const FieldData field = litField(scene, {{0.3f, 0.2f, -0.1f}}, [](vec3) { return 1.0f; });
    for (const auto& [point, normal] :
         {std::pair{vec3(NAN), vec3(0, 1, 0)}, {vec3(0.0f, -1.0f, 0.0f), vec3(0.0f)}, {vec3(INFINITY), vec3(0, 1, 0)}})
        EXPECT_EQ(lightOf(field, point, normal).light, vec3(0.0f));
    // At a probe itself there is no direction to it; any finite light will do.
    EXPECT_TRUE(std::isfinite(lightOf(field, vec3(0.3f, 0.2f, -0.1f), vec3(0, 1, 0)).light.g));
}

} // namespace
} // namespace sconce
