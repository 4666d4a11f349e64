// The scan for NaN and infinity that the debug preset's tests run with: what is planted is named, and what is clean is not.
#include <array>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "runtime/sconce.h"
#include "runtime/vulkan/nan_scan.h"
#include "scene/builtin_scenes.h"
#include "tests/properties/frames/frame_test.h"
#include "tests/support/environment.h"

namespace sconce
{
namespace
{

using namespace testing_support;

constexpr const char* kVariable = "SCONCE_NAN_SCAN";

/// What a submit says that scans words.
std::string sentenceOf(Gpu& gpu, std::span<const uint32_t> words, NanScan::Words how)
{
    auto buffer = gpu.makeBufferWith(words, 0, "planted words");
    EXPECT_TRUE(buffer);
    how.count = how.count > 0 ? how.count : words.size() - how.first;
    const auto status = gpu.submit([&](VkCommandBuffer cmd) { scanBuffer(gpu, cmd, "planting", *buffer, how); });
    return status ? std::string() : status.error().message;
}

/// On a device of its own, which scans.
class NanScanTest : public FrameTest
{
protected:
    static void SetUpTestSuite()
    {
        const Variable scans(kVariable, "1");
        scanning = std::make_unique<ValidatedDevice>();
        scanning->gpu();
    }
    static void TearDownTestSuite() { scanning.reset(); }
    Gpu& gpu() override { return scanning->gpu(); }
    std::string sentenceOf(std::span<const uint32_t> words, NanScan::Words how) { return sconce::sentenceOf(gpu(), words, how); }

    static inline std::unique_ptr<ValidatedDevice> scanning;
};

constexpr uint32_t kNan = 0x7fc00000u, kInfinity = 0x7f800000u, kOne = 0x3f800000u, kLargest = 0x7f7fffffu;

TEST_F(NanScanTest, NamesPassBufferAndTheFirstBadWord)
{
    std::vector<uint32_t> words(100000, kOne);
    EXPECT_EQ(sentenceOf(words, {}), "");
    words[99998] = kInfinity | 0x80000000u;
    EXPECT_NE(sentenceOf(words, {}).find("word 99998"), std::string::npos);
    words[137] = kNan;
    const std::string sentence = sentenceOf(words, {});
    for (const char* part : {"'planting'", "'planted words'", "word 137"}) EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    EXPECT_NE(sentenceOf(words, {.first = 138}).find("word 99998"), std::string::npos) << "places count from the buffer's start";
    EXPECT_EQ(sentenceOf(words, {.first = 138, .count = 500}), "");
    EXPECT_EQ(sentenceOf(words, {.stride = 2, .mask = 0}), "") << "integers are left alone";
    EXPECT_EQ(sentenceOf(std::vector<uint32_t>(8, kOne), {}), "") << "a finding doesn't stay for the next submit";
}

// A host submits what the library recorded, and asks once it is done.
TEST_F(NanScanTest, WhatAHostSubmitsIsToldWhenItAsks)
{
    const Variable scans(kVariable, "1");
    const auto device = Device::create(scanning->host());
    ASSERT_TRUE(device) << device.error().message;
    Gpu& own = device->gpu();
    const uint32_t words[] = {kOne, kOne, kNan};
    auto buffer = own.makeBufferWith<uint32_t>(words, 0, "planted words");
    ASSERT_TRUE(buffer);
    EXPECT_TRUE(device->nanFindings()) << "nothing has run";
    Handle<VkCommandPool, &VulkanFunctions::DestroyCommandPool> pool;
    VkCommandPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    poolInfo.queueFamilyIndex = own.host.queueFamily;
    ASSERT_EQ(pool.make(own, own.vk.CreateCommandPool, own.host.device, &poolInfo, own.host.allocationCallbacks), VK_SUCCESS);
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool.get();
    allocate.commandBufferCount = 1;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    ASSERT_EQ(own.vk.AllocateCommandBuffers(own.host.device, &allocate, &cmd), VK_SUCCESS);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    ASSERT_EQ(own.vk.BeginCommandBuffer(cmd, &begin), VK_SUCCESS);
    NanScan::Words how;
    how.count = 3;
    scanBuffer(own, cmd, "planting", *buffer, how);
    ASSERT_EQ(own.vk.EndCommandBuffer(cmd), VK_SUCCESS);
    Handle<VkFence, &VulkanFunctions::DestroyFence> fence;
    VkFenceCreateInfo fenceInfo{};
    fenceInfo.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    ASSERT_EQ(fence.make(own, own.vk.CreateFence, own.host.device, &fenceInfo, own.host.allocationCallbacks), VK_SUCCESS);
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &cmd;
    const VkFence done = fence.get();
    ASSERT_EQ(own.vk.QueueSubmit(own.host.queue, 1, &info, done), VK_SUCCESS);
    ASSERT_EQ(own.vk.WaitForFences(own.host.device, 1, &done, VK_TRUE, UINT64_MAX), VK_SUCCESS);
    const Status found = device->nanFindings();
    ASSERT_FALSE(found);
    for (const char* part : {"'planting'", "'planted words'", "word 2"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << found.error().message;
    EXPECT_TRUE(device->nanFindings()) << "told once";
}

TEST_F(NanScanTest, KnowsEveryFormat)
{
    const auto small = [](uint32_t r, uint32_t g, uint32_t b) { return r | (g << 11) | (b << 22); };
    const uint32_t nanHalf = 0x7e00u, infinityHalf = 0x7c00u, largestHalf = 0x7bffu;
    const struct
    {
        uint32_t kind;
        std::vector<uint32_t> good, bad;
    } formats[] = {
        {gpu::kScanFloats, {0, kOne, kLargest, 0x80000000u, 1}, {kNan, kInfinity, kInfinity | 0x80000000u, 0xffffffffu, 0x7f800001u}},
        {gpu::kScanHalves, {0, largestHalf | largestHalf << 16, 0x80000001u}, {nanHalf, infinityHalf << 16, 0xfc00u}},
        {gpu::kScanRadiance,
         {0, small(30 << 6 | 63, 30 << 6 | 63, 30 << 5 | 31)},
         {small(31 << 6, 0, 0), small(0, 31 << 6 | 1, 0), small(0, 0, 31 << 5)}},
        {gpu::kScanNearness, {0, largestHalf | 0xffff0000u}, {infinityHalf, nanHalf | 0x10000u}},
        {gpu::kScanDistance, {0, infinityHalf, largestHalf | 0xffff0000u}, {nanHalf, 0x7c01u}},
    };
    for (const auto& format : formats)
    {
        EXPECT_EQ(sentenceOf(format.good, {.kind = format.kind}), "") << format.kind;
        for (uint32_t word : format.bad) EXPECT_NE(sentenceOf(std::array{word}, {.kind = format.kind}), "") << format.kind << ": " << word;
    }
    EXPECT_EQ(sentenceOf(std::array{0u, largestHalf}, {.kind = gpu::kScanIrradiance}), "");
    EXPECT_NE(sentenceOf(std::array{small(31 << 6, 0, 0), 0u}, {.kind = gpu::kScanIrradiance}), "");
    EXPECT_NE(sentenceOf(std::array{0u, nanHalf}, {.kind = gpu::kScanIrradiance}), "");
}

TEST_F(NanScanTest, NamesThePixelOfAnImageLargerThanItsScratch)
{
    constexpr uint32_t kWidth = 1024, kHeight = 300, kX = 1000, kY = 290;
    auto image = makeLightImage(gpu(), VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, "planted picture");
    ASSERT_TRUE(image);
    const auto scan = [&](VkCommandBuffer cmd) { scanImage(gpu(), cmd, "painting", *image); };
    EXPECT_TRUE(gpu().submit(scan)) << "a new image is 0";
    const uint32_t pixel[] = {kOne, kOne, kNan, kOne};
    auto buffer = gpu().makeBufferWith<uint32_t>(pixel, 0, "pixel");
    ASSERT_TRUE(buffer);
    const auto status = gpu().submit(
        [&](VkCommandBuffer cmd)
        {
            VkBufferImageCopy copy{};
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            copy.imageOffset = {int32_t(kX), int32_t(kY), 0};
            copy.imageExtent = {1, 1, 1};
            constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            constexpr VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            constexpr VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL, target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            transition(gpu(), cmd, *image, {general, target, all, all, any, any});
            gpu().vk.CmdCopyBufferToImage(cmd, buffer->handle(), image->handle(), target, 1, &copy);
            transition(gpu(), cmd, *image, {target, general, all, all, any, any});
            scan(cmd);
        });
    ASSERT_FALSE(status);
    for (const char* part : {"'painting'", "'planted picture'", "pixel (1000, 290)", "word 2"})
        EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
}

TEST_F(NanScanTest, ABakeAndItsFramesAreCleanAndANaNInTheFieldIsNamedWhereItComesOut)
{
    const Scene scene = *makeBuiltinScene("cornell-glossy");
    for (const uint32_t chart : {gpu::kChartCube, gpu::kChartOctahedral})
    {
        BakeSettings bake;
        bake.resolution = 64;
        bake.chart = chart;
        bake.bounces = 1;
        bake.surfaceTexels = 26;
        bake.surfaceRays = 16;
        BakeReport report;
        auto field = bakeLightField(gpu(), scene, std::vector<vec3>{{0.0f, 1.5f, 0.5f}, {-0.7f, 0.5f, 0.6f}}, bake, {}, report);
        ASSERT_TRUE(field) << field.error().message;
        if (chart == gpu::kChartOctahedral) continue;
        RenderSettings settings = settingsOf(48);
        settings.effects.temporal = true;
        settings.effects.surfaceLight = false; // what is planted is in the irradiance
        const auto clean = drawWith(*field, scene, settings);
        EXPECT_TRUE(clean) << clean.error().message;
        for (size_t i = 0; i < field->irradiance.size(); i += 2) field->irradiance[i] = 0xffffffffu;
        const auto planted = drawWith(*field, scene, settings);
        if (planted && gpu().properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU)
        {
            // A GPU's max() takes the number where the other is none, so that nothing comes out.
            for (const glm::vec3& light : planted->diffuseIndirect) EXPECT_TRUE(std::isfinite(light.x + light.y + light.z));
            continue;
        }
        ASSERT_FALSE(planted);
        for (const char* part : {"'gather light'", "'diffuse light'", "pixel ("})
            EXPECT_NE(planted.error().message.find(part), std::string::npos) << planted.error().message;
    }
}

/// Whatever is made on the device while both charts are baked, frames with every effect drawn and rays asked, and not scanned, has a reason
/// here; a reason that no longer has its buffer is a mistake, too.
TEST_F(NanScanTest, LooksAtEverythingThatAPassWrites)
{
    const std::map<std::string_view, const char*> reasons = {
        {"The staging buffer", "a copy"},
        {"A texture's staging buffer", "a copy"},
        {"The bake's transfer buffer", "a copy of the probe's buffers"},
        {"picture read back", "a copy of an image"},
        {"octree staging", "integers, from the host"},
        {"The scene's vertices", "from the host, which refuses scenes with numbers that are none"},
        {"The scene's indices", "integers, from the host"},
        {"The scene's materials", "from the host, as the vertices"},
        {"The list of lights", "from the host, as the vertices"},
        {"frame view", "from the host, which refuses such cameras"},
        {"light field block", "from the host, checked"},
        {"probe distances", "baked, or from a file that was checked"},
        {"probe radiance", "as distances"},
        {"probe irradiance", "as distances"},
        {"prefiltered radiance", "as distances, made on the host"},
        {"probe patches", "as distances, made on the host"},
        {"surface light", "as distances"},
        {"A probe's surface texels", "words whose packing knows no NaN"},
        {"surface texels", "as those of a probe"},
        {"links of a probe's surfaces", "integers"},
        {"light that surfaces send", "as surface texels; the light that they are made of is scanned"},
        {"filtered light at surfaces", "as light that surfaces send"},
        {"filtered tilts of light at surfaces", "words of 8 bits a number"},
        {"light by specular reflection at surfaces", "as light that surfaces send"},
        {"tints of metals", "from the host: clamped colours over their luminance"},
        {"probe headers", "as distances"},
        {"rays", "from the host: the tracer answers any number"},
        {"tile lists", "integers"},
        {"The octree's maps", "the baked maps, from the host"},
        {"The octree's probes", "from the host"},
        {"The octree's candidates", "integers"},
        {"The octree's settings", "from the host"},
        {"The octree's surface samples", "integers"},
        {"The octree's blocks with surfaces", "integers"},
        {"The octree's blocks", "integers"},
        {"What the octree's blocks may ask", "integers"},
        {"The octree's lists", "integers"},
    };
    Scene scene = *makeBuiltinScene("cornell-glossy");
    scene.images.push_back({"even", 1, 1, {128, 128, 255, 255}});
    scene.materials.front().normalTexture.image = int(scene.images.size()) - 1;
    for (const LightType type : {LightType::directional, LightType::point})
    {
        Light light;
        light.type = type;
        light.position = vec3(0.0f, 1.2f, 0.0f);
        light.intensity = vec3(1.0f);
        scene.lights.push_back(light);
    }
    NanScan::takeCoverage();
    for (const uint32_t chart : {gpu::kChartOctahedral, gpu::kChartCube})
    {
        BakeSettings bake;
        bake.resolution = 64;
        bake.chart = chart;
        bake.bounces = 1;
        bake.surfaceTexels = 26;
        bake.surfaceRays = 16;
        bake.scene.light.sunShadow = 256;
        bake.scene.light.emitterSamples = 8;
        BakeReport report;
        auto field = bakeLightField(gpu(), scene, std::vector<vec3>{{0.0f, 1.5f, 0.5f}}, bake, {}, report);
        ASSERT_TRUE(field) << field.error().message;
        if (chart == gpu::kChartOctahedral) continue;
        RenderSettings settings = settingsOf(32);
        settings.layers = true;
        settings.traceEvery = 2;
        settings.effects = {.diffuse = true, .rough = true, .glossy = true, .mirror = true};
        settings.effects.temporal = true;
        const auto drawn = drawWith(*field, scene, settings);
        ASSERT_TRUE(drawn) << drawn.error().message;
        auto light = makeLightField(gpu(), *field);
        ASSERT_TRUE(light);
        auto tracer = makeRayTracer(gpu(), *light);
        ASSERT_TRUE(tracer);
        const std::vector<gpu::Ray> rays(1, {vec3(0.0f, 1.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f), vec3(0.0f)});
        std::vector<gpu::RayHit> hits(rays.size());
        ASSERT_TRUE(tracer->trace(rays, hits));
    }
    const NanScan::Coverage names = NanScan::takeCoverage();
    for (const std::string_view name : names.made)
        EXPECT_TRUE(names.scanned.contains(name) || reasons.contains(name)) << "'" << name << "' is not scanned";
    for (const auto& [name, reason] : reasons) EXPECT_TRUE(names.made.contains(name)) << "nothing is called '" << name << "': " << reason;
    for (const std::string_view name : {"The suns' shadow maps", "The point lights' shadow maps", "The emitters' shadow maps"})
        EXPECT_TRUE(names.scanned.contains(name)) << name;
}

TEST(NanScanOff, WithoutTheVariableNothingIsScanned)
{
    const Variable off(kVariable, "0");
    ValidatedDevice own;
    EXPECT_EQ(own.gpu().nanScan(), nullptr);
    EXPECT_EQ(sentenceOf(own.gpu(), std::array{kNan}, {}), "");
}

} // namespace
} // namespace sconce
