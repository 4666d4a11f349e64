// Texels that are refined where light changes within one, against brute force.
#include "runtime/bake/refined_texels.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "runtime/bake/bake.h"
#include "runtime/field/tracer_cpu.h"
#include "scene/mesh_builder.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"
#include "tests/support/square_lamp.h"

namespace sconce
{
namespace
{

constexpr float kHalf = 0.05f, kHeight = 0.06f; // of the lamp, metres

class RefinedTexels : public testing::Test
{
protected:
    RefinedTexels()
    {
        MeshBuilder mesh(scene);
        mesh.box(vec3(-3.0f, -0.2f, -3.0f), vec3(3.0f, 0.0f, 3.0f), mesh.material("black", vec3(0.0f), 1.0f));
        mesh.quad({-kHalf, kHeight, -kHalf}, {kHalf, kHeight, -kHalf}, {kHalf, kHeight, kHalf}, {-kHalf, kHeight, kHalf},
                  mesh.emitter("lamp", vec3(1.0f)));
    }

    FieldData bake(float share)
    {
        const auto rays = TriangleRays::build(scene);
        BakeSettings settings;
        settings.resolution = 256;
        settings.bounces = 1;
        settings.surfaceTexels = 26;
        settings.surfaceRefined = share;
        settings.rays = &*rays;
        settings.octree.voxels = 16;
        BakeReport report;
        auto field = bakeLightField(device.gpu(), scene, std::vector<vec3>{{0.9f, 1.0f, 0.3f}}, settings, {}, report);
        if (!field) throw std::runtime_error(field.error().message);
        return std::move(*field);
    }

    /// Sum of the errors of light on the floor about the lamp, over the sum of the light.
    static double errorOf(const FieldData& field)
    {
        twin::LightFieldTwin<float> text(field, {});
        Random random(5, 0);
        double off = 0.0, all = 0.0;
        for (int i = 0; i < 400; ++i)
        {
            const vec2 to = 2.0f * random.uniform2() - 1.0f;
            const vec3 at(0.3f * to.x, 0.0f, 0.3f * to.y), up(0, 1, 0), point = (at - field.info.origin) / field.info.scale;
            int reads = 0;
            const auto found = text.surfaceLightAt(point, up, up, point + 0.5f * field.info.voxel * up, reads);
            if (found.probes < 1) continue;
            const double truth = testing_support::fromSquareLamp(vec3(0, kHeight, 0), kHalf, at, up);
            off += std::abs(double(found.light.g) - truth);
            all += truth;
        }
        return off / all;
    }

    testing_support::SharedDevice device;
    Scene scene;
};

TEST_F(RefinedTexels, LightNextToALampIsNearerToTheTruth)
{
    const FieldData plain = bake(0.0f), refined = bake(0.05f);
    EXPECT_EQ(plain.info.refinedTexels, 0u);
    ASSERT_GT(refined.info.refinedTexels, 10u);
    EXPECT_LE(refined.info.refinedTexels, 6u * 26u * 26u / 20u);
    const double before = errorOf(plain), after = errorOf(refined);
    RecordProperty("error, plain and refined", std::to_string(before) + " " + std::to_string(after));
    EXPECT_LT(after, 0.65 * before) << "plain: " << before;
    EXPECT_LT(after, 0.13) << "light falls to a tenth within two texels: finer ones follow it in steps";
}

// Where light is even, nothing is refined.
TEST_F(RefinedTexels, EvenLightHasNone)
{
    scene = Scene();
    MeshBuilder mesh(scene);
    const uint32_t wall = mesh.material("glowing", vec3(0.5f), 1.0f);
    scene.materials[wall].emission = vec3(1.0f);
    mesh.box(vec3(-1.0f), vec3(3.0f), wall);
    EXPECT_EQ(bake(0.25f).info.refinedTexels, 0u);
}

TEST_F(RefinedTexels, TheSameBakeHasTheSameBytes)
{
    const FieldData one = bake(0.02f), other = bake(0.02f);
    EXPECT_EQ(one.surfaceLight, other.surfaceLight);
}

} // namespace
} // namespace sconce
