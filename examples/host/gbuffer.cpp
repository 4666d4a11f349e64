#include "gbuffer.h"

#include "draw_pipeline.h"
#include "gbuffer_frag.h"
#include "gbuffer_vert.h"

namespace
{

constexpr vk::ShaderStageFlags kStages = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

/// gbuffer_push.glsl, scalar layout.
struct Push
{
    glm::mat4 clipFromWorld;
    glm::vec4 baseColor;
    glm::vec3 emission;
    float metallic;
    glm::vec3 eye;
    float roughness;
    float normalScale;
    float alphaCutoff;
};
static_assert(sizeof(Push) == 120); // 128 is what every device has

} // namespace

GBuffer::GBuffer(const Vulkan& vulkan, const DrawnScene& drawn, vk::Extent2D size) : scene(drawn)
{
    using Usage = vk::ImageUsageFlagBits;
    constexpr vk::Format half = vk::Format::eR16G16B16A16Sfloat, full = vk::Format::eR32G32B32A32Sfloat;
    depth = vulkan.makeImage(vk::Format::eD32Sfloat, size, Usage::eDepthStencilAttachment | Usage::eSampled);
    normalRoughness = vulkan.makeImage(half, size, Usage::eColorAttachment | Usage::eSampled);
    baseColorMetallic = vulkan.makeImage(half, size, Usage::eColorAttachment | Usage::eSampled);
    emission = vulkan.makeImage(full, size, Usage::eColorAttachment | Usage::eSampled); // lamps may be beyond half floats

    const vk::PushConstantRange push{kStages, 0, sizeof(Push)};
    const vk::DescriptorSetLayout sets[] = {scene.materialLayout()};
    layout = vk::raii::PipelineLayout(
        vulkan.device, {.setLayoutCount = 1, .pSetLayouts = sets, .pushConstantRangeCount = 1, .pPushConstantRanges = &push});
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
    scene.bindVertices(cmd);
    Push push{};
    push.clipFromWorld = clipFromWorld(camera, convention, double(depth.size.width) / depth.size.height);
    push.eye = camera.eye;
    for (const Part& part : scene.model().parts)
    {
        const Material& material = scene.model().materials[part.material];
        push.baseColor = material.baseColor;
        push.emission = material.emission;
        push.metallic = material.metallic;
        push.roughness = material.roughness;
        push.normalScale = material.normalScale;
        push.alphaCutoff = material.alphaCutoff;
        cmd.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *layout, 0, scene.material(part.material), {});
        cmd.pushConstants<Push>(*layout, kStages, 0, push);
        cmd.drawIndexed(part.indices, 1, part.firstIndex, 0, 0);
    }
    cmd.endRendering();
    for (const Image* target : targets) transition(cmd, *target, color, read);
    transition(cmd, depth, tests, read);
}
