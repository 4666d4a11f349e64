// A convex room with a lamp in it, baked as `sconce bake` does by default: the light it has, and what a pane in it lets through.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bench/reference/reference.h"
#include "scene/mesh_builder.h"
#include "tests/properties/frames/frame_test.h"

namespace sconce
{
namespace
{

constexpr uint32_t kWidth = 64, kHeight = 48; // pixels
const vec3 kEye(0.0f, 1.5f, 1.8f);            // looks along -z
const std::vector<vec3> kProbes = {{0.0f, 1.5f, 1.2f}, {-1.2f, 1.0f, 0.3f}, {1.2f, 2.0f, 0.0f}, {0.3f, 1.2f, -1.3f}, {-0.8f, 2.2f, -1.0f}};

Scene closedRoom()
{
    Scene scene;
    scene.name = "closed room";
    MeshBuilder mesh(scene);
    mesh.box({-2.0f, 0.0f, -2.0f}, {2.0f, 3.0f, 2.0f}, mesh.material("white", vec3(0.6f)));
    mesh.quad({-0.4f, 2.5f, 0.2f}, {0.4f, 2.5f, 0.2f}, {0.4f, 2.5f, 1.0f}, {-0.4f, 2.5f, 1.0f}, mesh.emitter("lamp", vec3(6.0f)));
    mesh.camera("view", kEye, {0.0f, 1.5f, -2.0f}, 50.0f);
    return scene;
}

class ClosedRoom : public testing_support::FrameTest
{
protected:
    void draw(const Scene& scene)
    {
        BakeSettings bake;
        bake.resolution = 256; // half of the default's: no surface is near
        const auto field = bakeByTriangles(scene, kProbes, bake);
        ASSERT_TRUE(field) << field.error().message;
        RenderSettings settings;
        settings.width = kWidth;
        settings.height = kHeight;
        auto drawn = drawWith(*field, scene, settings);
        ASSERT_TRUE(drawn) << drawn.error().message;
        frame = std::move(*drawn);
        ReferenceSettings reference;
        reference.width = kWidth;
        reference.height = kHeight;
        reference.samples = 64;
        reference.bounces = bake.bounces;
        reference.pixelCentre = true;
        reference.guides = false;
        reference.camera = scene.cameras.front();
        auto traced = renderReference(scene, reference);
        ASSERT_TRUE(traced) << traced.error().message;
        truth = std::move(traced->images);
    }

    RenderedFrame frame;
    ImageSet truth;
};

// Nothing hides anything there: what is missing is missing everywhere.
TEST_F(ClosedRoom, HasAllOfTheReferencesDiffuseLight)
{
    ASSERT_NO_FATAL_FAILURE(draw(closedRoom()));
    const std::vector<float>& asked = truth.find("diffuse_indirect")->pixels;
    double ours = 0.0, theirs = 0.0;
    for (size_t i = 0; i < frame.diffuseIndirect.size(); ++i)
        for (int c = 0; c < 3; ++c) ours += double(frame.diffuseIndirect[i][c]), theirs += double(asked[3 * i + size_t(c)]);
    RecordProperty("share", std::to_string(ours / theirs));
    EXPECT_GE(ours / theirs, 0.99);
    EXPECT_LE(ours / theirs, 1.02);
}

// Each pixel draws a lot whether it shows the pane or what is behind it, and so does every ray and texel that meets it.
TEST_F(ClosedRoom, APaneShowsAsMuchOfWhatIsBehindItAsInTheReference)
{
    constexpr float kAlpha = 0.3f, kHalf = 1.0f, kAway = 2.3f; // of the pane: half of its side and its distance from the eye, metres
    Scene scene = closedRoom();
    MeshBuilder mesh(scene);
    const uint32_t pane = mesh.material("pane", vec3(0.1f, 0.2f, 0.3f));
    scene.materials[pane].baseColor.a = kAlpha;
    scene.materials[pane].blended = true;
    const auto corner = [&](float x, float y) { return kEye + vec3(kHalf * x, kHalf * y, -kAway); };
    mesh.quad(corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1), pane);
    ASSERT_NO_FATAL_FAILURE(draw(scene));

    const float tangent = std::tan(0.5f * scene.cameras.front().verticalFov);
    const std::vector<float>& asked = truth.find("beauty")->pixels;
    double ours = 0.0, theirs = 0.0;
    size_t pixels = 0, glass = 0;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    {
        const vec2 at = (vec2(i % kWidth, i / kWidth) + 0.5f) / vec2(kWidth, kHeight) * 2.0f - 1.0f;
        const vec2 across = kAway * tangent * vec2(at.x * float(kWidth) / float(kHeight), at.y);
        if (std::max(std::abs(across.x), std::abs(across.y)) > 0.95f * kHalf) continue;
        ++pixels;
        glass += frame.depth[i] < 1.1f * kAway;
        for (int c = 0; c < 3; ++c) ours += double(frame.beauty[i][c]), theirs += double(asked[3 * size_t(i) + size_t(c)]);
    }
    ASSERT_GT(pixels, kWidth * kHeight / 3);
    RecordProperty("share, mean", std::to_string(double(glass) / double(pixels)) + " " + std::to_string(ours / theirs));
    EXPECT_NEAR(double(glass) / double(pixels), double(kAlpha), 0.035) << "three deviations of as many lots";
    EXPECT_NEAR(ours / theirs, 1.0, 0.03);
}

} // namespace
} // namespace sconce
