#pragma once

#include <cstring>
#include <map>
#include <optional>

#include "runtime/bake/bake.h"
#include "runtime/bake/bake_key.h"
#include "runtime/scene/scene_renderer.h"
#include "scene/triangle_rays.h"
#include "tests/support/device.h"

namespace sconce::testing_support
{

/// Draws frames of a scene with a light field that is baked for it.
class FrameTest : public DeviceTest
{
protected:
    static constexpr uint32_t kFewTexels = 26;

    static RenderSettings settingsOf(uint32_t side)
    {
        RenderSettings settings;
        settings.width = settings.height = side;
        return settings;
    }

    /// @param surfaceTexels  by default few, lit by few rays: most tests are about something else
    /// @param surfaceRays    none: few for few texels, else the bake's own
    static BakeSettings bakeOf(uint32_t resolution = 128, uint32_t bounces = 2, uint32_t surfaceTexels = kFewTexels,
                               std::optional<uint32_t> surfaceRays = {})
    {
        BakeSettings bake;
        bake.surfaceTexels = surfaceTexels;
        bake.surfaceRays = surfaceRays.value_or(surfaceTexels == kFewTexels ? 16 : bake.surfaceRays);
        bake.resolution = resolution;
        bake.bounces = bounces;
        return bake;
    }

    /// Lit through the field, as by a host that has no rays to triangles; with the settings of bakeOf().
    Result<FieldData> bakeField(const Scene& scene, std::span<const vec3> probes, uint32_t resolution = 128, uint32_t bounces = 2,
                                uint32_t surfaceTexels = kFewTexels, std::optional<uint32_t> surfaceRays = {})
    {
        return bakeOnce(scene, probes, bakeOf(resolution, bounces, surfaceTexels, surfaceRays));
    }

    /// Lit by rays to the scene's triangles, as `sconce bake` does by default.
    Result<FieldData> bakeByTriangles(const Scene& scene, std::span<const vec3> probes, BakeSettings bake)
    {
        const auto rays = TriangleRays::build(scene);
        if (!rays) return rays.error();
        bake.rays = &*rays;
        return bakeOnce(scene, probes, bake);
    }

    /// An image of a host's, rows of `width` pixels, in the layout in which shaders read it.
    GpuImage image(const std::vector<glm::vec4>& values, uint32_t width, const char* what)
    {
        ImageDesc desc;
        desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        desc.width = width;
        desc.height = uint32_t(values.size()) / width;
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        auto made = gpu().makeImage(desc, what);
        auto buffer = gpu().makeBufferWith<glm::vec4>(values, 0, what);
        EXPECT_TRUE(made && buffer);
        const auto status = gpu().submit(
            [&](VkCommandBuffer cmd)
            {
                constexpr VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
                constexpr VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
                constexpr VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
                transition(gpu(), cmd, *made, {VK_IMAGE_LAYOUT_UNDEFINED, target, all, all, any, any});
                VkBufferImageCopy copy{};
                copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
                copy.imageExtent = {desc.width, desc.height, 1};
                gpu().vk.CmdCopyBufferToImage(cmd, buffer->handle(), made->handle(), target, 1, &copy);
                transition(gpu(), cmd, *made, {target, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, all, all, any, any});
            });
        EXPECT_TRUE(status);
        return std::move(*made);
    }

    /// Of an image of two words a pixel, in the layout in which passes store.
    std::vector<uint32_t> wordsOf(const GpuImage& image, uint32_t width, uint32_t height)
    {
        std::vector<uint32_t> words(size_t(2) * width * height);
        auto buffer = gpu().makeBuffer(4 * words.size(), 0, MemoryUse::readback, "read back");
        EXPECT_TRUE(buffer);
        const Status status = gpu().submit(
            [&](VkCommandBuffer cmd)
            {
                transition(gpu(), cmd, image,
                           {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                            VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, VK_ACCESS_2_TRANSFER_READ_BIT});
                VkBufferImageCopy copy{};
                copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
                copy.imageExtent = {width, height, 1};
                gpu().vk.CmdCopyImageToBuffer(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer->handle(), 1, &copy);
                memoryBarrier(gpu(), cmd, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                              VK_ACCESS_2_HOST_READ_BIT);
            });
        EXPECT_TRUE(status);
        std::memcpy(words.data(), buffer->mapped(), 4 * words.size());
        return words;
    }

    /// @param drawn  what is in the picture; it may differ from what the field was baked from
    Result<RenderedFrame> drawWith(const FieldData& field, const Scene& drawn, const RenderSettings& settings)
    {
        auto device = DeviceScene::create(gpu(), drawn, field.info);
        if (!device) return device.error();
        auto light = makeLightField(gpu(), field);
        if (!light) return light.error();
        auto renderer = SceneRenderer::create(gpu(), *device, *light, settings);
        if (!renderer) return renderer.error();
        return (*renderer)->render(drawn.cameras.front());
    }

    /// Tests of one process that ask for the same field share it: a bake takes longer than what most of them do with it.
    Result<FieldData> bakeOnce(const Scene& scene, std::span<const vec3> probes, const BakeSettings& bake)
    {
        static std::map<uint64_t, FieldData> made;
        const uint64_t key = bakeKey(scene, probes, bake);
        if (const auto found = made.find(key); found != made.end()) return found->second;
        BakeReport report;
        auto field = bakeLightField(gpu(), scene, probes, bake, {}, report);
        if (field) made.emplace(key, *field);
        return field;
    }
};

} // namespace sconce::testing_support
