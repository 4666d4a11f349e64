#include "lighting.h"

#include <algorithm>

#include "lighting_comp.h"

namespace
{

/// lighting.comp, scalar layout.
struct Block
{
    glm::mat4 worldFromClip;
    glm::mat4 mapFromWorld;
    glm::vec3 eye;
    float shadowTexel;
    glm::vec3 toSun;
    uint32_t made;
    float raysBelow;
    glm::vec3 sunIrradiance;
    glm::vec3 sky;
};

constexpr uint32_t kShadowBinding = 5, kIndirectBinding = 6, kPictureBinding = 10;

std::vector<vk::DescriptorType> bindings()
{
    using Kind = vk::DescriptorType;
    std::vector<Kind> kinds = {Kind::eUniformBuffer, Kind::eSampledImage, Kind::eSampledImage,
                               Kind::eSampledImage,  Kind::eSampledImage, Kind::eCombinedImageSampler};
    kinds.insert(kinds.end(), 4, Kind::eSampledImage);
    kinds.insert(kinds.end(), 4, Kind::eStorageImage);
    return kinds;
}

} // namespace

Lighting::Lighting(const Vulkan& vulkan, vk::Extent2D size) : gpu(vulkan)
{
    using Usage = vk::ImageUsageFlagBits;
    for (Image& picture : pictures) picture = gpu.makeImage(vk::Format::eR32G32B32A32Sfloat, size, Usage::eStorage | Usage::eTransferSrc);
    empty = gpu.makeImage(vk::Format::eR32G32B32A32Sfloat, {1, 1}, Usage::eSampled);
    gpu.run(
        [&](vk::CommandBuffer cmd)
        {
            using Stage = vk::PipelineStageFlagBits2;
            constexpr Use read{vk::ImageLayout::eGeneral, Stage::eComputeShader, vk::AccessFlagBits2::eShaderSampledRead};
            transition(cmd, empty, {vk::ImageLayout::eUndefined, Stage::eNone, {}}, read);
        });
    block = gpu.makeBuffer(sizeof(Block), vk::BufferUsageFlagBits::eUniformBuffer | vk::BufferUsageFlagBits::eTransferDst, false);
    comparing = vk::raii::Sampler(gpu.device, {.magFilter = vk::Filter::eLinear,
                                               .minFilter = vk::Filter::eLinear,
                                               .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                               .addressModeV = vk::SamplerAddressMode::eClampToEdge,
                                               .compareEnable = true,
                                               .compareOp = vk::CompareOp::eLessOrEqual});
    set = makeSets(gpu, bindings(), vk::ShaderStageFlagBits::eCompute, 1);
    layout = vk::raii::PipelineLayout(gpu.device, {.setLayoutCount = 1, .pSetLayouts = &*set.layout});
    pipeline = gpu.computePipeline(lighting_comp, *layout);
}

void Lighting::setInputs(const GBuffer& buffer, const SunShadow& shadow, const Indirect& light)
{
    indirect = light;
    const auto kinds = bindings();
    const auto write = [&](uint32_t binding, vk::ImageView view, vk::ImageLayout imageLayout)
    {
        const vk::DescriptorImageInfo image{*comparing, view, imageLayout};
        gpu.device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *set.sets[0],
                                                               .dstBinding = binding,
                                                               .descriptorCount = 1,
                                                               .descriptorType = kinds[binding],
                                                               .pImageInfo = &image},
                                        {});
    };
    const vk::DescriptorBufferInfo whole{*block.buffer, 0, VK_WHOLE_SIZE};
    gpu.device.updateDescriptorSets(
        vk::WriteDescriptorSet{
            .dstSet = *set.sets[0], .dstBinding = 0, .descriptorCount = 1, .descriptorType = kinds[0], .pBufferInfo = &whole},
        {});
    const Image* const drawn[] = {&buffer.depth, &buffer.normalRoughness, &buffer.baseColorMetallic, &buffer.emission, &shadow.map()};
    for (uint32_t i = 0; i < 5; ++i) write(1 + i, *drawn[i]->view, vk::ImageLayout::eShaderReadOnlyOptimal);
    static_assert(kShadowBinding == 5);
    for (uint32_t i = 0; i < 4; ++i) write(kIndirectBinding + i, indirect.terms[i], vk::ImageLayout::eGeneral);
    for (uint32_t i = 0; i < 4; ++i) write(kPictureBinding + i, *pictures[i].view, vk::ImageLayout::eGeneral);
}

void Lighting::record(vk::CommandBuffer cmd, const Camera& camera, Convention convention, const Sun& sun, const SunShadow& shadow) const
{
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    constexpr Use before{vk::ImageLayout::eUndefined, Stage::eComputeShader | Stage::eAllTransfer, Access::eShaderStorageWrite};
    constexpr Use written{vk::ImageLayout::eGeneral, Stage::eComputeShader, Access::eShaderStorageWrite};
    constexpr Use copied{vk::ImageLayout::eTransferSrcOptimal, Stage::eAllTransfer, Access::eTransferRead};
    const auto wait = [&](vk::PipelineStageFlags2 from, vk::AccessFlags2 wrote, vk::PipelineStageFlags2 to, vk::AccessFlags2 next)
    {
        const vk::MemoryBarrier2 barrier{.srcStageMask = from, .srcAccessMask = wrote, .dstStageMask = to, .dstAccessMask = next};
        cmd.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &barrier});
    };
    const vk::Extent2D size = pictures[0].size;
    Block values{};
    values.worldFromClip = glm::inverse(clipFromWorld(camera, convention, double(size.width) / size.height));
    values.mapFromWorld = shadow.mapFromWorld();
    values.eye = camera.eye;
    values.shadowTexel = shadow.texel();
    values.toSun = -sun.along;
    values.made = indirect.made;
    values.raysBelow = indirect.raysBelow;
    values.sunIrradiance = sun.irradiance;
    values.sky = indirect.sky;
    wait(Stage::eComputeShader, Access::eNone, Stage::eAllTransfer, Access::eTransferWrite); // the frame before reads its own block
    cmd.updateBuffer<Block>(*block.buffer, 0, values);
    wait(Stage::eAllTransfer, Access::eTransferWrite, Stage::eComputeShader, Access::eUniformRead);
    for (const Image& picture : pictures) transition(cmd, picture, before, written);
    cmd.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
    cmd.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout, 0, *set.sets[0], {});
    cmd.dispatch((size.width + 7) / 8, (size.height + 7) / 8, 1);
    for (const Image& picture : pictures) transition(cmd, picture, written, copied);
}
