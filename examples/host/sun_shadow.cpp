#include "sun_shadow.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

#include "draw_pipeline.h"
#include "sun_shadow_vert.h"

namespace
{

constexpr uint32_t kTexels = 4096; // a side

} // namespace

SunShadow::SunShadow(const Vulkan& vulkan, const DrawnScene& drawn, const Sun& sun) : scene(drawn)
{
    using Usage = vk::ImageUsageFlagBits;
    depth = vulkan.makeImage(vk::Format::eD32Sfloat, {kTexels, kTexels}, Usage::eDepthStencilAttachment | Usage::eSampled);

    const glm::vec3 helper = std::abs(sun.along.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
    const glm::vec3 x = glm::normalize(glm::cross(helper, sun.along)), y = glm::cross(sun.along, x);
    const glm::vec3 axes[3] = {x, y, sun.along};
    const glm::vec3 middle = 0.5f * (scene.model().low + scene.model().high), half = 0.5f * (scene.model().high - scene.model().low);
    for (int i = 0; i < 3; ++i)
    {
        // A few texels more than the scene, for the filter at its border.
        const float reach = std::max(glm::dot(glm::abs(axes[i]), half) * (1.0f + 8.0f / kTexels), 1e-4f);
        for (int k = 0; k < 3; ++k) place[k][i] = 0.5f * axes[i][k] / reach;
        place[3][i] = 0.5f - 0.5f * glm::dot(axes[i], middle) / reach;
        if (i < 2) width = std::max(width, 2.0f * reach / float(kTexels));
    }

    const vk::PushConstantRange push{vk::ShaderStageFlagBits::eVertex, 0, sizeof(glm::mat4)};
    layout = vk::raii::PipelineLayout(vulkan.device, {.pushConstantRangeCount = 1, .pPushConstantRanges = &push});
    pipeline = makeDrawPipeline(
        vulkan, {.vertex = sun_shadow_vert, .nearer = vk::CompareOp::eLessOrEqual, .input = DrawnScene::vertexInput(1), .layout = *layout});
}

void SunShadow::record(vk::CommandBuffer cmd) const
{
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    constexpr Use before{vk::ImageLayout::eUndefined, Stage::eComputeShader, Access::eNone};
    constexpr Use tests{vk::ImageLayout::eDepthAttachmentOptimal, Stage::eEarlyFragmentTests | Stage::eLateFragmentTests,
                        Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite};
    constexpr Use read{vk::ImageLayout::eShaderReadOnlyOptimal, Stage::eComputeShader, Access::eShaderSampledRead};
    transition(cmd, depth, before, tests);
    beginDrawing(cmd, {}, depth, 1.0f);
    cmd.bindPipeline(vk::PipelineBindPoint::eGraphics, *pipeline);
    scene.bindVertices(cmd);
    glm::mat4 clipFromWorld = glm::translate(glm::mat4(1.0f), glm::vec3(-1.0f, -1.0f, 0.0f));
    clipFromWorld = glm::scale(clipFromWorld, glm::vec3(2.0f, 2.0f, 1.0f)) * place;
    cmd.pushConstants<glm::mat4>(*layout, vk::ShaderStageFlagBits::eVertex, 0, clipFromWorld);
    cmd.drawIndexed(uint32_t(scene.model().indices.size()), 1, 0, 0, 0);
    cmd.endRendering();
    transition(cmd, depth, tests, read);
}
