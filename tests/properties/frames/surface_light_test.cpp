// Diffuse light read at surfaces: how still it is under a camera that moves, and what a look-up reads.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "runtime/field/tracer_cpu.h"
#include "scene/builtin_scenes.h"
#include "shaders/shared/brdf.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 72; // pixels

/// Diffuse light read at surfaces, of pixels and of the means of 4 x 4 finer ones.
class SurfaceLightFrames : public FrameTest
{
protected:
    static constexpr uint32_t kFiner = 4;

    void SetUp() override
    {
        scene = *makeBuiltinScene("cornell-glossy");
        const std::vector<vec3> probes = {{0.0f, 1.5f, 0.5f}, {-0.8f, 0.5f, 0.6f}, {0.8f, 0.5f, -0.4f}, {-0.75f, 1.0f, -0.8f}};
        BakeSettings bake = bakeOf(128, 4, 52);
        bake.lampTexels = 0; // a lamp's light is not looked up
        auto made = bakeByTriangles(scene, probes, bake);
        ASSERT_TRUE(made) << made.error().message;
        baked = std::move(*made);
        settings = settingsOf(kSide);
        settings.effects.temporal = settings.effects.glossy = settings.effects.mirror = settings.effects.rough = false;
    }

    static constexpr float kSameColour = 0.002f; // which cards don't draw to the bit alike all over a surface
    /// The mean of a pixel's finer ones; none where they see more than one surface.
    static std::optional<vec3> meanOfFiner(const RenderedFrame& fine, uint32_t x, uint32_t y)
    {
        vec3 sum(0.0f);
        const size_t first = size_t(y) * kFiner * fine.width + size_t(x) * kFiner;
        for (uint32_t i = 0; i < kFiner * kFiner; ++i)
        {
            const size_t at = first + size_t(i / kFiner) * fine.width + i % kFiner;
            if (glm::dot(fine.normal[at], fine.normal[first]) < 0.9999f || glm::distance(fine.albedo[at], fine.albedo[first]) > kSameColour)
                return std::nullopt;
            sum += fine.diffuseIndirect[at] / float(kFiner * kFiner);
        }
        return sum;
    }

    Scene scene;
    FieldData baked;
    RenderSettings settings;
};

// As the camera turns slowly, what is left of dithered look-ups must not crawl: no filter over time hides it.
TEST_F(SurfaceLightFrames, ATurningCameraShowsTheChangeOfTheSceneAlone)
{
    const auto device = DeviceScene::create(gpu(), scene, baked.info);
    const auto field = makeLightField(gpu(), baked);
    ASSERT_TRUE(device && field);
    RenderSettings finer = settings;
    finer.width = finer.height = kFiner * kSide;
    const auto drawn = SceneRenderer::create(gpu(), *device, *field, settings), fine = SceneRenderer::create(gpu(), *device, *field, finer);
    ASSERT_TRUE(drawn && fine);
    double flicker = 0.0, own = 0.0;
    size_t compared = 0;
    std::optional<RenderedFrame> before, fineBefore;
    for (uint32_t i = 0; i < 12; ++i)
    {
        Camera camera = scene.cameras.front();
        const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
        camera.forward = glm::normalize(camera.forward + 0.2f * std::tan(0.5f * camera.verticalFov) / float(kSide) * float(i) * right);
        auto now = (*drawn)->render(camera, i), fineNow = (*fine)->render(camera, i);
        ASSERT_TRUE(now && fineNow);
        for (uint32_t p = 0; before && p < kSide * kSide; ++p)
        {
            const auto mean = meanOfFiner(*fineNow, p % kSide, p / kSide), meanBefore = meanOfFiner(*fineBefore, p % kSide, p / kSide);
            if (!mean || !meanBefore) continue;
            const vec3 change = glm::abs(now->diffuseIndirect[p] - before->diffuseIndirect[p]), truth = glm::abs(*mean - *meanBefore);
            flicker += change.x + change.y + change.z;
            own += truth.x + truth.y + truth.z;
            ++compared;
        }
        before = std::move(*now);
        fineBefore = std::move(*fineNow);
    }
    ASSERT_GT(compared, 11u * kSide * kSide / 2u);
    // SHORT: refined texels are finer than these few pixels, which see them at their centres; without them it is below 1.
    expectAtMost(
        "diffuse light at surfaces, camera turning by a tenth of a pixel a frame: change from frame to frame, times that of finer pixels",
        compared, flicker / own, 1.2, 1.05);
}

// Where one probe lights a look-up instead of two, light stays; seams and what one probe sees coarsely are what it differs by.
TEST_F(SurfaceLightFrames, OneProbeInsteadOfTwoGivesNearlyTheSameLight)
{
    const auto two = drawWith(baked, scene, settings);
    settings.surfaceProbes = 1;
    const auto one = drawWith(baked, scene, settings);
    ASSERT_TRUE(two && one);
    double squares = 0.0, before = 0.0, after = 0.0;
    for (size_t i = 0; i < two->diffuseIndirect.size(); ++i)
    {
        const vec3 a = one->diffuseIndirect[i], b = two->diffuseIndirect[i];
        squares += double(glm::dot(a - b, a - b)), before += double(glm::dot(b, b));
        after += double(glm::dot(a, a));
    }
    EXPECT_GT(one->diffuseFrom[4], 0u) << "pixels of one probe";
    EXPECT_EQ(one->diffuseFrom[5], 0u) << "pixels of two";
    EXPECT_GT(two->diffuseFrom[5], two->diffuseFrom[4]);
    expectAtMost("surface light of one probe instead of two: change, root mean square, relative", two->diffuseIndirect.size(),
                 std::sqrt(squares / before), 0.1);
    EXPECT_NEAR(std::sqrt(after / before), 1.0, 0.02);
}

// What a look-up costs; one serves up to four pixels.
TEST_F(SurfaceLightFrames, APixelIsLitByFewReads)
{
    const auto frame = drawWith(baked, scene, settings);
    ASSERT_TRUE(frame) << frame.error().message;
    twin::LightFieldTwin<float, true> text(baked, {});
    const Camera& camera = scene.cameras.front();
    const vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const float tangent = std::tan(0.5f * camera.verticalFov);
    size_t pixels = 0, alike = 0;
    for (uint32_t i = 0; i < kSide * kSide; ++i)
    {
        if (!(frame->depth[i] > 0.0f) || frame->diffuseIndirect[i] == vec3(0.0f)) continue;
        const vec2 at = (vec2(i % kSide, i / kSide) + 0.5f) / float(kSide) * 2.0f - 1.0f;
        const vec3 world = camera.eye + frame->depth[i] * (camera.forward + tangent * (at.x * right - at.y * camera.up));
        const vec3 point = (world - baked.info.origin) / baked.info.scale, normal = frame->normal[i];
        int reads = 0;
        const auto found = text.surfaceLightAt(point, normal, normal, point + 0.5f * baked.info.voxel * normal, reads);
        ++pixels;
        const BrdfSurface surface{frame->albedo[i], 0.0f, frame->roughness[i]}; // metals have no diffuse light
        const vec3 drawn = lobesAt(surface, glm::dot(normal, glm::normalize(camera.eye - world))).diffuse * found.light;
        alike += glm::length(drawn - frame->diffuseIndirect[i]) < 0.05f * glm::length(frame->diffuseIndirect[i]);
    }
    ASSERT_GT(pixels, kSide * kSide / 3u);
    EXPECT_GT(alike, pixels * 9u / 10u) << "these are not the frame's look-ups";
    const auto each = [&](const char* what, size_t reads, double bound)
    { expectAtMost(std::string("surface light, reads a look-up: ") + what, pixels, double(reads) / double(pixels), bound); };
    each("octree", text.read.octree, 2.0);
    each("probe headers", text.read.headers, 7.0);
    each("distance words", text.read.distance, 11.0);
    each("words of light", text.read.surface, 10.5); // found: 10.24; a refined texel has five words
}

} // namespace
} // namespace sconce
