// Emitters that are lamps: which are, and their light in a frame against the path tracer's.
#include "runtime/bake/lamps.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "runtime/field/field_space.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSide = 96; // pixels
constexpr float kHigh = 25.0f; // metres

/// A floor with a box and a thin post on it, under what `light` adds; seen so that their shadows are in the middle.
template <class Light> Scene litFloor(Light light)
{
    Scene scene;
    MeshBuilder mesh(scene);
    mesh.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}, mesh.material("floor", vec3(0.5f), 0.3f));
    mesh.box({-1.0f, 0.0f, -0.4f}, {-0.4f, 1.2f, 0.3f}, mesh.material("box", vec3(0.4f, 0.2f, 0.1f), 0.8f));
    mesh.box({0.6f, 0.0f, 0.0f}, {0.66f, 0.8f, 0.06f}, mesh.material("post", vec3(0.1f), 1.0f));
    light(mesh);
    mesh.camera("above", {0.3f, 2.2f, 3.0f}, {0.1f, 0.2f, 0.0f}, 50.0f);
    return scene;
}

/// A square a metre wide, aslant, whose light is the floor's.
void addFarSquare(MeshBuilder& mesh)
{
    mesh.quad({9.5f, kHigh, -0.5f}, {10.5f, kHigh, -0.5f}, {10.5f, kHigh, 0.5f}, {9.5f, kHigh, 0.5f}, mesh.emitter("lamp", vec3(2000.0f)));
}

const std::vector<vec3> kProbes = {{0.2f, 1.0f, 1.2f}, {-2.0f, 1.5f, 1.0f}, {2.0f, 1.2f, -0.6f}, {-1.6f, 0.7f, -1.2f}, {0.0f, 2.5f, -1.0f}};

Lamps lampsOf(const Scene& scene)
{
    const auto rays = TriangleRays::build(scene);
    const gpu::LightFieldInfo space = fieldSpace(scene.bounds());
    std::vector<gpu::ProbeHeader> probes;
    for (const vec3& probe : kProbes) probes.emplace_back().centre = (probe - space.origin) / space.scale;
    return findLamps(*rays, space, probes, 512);
}

TEST(Lamps, ASmallFarSquareIsOne)
{
    const Scene scene = litFloor(addFarSquare);
    const Lamps found = lampsOf(scene);
    ASSERT_EQ(found.lamps.size(), 1u);
    EXPECT_EQ(found.maps.size(), lampMapWords(512));
    EXPECT_EQ(found.triangles, (std::vector<uint32_t>{uint32_t(scene.triangles.size()) - 2, uint32_t(scene.triangles.size()) - 1}));
    EXPECT_EQ(found.lamps[0].radiance, vec3(2000.0f));
    EXPECT_LT(found.lamps[0].normal.y, -0.99f) << "to where its light goes, whichever side its winding says";
    // A disc as large has a radius of 1 / sqrt(pi).
    EXPECT_NEAR(double(found.lamps[0].reach) * double(fieldSpace(scene.bounds()).scale), 0.5642, 1e-3);
}

TEST(Lamps, OthersStayEmitters)
{
    const auto quadAt = [](float high, float half, vec3 radiance)
    {
        return [=](MeshBuilder& mesh) {
            mesh.quad({-half, high, -half}, {half, high, -half}, {half, high, half}, {-half, high, half}, mesh.emitter("lamp", radiance));
        };
    };
    EXPECT_TRUE(lampsOf(litFloor(quadAt(4.0f, 0.5f, vec3(10.0f)))).lamps.empty()) << "wide: its shadows are softer than texels";
    EXPECT_TRUE(lampsOf(litFloor(
                            [](MeshBuilder& mesh) {
                                mesh.box({-0.1f, kHigh, -0.1f}, {0.1f, kHigh + 0.1f, 0.1f}, mesh.emitter("box", vec3(1e4f)));
                            }))
                    .lamps.empty())
        << "not flat";
    EXPECT_TRUE(lampsOf(litFloor(quadAt(0.9f, 0.02f, vec3(1e4f)))).lamps.empty()) << "lights what is above it and below it";
    // Beside one that gives a hundred times as much.
    const Scene two = litFloor(
        [&](MeshBuilder& mesh)
        {
            quadAt(30.0f, 0.3f, vec3(10.0f))(mesh);
            addFarSquare(mesh);
        });
    const Lamps found = lampsOf(two);
    ASSERT_EQ(found.lamps.size(), 1u);
    EXPECT_EQ(found.lamps[0].radiance, vec3(2000.0f));
}

class LampFrames : public testing_support::FrameTest
{
protected:
    Result<FieldData> bake(const Scene& scene, uint32_t lampTexels)
    {
        const auto rays = TriangleRays::build(scene);
        BakeSettings settings;
        settings.resolution = 256;
        settings.bounces = 3;
        settings.lampTexels = lampTexels;
        settings.rays = &*rays;
        BakeReport report;
        return bakeLightField(gpu(), scene, kProbes, settings, {}, report);
    }

    static double mean(std::span<const float> values)
    {
        double sum = 0.0;
        for (float v : values) sum += double(v);
        return sum / double(values.size());
    }

    /// Mean of |a - b| over the mean of b, and mean of a over that of b.
    struct Difference
    {
        double off, mean;
    };
    static Difference differenceOf(const std::vector<vec3>& a, std::span<const float> b)
    {
        const std::span<const float> own(&a[0].x, 3 * a.size());
        double sum = 0.0;
        for (size_t i = 0; i < own.size(); ++i) sum += std::abs(double(own[i]) - double(b[i]));
        return {sum / double(b.size()) / mean(b), mean(own) / mean(b)};
    }
};

TEST_F(LampFrames, ShadowsAndReflectionsAreThePathTracers)
{
    const Scene scene = litFloor(addFarSquare);
    ReferenceSettings reference;
    reference.width = reference.height = kSide;
    reference.samples = 512;
    reference.bounces = 3;
    reference.pixelCentre = true;
    reference.camera = scene.cameras.front();
    const ImageSet truth = std::move(renderReference(scene, reference)->images);
    RenderSettings settings = settingsOf(kSide);
    settings.glossyRays = 16;
    Difference diffuse[2], glossy[2];
    for (const uint32_t texels : {0u, 2048u})
    {
        const auto field = bake(scene, texels);
        ASSERT_TRUE(field) << field.error().message;
        ASSERT_EQ(field->lamps.size(), texels > 0 ? 1u : 0u);
        const auto frame = drawWith(*field, scene, settings);
        ASSERT_TRUE(frame) << frame.error().message;
        EXPECT_EQ(std::ranges::any_of(frame->times, [](const auto& scope) { return scope.name == std::string_view("lamp light"); }),
                  texels > 0);
        diffuse[texels > 0] = differenceOf(frame->diffuseIndirect, truth.find("diffuse_indirect")->pixels);
        glossy[texels > 0] = differenceOf(frame->glossyIndirect, truth.find("glossy_indirect")->pixels);
    }
    for (int lamp : {0, 1})
        RecordProperty(lamp ? "as a lamp" : "as an emitter",
                       "diffuse " + std::to_string(diffuse[lamp].off) + ", mean " + std::to_string(diffuse[lamp].mean) + ", glossy " +
                           std::to_string(glossy[lamp].off) + ", mean " + std::to_string(glossy[lamp].mean));
    EXPECT_LT(diffuse[1].off, 0.0045);
    EXPECT_NEAR(diffuse[1].mean, 1.0, 0.005) << "nothing is counted twice or left out";
    EXPECT_LT(diffuse[1].off, 0.8 * diffuse[0].off);
    EXPECT_LT(glossy[1].off, 0.06) << "of the truth's own noise, too";
    EXPECT_NEAR(glossy[1].mean, 1.0, 0.03);
    EXPECT_LT(glossy[1].off, 0.1 * glossy[0].off);
}

} // namespace
} // namespace sconce
