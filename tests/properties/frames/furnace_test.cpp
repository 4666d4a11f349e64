// A convex body under a sky of radiance 1 everywhere: what leaves it is what its BRDF reflects of white light, and no more.
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 40; // pixels

Scene ball(vec3 color, float roughness, float metallic)
{
    Scene scene;
    scene.name = "ball";
    MeshBuilder mesh(scene);
    mesh.sphere(vec3(0.0f), 1.0f, 96, 48, mesh.material("white", color, roughness, metallic));
    mesh.camera("view", vec3(0, 0, 4), vec3(0.0f), 24.0f); // the ball fills most of the picture
    scene.sky = vec3(1.0f);
    return scene;
}

class FurnaceTest : public FrameTest
{
};

TEST_F(FurnaceTest, ReflectsWhatThePathTracerSaysWithinOnePercent)
{
    const std::vector<vec3> probes = {{0, 0, 2}, {0, 2, 0}, {2, 0, 0}, {-2, 0, 0}, {0, -2, 0}, {0, 0, -2}};
    // A percent is asked for; of metals twice what is found, and at least what is left of the noise.
    for (const auto& [roughness, metallic, most] : {std::tuple{0.0f, 1.0f, 0.001},
                                                    {0.2f, 1.0f, 0.001},
                                                    {0.3f, 0.0f, 0.01},
                                                    {0.4f, 1.0f, 0.0033},
                                                    {0.6f, 1.0f, 0.0041},
                                                    {1.0f, 1.0f, 0.0068},
                                                    {1.0f, 0.0f, 0.01}})
    {
        const Scene scene = ball(vec3(1.0f), roughness, metallic);
        const auto field = bakeField(scene, probes, 64, 0, kFewTexels, knobs::surfaceRays.value);
        ASSERT_TRUE(field) << field.error().message;
        RenderSettings settings = settingsOf(kSide);
        settings.glossyRays = 8;
        settings.areaSamples = 64;
        const auto frame = drawWith(*field, scene, settings);
        ASSERT_TRUE(frame) << frame.error().message;
        ReferenceSettings reference;
        reference.bounces = 2;
        reference.width = reference.height = kSide;
        reference.samples = 144;
        reference.pixelCentre = true;
        reference.camera = scene.cameras.front();
        const ImageSet truth = std::move(renderReference(scene, reference)->images);
        double got = 0.0, asked = 0.0, pixels = 0.0;
        for (size_t i = 0; i < frame->depth.size(); ++i)
        {
            if (!(frame->depth[i] > 0.0f)) continue;
            got += frame->beauty[i].x;
            asked += truth.find("beauty")->pixels[3 * i];
            pixels += 1.0;
        }
        EXPECT_NEAR(asked / pixels, 1.0, 0.01) << "the path tracer's, roughness " << roughness << ", metallic " << metallic; // all is white
        char name[128];
        std::snprintf(name, sizeof(name), "furnace, roughness %g, metallic %g: reflected light against the path tracer's, relative",
                      double(roughness), double(metallic));
        expectAtMost(name, frame->depth.size(), std::abs(got / asked - 1.0), most);
    }
}

} // namespace
} // namespace sconce
