#include "gbuffer.h"

#include <glm/gtc/matrix_transform.hpp>

#include "draw_pipeline.h"
#include "gbuffer_frag.h"
#include "gbuffer_vert.h"

GBuffer::GBuffer(const Vulkan& vulkan, const DrawnScene& drawn, vk::Extent2D size) : scene(drawn)
{
    using Usage = vk::ImageUsageFlagBits;
    constexpr vk::Format half = vk::Format::eR16G16B16A16Sfloat, full = vk::Format::eR32G32B32A32Sfloat;
    depth = vulkan.makeImage(vk::Format::eD32Sfloat, size, Usage::eDepthStencilAttachment | Usage::eSampled);
    normalRoughness = vulkan.makeImage(half, size, Usage::eColorAttachment | Usage::eSampled);
    baseColorMetallic = vulkan.makeImage(half, size, Usage::eColorAttachment | Usage::eSampled);
    emission = vulkan.makeImage(full, size, Usage::eColorAttachment | Usage::eSampled); // lamps may be beyond half floats

    layout = scene.drawLayout();
    const vk::Format formats[] = {half, half, full};
    pipeline = makeDrawPipeline(
        vulkan,
        {.vertex = gbuffer_vert, .fragment = gbuffer_frag, .colors = formats, .input = DrawnScene::vertexInput(), .layout = *layout});
}

void GBuffer::record(vk::CommandBuffer cmd, const Camera& camera, Convention convention) const
{
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    constexpr Use color{vk::ImageLayout::eColorAttachmentOptimal, Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite};
    constexpr Use tests{vk::ImageLayout::eDepthAttachmentOptimal, Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                        Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite};
    constexpr Use read{vk::ImageLayout::eShaderReadOnlyOptimal, Stage::eComputeShader, Access::eShaderSampledRead};
    constexpr Use before{vk::ImageLayout::eUndefined, Stage::eComputeShader, Access::eNone}; // the last frame's reads come first
    const Image* const targets[] = {&normalRoughness, &baseColorMetallic, &emission};
    for (const Image* target : targets) transition(cmd, *target, before, color);
    transition(cmd, depth, before, tests);

    beginDrawing(cmd, targets, depth, 0.0f);
    cmd.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
    // From the eye, as shaders take it: far from the origin no bits are lost.
    const glm::dmat4 clip = clipFromWorld(camera, convention, double(depth.size.width) / depth.size.height);
    scene.draw(cmd, *layout, clip * glm::translate(glm::dmat4(1.0), glm::dvec3(camera.eye)), camera.eye);
    cmd.endRendering();
    for (const Image* target : targets) transition(cmd, *target, color, read);
    transition(cmd, depth, tests, read);
}
