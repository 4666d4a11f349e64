// A host's G-buffer with numbers that are none, in some pixels of each image: they stay where they are.
#include <algorithm>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "runtime/frame/indirect_light.h"
#include "runtime/vulkan/nan_scan.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/properties/hard_cases/hard_case.h"
#include "tests/properties/hard_cases/hard_frames.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr uint32_t kSide = 48;    // pixels
constexpr float kNear = 1.0f;     // metres, of the depth
constexpr float kDistance = 1.9f; // metres to the wall that every pixel shows

class HostInputs : public FrameTest
{
protected:
    void SetUp() override
    {
        const char* was = std::getenv("SCONCE_NAN_SCAN");
        before = was ? was : "";
        setenv("SCONCE_NAN_SCAN", "1", 1); // a submit fails with the first bad number that a pass writes
    }
    void TearDown() override { setenv("SCONCE_NAN_SCAN", before.c_str(), 1); }

    std::string before;
};

TEST_F(HostInputs, NumbersThatAreNoneInTheGBufferSpreadToNoOtherPixel)
{
    const Scene scene = *makeBuiltinScene("cornell-glossy");
    BakeSettings bake;
    bake.resolution = 64;
    bake.bounces = 1;
    bake.scene = fewSamples();
    bake.surfaceTexels = 26;
    bake.surfaceRays = 16;
    BakeReport report;
    const auto field = bakeLightField(gpu(), scene, std::vector<vec3>{{0.0f, 1.5f, 0.5f}, {-0.7f, 0.5f, 0.6f}}, bake, {}, report);
    ASSERT_TRUE(field) << field.error().message;
    const auto light = makeLightField(gpu(), *field);
    ASSERT_TRUE(light) << light.error().message;

    // The back wall, seen from the middle of the open side; roughness from mirror to rough along x.
    std::vector<glm::vec4> depth(size_t(kSide) * kSide, glm::vec4(kNear / kDistance)), normal(depth.size(), glm::vec4(0, 0, 1, 0)),
        base(depth.size(), glm::vec4(0.7f, 0.7f, 0.7f, 0.0f));
    for (size_t i = 0; i < normal.size(); ++i) normal[i].w = float(i % kSide) / float(kSide - 1);
    constexpr float inf = std::numeric_limits<float>::infinity();
    const float odd[] = {NAN, inf, -inf, 3e38f, -3e38f};
    size_t planted = 0;
    for (uint32_t y = 3; y < kSide; y += 7)
        for (uint32_t x = 1; x < kSide; x += 5, ++planted)
        {
            std::vector<glm::vec4>* images[] = {&normal, &normal, &base, &depth};
            glm::vec4& pixel = (*images[planted % 4])[size_t(y) * kSide + x];
            pixel[int(planted / 4 % (planted % 4 == 3 ? 1 : 4))] = odd[planted % 5];
        }
    normal[0] = glm::vec4(0, 0, 0, 0.3f); // of no length
    const GpuImage depthImage = image(depth, kSide, "host's depth"), normalImage = image(normal, kSide, "host's normals"),
                   baseImage = image(base, kSide, "host's base colour");
    std::vector<glm::vec4> picture(depth.size(), glm::vec4(0.5f));
    for (size_t i = 0; i < picture.size(); i += 3) picture[i][int(i % 4)] = odd[i % 5];
    const GpuImage pictureImage = image(picture, kSide, "host's picture");

    IndirectLight::Desc desc;
    desc.width = desc.height = kSide;
    desc.effects.temporal = desc.effects.screenTrace = true;
    auto indirect = makeIndirectLight(gpu(), *light, desc);
    ASSERT_TRUE(indirect) << indirect.error().message;
    indirect->setInputs({.depth = depthImage.view(),
                         .normalRoughness = normalImage.view(),
                         .baseColorMetallic = baseImage.view(),
                         .pictureBefore = pictureImage.view()});
    gpu::FrameView view{};
    const vec3 eye(0.0f, 1.0f, 0.9f);
    view.worldFromClip = mat4(vec4(0.5f * kNear, 0, 0, 0), vec4(0, -0.5f * kNear, 0, 0), vec4(eye, 1), vec4(0, 0, -kNear, 0));
    view.clipFromWorldBefore = mat4(vec4(2, 0, 0, 0), vec4(0, -2, 0, 0), vec4(0, 0, 0, -1), vec4(0, 2, 0, 0.9f));
    view.eye = view.eyeBefore = eye;
    view.size = {kSide, kSide};
    view.glossyRays = 1;
    view.normalOffset = 1e-4f;
    view.raysBelow = gpu::kRaysBelow;
    std::string finding;
    for (uint32_t i = 0; i < 4; ++i)
    {
        view.seed = i;
        view.follows = i > 0;
        const auto status = gpu().submit([&](VkCommandBuffer cmd) { indirect->record(cmd, view); });
        if (!status && finding.empty()) finding = status.error().message;
    }
    EXPECT_EQ(finding, "");
    expectAtMost("NaN, infinite and huge numbers in a host's G-buffer: frames in which a pass writes one that is not finite", planted,
                 finding.empty() ? 0.0 : 1.0, 0.0);
}

// A view of another size than the passes were made for, or of no rays, is drawn at theirs: it must not lead them beyond their lists.
TEST_F(HostInputs, AViewOfAnotherSizeIsDrawnAtThatOfThePasses)
{
    const auto field = bakeField(*makeBuiltinScene("cornell-glossy"), std::vector<vec3>{{0.0f, 1.5f, 0.5f}});
    ASSERT_TRUE(field);
    auto light = makeLightField(gpu(), *field);
    ASSERT_TRUE(light);
    const size_t pixels = size_t(kSide) * kSide;
    const GpuImage depthImage = image(std::vector<glm::vec4>(pixels, glm::vec4(0.05f)), kSide, "host's depth"),
                   normalImage = image(std::vector<glm::vec4>(pixels, glm::vec4(0, 0, 1, 0.3f)), kSide, "host's normals"),
                   baseImage = image(std::vector<glm::vec4>(pixels, glm::vec4(0.5f)), kSide, "host's base colour");
    IndirectLight::Desc desc;
    desc.width = desc.height = kSide;
    std::vector<std::vector<uint32_t>> drawn;
    for (const auto& [size, rays] : {std::pair{glm::uvec2(kSide), 1u}, {glm::uvec2(3 * kSide, kSide / 2), 0u}})
    {
        auto indirect = makeIndirectLight(gpu(), *light, desc);
        ASSERT_TRUE(indirect) << indirect.error().message;
        indirect->setInputs({depthImage.view(), normalImage.view(), baseImage.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
        gpu::FrameView view = light->frameView(kSide, kSide);
        view.worldFromClip = mat4(vec4(0.5f, 0, 0, 0), vec4(0, -0.5f, 0, 0), vec4(0, 1, 0.9f, 1), vec4(0, 0, -1, 0));
        view.eye = vec3(0.0f, 1.0f, 0.9f);
        view.size = size;
        view.glossyRays = rays;
        view.fieldFromNormals = mat3(rays == 0 ? 0.0f : 1.0f);
        const auto status = gpu().submit([&](VkCommandBuffer cmd) { indirect->record(cmd, view); });
        ASSERT_TRUE(status) << status.error().message;
        drawn.push_back(wordsOf(indirect->state().diffuseImage, kSide, kSide));
    }
    EXPECT_EQ(drawn[0], drawn[1]);
    EXPECT_NE(*std::ranges::max_element(drawn[0]), 0u);
}

} // namespace
} // namespace sconce
