// Light gathered at surfaces, against closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <gtest/gtest.h>

#include "runtime/bake/bake.h"
#include "runtime/field/light_field_file.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"
#include "tests/support/files.h"
#include "tests/support/test_scenes.h"

namespace sconce
{
namespace
{

using Text = twin::LightFieldTwin<float>;

class SurfaceBake : public testing::Test
{
protected:
    FieldData bake(const Scene& scene, std::vector<vec3> probes, uint32_t bounces, uint32_t surfaceTexels = 26,
                   std::string_view gather = knobs::gather.value)
    {
        BakeSettings settings;
        settings.resolution = 128;
        settings.bounces = bounces;
        settings.surfaceTexels = surfaceTexels;
        settings.surfaceRefined = 0.0f;
        std::optional<TriangleRays> rays;
        if (gather == knobs::kGathers[0]) settings.rays = &rays.emplace(std::move(*TriangleRays::build(scene)));
        settings.octree.voxels = 16;
        auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, report);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }
    /// Mean and the largest relative difference from it of all texels that see a surface, green.
    struct Spread
    {
        double mean = 0.0, worst = 0.0;
    };
    static std::span<const uint32_t> texelsOf(const FieldData& field)
    {
        return std::span(field.surfaceLight).first(surfaceTexelWords(field.info));
    }
    /// Green of all cells that know their light, on a facing.
    static std::vector<double> cellsOf(const FieldData& field, size_t facing)
    {
        Text text(field, {});
        std::vector<double> values;
        for (size_t i = texelsOf(field).size(); i < texelsOf(field).size() + cellWords(field.info); i += gpu::kCellWords)
            if (field.surfaceLight[i + 6] != 0) values.push_back(text.unpackSharedExponent(field.surfaceLight[i + facing]).g);
        return values;
    }
    static Spread spreadOf(const FieldData& field)
    {
        Text text(field, {});
        std::vector<double> values;
        for (const uint32_t word : texelsOf(field)) values.push_back(text.unpackSharedExponent(word).g);
        return spreadOf(values);
    }
    static Spread spreadOf(const std::vector<double>& values)
    {
        Spread spread;
        for (const double v : values) spread.mean += v / double(values.size());
        for (const double v : values) spread.worst = std::max(spread.worst, std::abs(v / spread.mean - 1.0));
        return spread;
    }
    testing_support::SharedDevice device;
    BakeReport report;
};

Light pointLight(float intensity)
{
    Light light;
    light.type = LightType::point;
    light.intensity = vec3(intensity);
    return light;
}

// An integrating sphere about a point light: all of it sends albedo I / (pi r^2) after one scattering, and each bounce the albedo's share
// of the one before. What arrives straight from the light is the host's and is no part of it.
TEST_F(SurfaceBake, EachBounceInASphereIsTheAlbedosShareOfTheOneBefore)
{
    constexpr float kAlbedo = 0.6f, kRadius = 2.0f, kIntensity = 8.0f;
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.sphere(vec3(0.0f), kRadius, 64, 32, mesh.material("white", vec3(test::RoughModel::baseColorOf(kAlbedo))));
    scene.lights.push_back(pointLight(kIntensity));
    const double first = kAlbedo * kIntensity / (std::numbers::pi * kRadius * kRadius);
    for (const std::string_view gather : knobs::kGathers)
        for (const uint32_t bounces : {0u, 1u, 2u, 4u, 8u})
        {
            const double sum = first * (1.0 - std::pow(kAlbedo, double(bounces + 1))) / (1.0 - kAlbedo);
            const FieldData field = bake(scene, {vec3(0.3f, 0.2f, 0.1f), vec3(-0.5f, -0.3f, 0.4f)}, bounces, 26, gather);
            const Spread found = spreadOf(field);
            EXPECT_NEAR(found.mean, sum, 0.01 * sum) << gather << ", " << bounces << " bounces";
            EXPECT_LT(found.worst, 0.06) << gather << ", " << bounces << " bounces";
            if (bounces == 0) continue;
            // All that a place in the open sees is as bright.
            const std::vector<double> open = cellsOf(field, bounces % 6);
            EXPECT_GT(open.size(), 10u);
            const Spread cells = spreadOf(open);
            EXPECT_NEAR(cells.mean, sum, 0.01 * sum) << gather << ", " << bounces << " bounces";
            EXPECT_LT(cells.worst, 0.06) << gather << ", " << bounces << " bounces";
        }
}

// Octahedral maps, which hold no surface light, take that of cube faces: every texel of a sphere about a point light sends its first light
// over 1 - albedo, and an emitting sphere its emission over that.
TEST_F(SurfaceBake, OctahedralMapsReflectTheLightThatIsLent)
{
    constexpr float kAlbedo = 0.6f, kRadius = 2.0f, kIntensity = 8.0f;
    for (const bool glows : {false, true})
    {
        Scene scene;
        MeshBuilder mesh(scene);
        const uint32_t white = mesh.material("white", vec3(test::RoughModel::baseColorOf(kAlbedo)));
        if (glows)
            scene.materials[white].emission = vec3(1.0f);
        else
            scene.lights.push_back(pointLight(kIntensity));
        mesh.sphere(vec3(0.0f), kRadius, 64, 32, white);
        const double first = glows ? 1.0 : kAlbedo * kIntensity / (std::numbers::pi * kRadius * kRadius);
        const TriangleRays rays = std::move(*TriangleRays::build(scene));
        BakeSettings settings;
        settings.resolution = 80; // of cube faces 96
        settings.chart = gpu::kChartOctahedral;
        settings.surfaceTexels = 26;
        settings.surfaceRefined = 0.0f;
        settings.octree.voxels = 16;
        settings.bounces = 32;
        settings.converged = 0.0005f;
        settings.rays = &rays;
        const std::vector<vec3> probes{vec3(0.3f, 0.2f, 0.1f), vec3(-0.5f, -0.3f, 0.4f)};
        const auto light = bakeLightField(device.gpu(), scene, probes, lendingBake(settings), {}, report);
        ASSERT_TRUE(light) << light.error().message;
        EXPECT_EQ(light->info.chart, gpu::kChartCube);
        settings.light = &*light;
        const auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, report);
        ASSERT_TRUE(field) << field.error().message;
        EXPECT_EQ(field->info.chart, gpu::kChartOctahedral);
        EXPECT_TRUE(field->surfaceLight.empty());
        Text text(*field, {});
        std::vector<double> sent;
        for (const uint32_t word : field->radiance) sent.push_back(text.unpackRadiance(word).g);
        const Spread found = spreadOf(sent);
        EXPECT_NEAR(found.mean, first / (1.0 - kAlbedo), 0.01 * first / (1.0 - kAlbedo)) << (glows ? "emitter" : "point light");
        EXPECT_LT(found.worst, 0.08) << (glows ? "emitter" : "point light");
    }
}

TEST_F(SurfaceBake, LightOfOtherProbesOrWithoutSurfacesIsNotLent)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("white", vec3(0.5f)));
    const FieldData light = bake(scene, {vec3(0.1f)}, 0), without = bake(scene, {vec3(0.1f)}, 0, 0);
    BakeSettings settings;
    settings.resolution = 64;
    settings.chart = gpu::kChartOctahedral;
    const auto complaint = [&](const FieldData& lender, std::vector<vec3> probes)
    {
        settings.light = &lender;
        const auto field = bakeLightField(device.gpu(), scene, probes, settings, {}, report);
        return field ? "baked" : field.error().message;
    };
    EXPECT_NE(complaint(light, {vec3(0.1f), vec3(0.2f)}).find("has 1 probes, not the 2"), std::string::npos);
    EXPECT_NE(complaint(light, {vec3(0.2f)}).find("at the same places"), std::string::npos);
    EXPECT_NE(complaint(without, {vec3(0.1f)}).find("holds no surface light"), std::string::npos);
    EXPECT_EQ(complaint(light, {vec3(0.1f)}), "baked");
}

// Under a sky of radiance 1 a plate gathers 1 at every point of its upper side.
TEST_F(SurfaceBake, APlateUnderTheSkyGathersTheSky)
{
    Scene scene;
    scene.sky = vec3(1.0f);
    MeshBuilder mesh(scene);
    mesh.box(vec3(-2.0f, -0.2f, -2.0f), vec3(2.0f, 0.0f, 2.0f), mesh.material("grey", vec3(0.5f)));
    const FieldData field = bake(scene, {vec3(0.0f, 1.0f, 0.0f)}, 2);
    Text text(field, {});
    int found = 0;
    for (int i = 0; i < int(texelsOf(field).size()); ++i)
    {
        const int side = int(field.info.surfaceSize), face = i / (side * side);
        const auto point = text.surfacePointAt(0, face, i % side, i / side % side);
        if (point.width > 0.0f)
        {
            ++found;
            EXPECT_NEAR(text.unpackSharedExponent(field.surfaceLight[size_t(i)]).g, 1.0f, 0.002f);
        }
        else
            EXPECT_EQ(field.surfaceLight[size_t(i)], 0u) << "sky has no surface";
    }
    EXPECT_GT(found, 100);
    const std::vector<double> up = cellsOf(field, 2);
    EXPECT_GT(up.size(), 4u);
    for (const double light : up) EXPECT_NEAR(light, 1.0, 0.002);
}

// Two rooms with a wall of 4 cm between them, a lamp in one: in the dark one a point beside the wall has no light of the cells beyond it.
TEST_F(SurfaceBake, CellsKeepTheSidesOfAWallApart)
{
    Scene scene;
    MeshBuilder mesh(scene);
    const uint32_t white = mesh.material("white", vec3(0.7f));
    mesh.box(vec3(-2.2f, -0.2f, -1.2f), vec3(2.2f, 0.0f, 1.2f), white);
    mesh.box(vec3(-2.2f, 2.0f, -1.2f), vec3(2.2f, 2.2f, 1.2f), white);
    mesh.box(vec3(-2.2f, 0.0f, -1.2f), vec3(-2.0f, 2.0f, 1.2f), white);
    mesh.box(vec3(2.0f, 0.0f, -1.2f), vec3(2.2f, 2.0f, 1.2f), white);
    mesh.box(vec3(-2.0f, 0.0f, -1.2f), vec3(2.0f, 2.0f, -1.0f), white);
    mesh.box(vec3(-2.0f, 0.0f, 1.0f), vec3(2.0f, 2.0f, 1.2f), white);
    mesh.box(vec3(-0.02f, 0.0f, -1.0f), vec3(0.02f, 2.0f, 1.0f), white);
    mesh.quad({0.8f, 1.9f, -0.3f}, {1.2f, 1.9f, -0.3f}, {1.2f, 1.9f, 0.3f}, {0.8f, 1.9f, 0.3f}, mesh.emitter("lamp", vec3(100.0f)));
    const FieldData field = bake(scene, {vec3(-1.0f, 1.1f, 0.1f), vec3(1.0f, 0.9f, -0.1f)}, 4);
    Text text(field, {});
    const auto lightAt = [&](float x)
    {
        const vec3 point = (vec3(x, 1.0f, 0.3f) - field.info.origin) / field.info.scale;
        int reads = 0;
        const Text::vec4 found = text.cellLightAt(point, vec3(0, 1, 0), text.rankedProbesAt(point, reads));
        EXPECT_EQ(found.w, 1.0f) << x;
        return found.y;
    };
    const float bright = lightAt(0.06f);
    EXPECT_GT(bright, 1.0f);
    for (const float x : {-0.06f, -0.1f, -0.2f, -0.5f, -1.0f}) EXPECT_LT(lightAt(x), 1e-4f * bright) << x;
}

// Where no frame reads it, surface light is made for what rays meet, and not kept.
TEST_F(SurfaceBake, IsDroppedWhereNoFrameReadsIt)
{
    Scene scene;
    scene.sky = vec3(1.0f);
    MeshBuilder mesh(scene);
    mesh.box(vec3(-3.0f, -0.2f, -3.0f), vec3(3.0f, 0.0f, 3.0f), mesh.material("grey", vec3(0.5f)));
    const auto baked = [&](bool reads)
    {
        BakeSettings settings;
        settings.resolution = 64;
        settings.surfaceTexels = 26;
        settings.octree.voxels = 16;
        settings.readsSurfaces = reads;
        BakeReport spent;
        auto field = bakeLightField(device.gpu(), scene, std::vector<vec3>{{0.1f, 1.0f, 0.2f}}, settings, {}, spent);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    };
    const FieldData read = baked(true), without = baked(false);
    EXPECT_FALSE(read.surfaceLight.empty());
    EXPECT_TRUE(without.surfaceLight.empty());
    EXPECT_EQ(without.radiance, read.radiance);
    const testing_support::TestFolder folder;
    ASSERT_TRUE(saveField(without, folder / "f.sconce"));
    const auto again = loadField(folder / "f.sconce");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->radiance, without.radiance);
}

// A square emitter over a plane: below its middle the cosine-weighted mean of its radiance is its form factor (Howell, "A Catalog of
// Radiation Heat Transfer Configuration Factors", B-4: a point parallel to a rectangle's corner, four times).
TEST_F(SurfaceBake, BelowALampIsTheLampsFormFactor)
{
    constexpr double kHalf = 0.5, kAbove = 1.5;
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-3.0f, -0.2f, -3.0f), vec3(3.0f, 0.0f, 3.0f), mesh.material("black", vec3(0.0f), 1.0f));
    mesh.quad({-0.5f, 1.5f, -0.5f}, {0.5f, 1.5f, -0.5f}, {0.5f, 1.5f, 0.5f}, {-0.5f, 1.5f, 0.5f}, mesh.emitter("lamp", vec3(2.0f)));
    const FieldData field = bake(scene, {vec3(0.2f, 1.0f, 0.1f), vec3(-0.3f, 0.8f, -0.2f)}, 0, 52);
    const double x = kHalf / kAbove, root = std::sqrt(1.0 + x * x);
    const double corner = (x / root * std::atan(x / root) * 2.0) / (2.0 * std::numbers::pi);
    Text text(field, {});
    const vec3 p = (vec3(0.0f) - field.info.origin) / field.info.scale;
    int reads = 0;
    const auto found = text.surfaceLightAt(p, vec3(0, 1, 0), vec3(0, 1, 0), p + vec3(0.0f, 0.5f * field.info.voxel, 0.0f), reads);
    EXPECT_EQ(found.probes, 2);
    EXPECT_NEAR(found.light.g, 2.0 * 4.0 * corner, 0.02 * 8.0 * corner);
}

// At the foot of a black wall half of the sky is left, on one side. A normal that leans towards it by an angle t gets (cos t + sin t) / 2
// of the sky, one that leans to the wall (1 - sin t) / 2, and one along the wall (1 + cos t) / 4: lunes of the sphere. What is linear in
// the normal is off by 5 and 13 % there.
TEST_F(SurfaceBake, NormalsThatLeanFromAWallGetMoreOfTheSky)
{
    Scene scene;
    scene.sky = vec3(1.0f);
    MeshBuilder mesh(scene);
    const uint32_t black = mesh.material("black", vec3(0.0f), 1.0f);
    mesh.box(vec3(-3.0f, -0.2f, -20.0f), vec3(0.0f, 0.0f, 20.0f), black);
    mesh.box(vec3(0.0f, -0.2f, -20.0f), vec3(0.3f, 20.0f, 20.0f), black);
    scene.images.push_back({"flat", 1, 1, {128, 128, 255, 255}});
    const std::vector<vec3> probes{vec3(-1.0f, 1.2f, 0.1f), vec3(-0.8f, 0.9f, -0.3f)};
    const auto lightOf = [&](const FieldData& field, vec3 leaning)
    {
        Text text(field, {});
        const vec3 p = (vec3(-0.4f, 0.0f, 0.0f) - field.info.origin) / field.info.scale;
        int reads = 0;
        const auto found =
            text.surfaceLightAt(p, glm::normalize(leaning), vec3(0, 1, 0), p + vec3(0.0f, 0.5f * field.info.voxel, 0.0f), reads);
        EXPECT_EQ(found.probes, 2);
        return double(found.light.g);
    };
    const FieldData without = bake(scene, probes, 0, 52);
    EXPECT_EQ(without.info.surfaceDirections, 0u);
    EXPECT_EQ(lightOf(without, {-1, 2, 0}), lightOf(without, {0, 1, 0})) << "no texture bends normals: what they get isn't kept";
    scene.materials[black].normalTexture.image = 0;
    const FieldData field = bake(scene, probes, 0, 52);
    ASSERT_EQ(field.info.surfaceDirections, 1u);
    EXPECT_EQ(surfaceTexelWords(field.info) - surfaceTexelWords(without.info), size_t(6) * 52 * 52); // two texels a word, two probes
    const double t = std::numbers::pi / 6, s = std::sin(t), c = std::cos(t), half = lightOf(field, {0, 1, 0});
    EXPECT_NEAR(half, 0.5, 0.02);
    EXPECT_NEAR(lightOf(field, {-s, c, 0}), (c + s) / 2, 0.07 * (c + s) / 2);
    EXPECT_NEAR(lightOf(field, {s, c, 0}), (1 - s) / 2, 0.2 * (1 - s) / 2);
    EXPECT_NEAR(lightOf(field, {0, c, s}), (1 + c) / 4, 0.05 * (1 + c) / 4);
    EXPECT_NEAR(lightOf(field, {0, c, -s}), (1 + c) / 4, 0.05 * (1 + c) / 4);
}

// A globe sends light by its outside alone: shadows that let its far side through made it twice as bright.
TEST_F(SurfaceBake, AGlobeOfACentimetreIsNoBrighterThanItsOutside)
{
    constexpr double kRadius = 0.01;
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-3.0f, -0.2f, -3.0f), vec3(3.0f, 0.0f, 3.0f), mesh.material("black", vec3(0.0f), 1.0f));
    mesh.sphere(vec3(0.0f, 1.0f, 0.0f), float(kRadius), 32, 16, mesh.emitter("globe", vec3(1000.0f)));
    const FieldData field = bake(scene, {vec3(1.0f, 1.2f, 0.3f), vec3(-0.8f, 0.9f, -0.5f)}, 0, 52);
    Text text(field, {});
    const vec3 p = (vec3(0.0f) - field.info.origin) / field.info.scale;
    int reads = 0;
    const double arriving =
        text.surfaceLightAt(p, vec3(0, 1, 0), vec3(0, 1, 0), p + vec3(0.0f, 0.5f * field.info.voxel, 0.0f), reads).light.g;
    EXPECT_NEAR(arriving, 1000.0 * kRadius * kRadius, 0.03 * 1000.0 * kRadius * kRadius); // a disc of its radius, 1 m off
}

// Steps as high as two texels, seen from above: 52 texels a side don't divide faces of 64, and a texel whose finer ones left out the one
// that it stands for had no normal and no light.
TEST_F(SurfaceBake, RisersOfStepsUnderTheSkyAreNotBlack)
{
    Scene scene;
    scene.sky = vec3(1.0f);
    MeshBuilder mesh(scene);
    const uint32_t grey = mesh.material("grey", vec3(0.5f));
    for (int step = 0; step < 5; ++step) mesh.box({-4.0f, -0.5f, -4.0f}, {4.0f, 0.22f * float(step), 2.0f - 0.35f * float(step)}, grey);
    mesh.box({-6.0f, -0.7f, -6.0f}, {6.0f, -0.5f, 6.0f}, grey);
    const FieldData field = bake(scene, {vec3(0.4f, 3.0f, 2.7f)}, 1, 52);
    Text text(field, {});
    int risers = 0, black = 0;
    const int side = int(field.info.surfaceSize);
    for (int i = 0; i < int(texelsOf(field).size()); ++i)
    {
        const auto point = text.surfacePointAt(0, i / (side * side), i % side, i / side % side);
        if (!(point.width > 0.0f) || point.normal.z < 0.9f) continue;
        ++risers;
        black += text.unpackSharedExponent(field.surfaceLight[size_t(i)]).g < 0.2f && field.surfaceLight[size_t(i)] != 0;
    }
    EXPECT_GT(risers, 100);
    EXPECT_EQ(black, 0);
}

TEST_F(SurfaceBake, TheSameBakeGivesTheSameBytes)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("white", vec3(0.5f)));
    mesh.quad({-0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, -0.3f}, {0.3f, 0.9f, 0.3f}, {-0.3f, 0.9f, 0.3f}, mesh.emitter("lamp", vec3(5.0f)));
    const std::vector<vec3> probes = {vec3(0.2f, 0.1f, 0.1f), vec3(-0.4f, -0.3f, 0.2f)};
    const FieldData a = bake(scene, probes, 2), b = bake(scene, probes, 2);
    EXPECT_FALSE(a.surfaceLight.empty());
    EXPECT_TRUE(a.surfaceLight == b.surfaceLight && a.radiance == b.radiance && a.irradiance == b.irradiance);
}

TEST_F(SurfaceBake, WhatABakeMayNotTakeIsRefusedByItsSentence)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.box(vec3(-1.0f), vec3(1.0f), mesh.material("white", vec3(0.5f)));
    BakeSettings settings;
    settings.surfaceTexels = 50;
    auto odd = bakeLightField(device.gpu(), scene, std::vector<vec3>{vec3(0.0f)}, settings, {}, report);
    ASSERT_FALSE(odd);
    EXPECT_NE(odd.error().message.find("surfaceTexels is 50"), std::string::npos) << odd.error().message;
    settings.surfaceTexels = 52;
    settings.surfaceRays = 0;
    auto none = bakeLightField(device.gpu(), scene, std::vector<vec3>{vec3(0.0f)}, settings, {}, report);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("surfaceRays is 0"), std::string::npos) << none.error().message;
    settings.surfaceRays = 64;
    settings.hostMemory = 6u << 20;
    auto little = bakeLightField(device.gpu(), scene, std::vector<vec3>{vec3(0.0f)}, settings, {}, report);
    ASSERT_FALSE(little);
    EXPECT_EQ(little.error().code, ErrorCode::outOfMemory) << "the links alone take 4 MiB";
}

} // namespace
} // namespace sconce
