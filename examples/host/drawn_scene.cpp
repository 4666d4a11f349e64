#include "drawn_scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <map>

namespace
{

using Layout = vk::ImageLayout;
using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
constexpr Use kNew{Layout::eUndefined, Stage::eNone, Access::eNone};
constexpr Use kWritten{Layout::eTransferDstOptimal, Stage::eAllTransfer, Access::eTransferWrite};
constexpr Use kCopied{Layout::eTransferSrcOptimal, Stage::eAllTransfer, Access::eTransferRead};
constexpr Use kSampled{Layout::eShaderReadOnlyOptimal, Stage::eFragmentShader, Access::eShaderSampledRead};

/// From one mip to the next, each half as large: from all in the layout of kWritten, to all in that of kSampled.
void blitMips(vk::CommandBuffer cmd, const Image& image)
{
    const auto extent = [&](uint32_t mip) {
        return vk::Offset3D{int32_t(std::max(image.size.width >> mip, 1u)), int32_t(std::max(image.size.height >> mip, 1u)), 1};
    };
    for (uint32_t mip = 1; mip < image.mips; ++mip)
    {
        transition(cmd, image, kWritten, kCopied, {mip - 1, 1});
        vk::ImageBlit blit{.srcSubresource = {vk::ImageAspectFlagBits::eColor, mip - 1, 0, 1},
                           .dstSubresource = {vk::ImageAspectFlagBits::eColor, mip, 0, 1}};
        blit.srcOffsets[1] = extent(mip - 1);
        blit.dstOffsets[1] = extent(mip);
        cmd.blitImage(*image.image, kCopied.layout, *image.image, kWritten.layout, blit, vk::Filter::eLinear);
    }
    if (image.mips > 1) transition(cmd, image, kCopied, kSampled, {0, image.mips - 1});
    transition(cmd, image, kWritten, kSampled, {image.mips - 1, 1});
}

constexpr vk::ShaderStageFlags kDrawStages = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

/// gbuffer_push.glsl, scalar layout.
struct Push
{
    glm::mat4 clipFromRelative;
    glm::vec4 baseColor;
    glm::vec3 emission;
    float metallic;
    glm::vec3 eye;
    float roughness;
    float normalScale;
    float alphaCutoff;
    float fieldsZ;
};
static_assert(sizeof(Push) == 124); // 128 is what every device has

} // namespace

Image DrawnScene::texture(const Picture& picture, vk::Format format) const
{
    const uint32_t mips = uint32_t(std::bit_width(std::max(picture.width, picture.height)));
    using Usage = vk::ImageUsageFlagBits;
    Image made = gpu.makeImage(format, {picture.width, picture.height}, Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst, mips);
    const Buffer staging = gpu.makeBuffer(picture.rgba.size(), vk::BufferUsageFlagBits::eTransferSrc, true);
    std::memcpy(staging.mapped, picture.rgba.data(), picture.rgba.size());
    gpu.run(
        [&](vk::CommandBuffer cmd)
        {
            transition(cmd, made, kNew, kWritten);
            const vk::BufferImageCopy copy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, 0, 0, 1},
                                           .imageExtent = {picture.width, picture.height, 1}};
            cmd.copyBufferToImage(*staging.buffer, *made.image, kWritten.layout, copy);
            blitMips(cmd, made);
        });
    return made;
}

DrawnScene::DrawnScene(const Vulkan& vulkan, Model loaded) : gpu(vulkan), source(std::move(loaded))
{
    vertices = gpu.upload(std::as_bytes(std::span(source.vertices)), vk::BufferUsageFlagBits::eVertexBuffer);
    indices = gpu.upload(std::as_bytes(std::span(source.indices)), vk::BufferUsageFlagBits::eIndexBuffer);
    sampler = vk::raii::Sampler(gpu.device, {.magFilter = vk::Filter::eLinear,
                                             .minFilter = vk::Filter::eLinear,
                                             .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                             .maxLod = VK_LOD_CLAMP_NONE});
    const std::vector<vk::DescriptorType> kinds(4, vk::DescriptorType::eCombinedImageSampler);
    materials = makeSets(gpu, kinds, vk::ShaderStageFlagBits::eFragment, uint32_t(source.materials.size()));

    // A picture that is a colour of one material may be data of another: a texture for each of its uses.
    std::map<std::pair<int, vk::Format>, size_t> made;
    const Picture white{1, 1, {255, 255, 255, 255}};
    const auto textureOf = [&](int picture, vk::Format format)
    {
        const auto [entry, isNew] = made.try_emplace({picture, format}, textures.size());
        if (isNew) textures.push_back(texture(picture < 0 ? white : source.pictures[size_t(picture)], format));
        return *textures[entry->second].view;
    };
    for (size_t i = 0; i < source.materials.size(); ++i)
    {
        const Material& material = source.materials[i];
        const std::pair<int, vk::Format> slots[] = {{material.baseColorPicture, vk::Format::eR8G8B8A8Srgb},
                                                    {material.metallicRoughnessPicture, vk::Format::eR8G8B8A8Unorm},
                                                    {material.emissionPicture, vk::Format::eR8G8B8A8Srgb},
                                                    {material.normalPicture, vk::Format::eR8G8B8A8Unorm}};
        for (uint32_t binding = 0; binding < 4; ++binding)
        {
            const vk::DescriptorImageInfo image{*sampler, textureOf(slots[binding].first, slots[binding].second), kSampled.layout};
            gpu.device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *materials.sets[i],
                                                                   .dstBinding = binding,
                                                                   .descriptorCount = 1,
                                                                   .descriptorType = kinds[binding],
                                                                   .pImageInfo = &image},
                                            {});
        }
    }
}

void DrawnScene::bindVertices(vk::CommandBuffer cmd) const
{
    cmd.bindVertexBuffers(0, *vertices.buffer, vk::DeviceSize(0));
    cmd.bindIndexBuffer(*indices.buffer, 0, vk::IndexType::eUint32);
}

vk::raii::PipelineLayout DrawnScene::drawLayout() const
{
    const vk::PushConstantRange push{kDrawStages, 0, sizeof(Push)};
    return {gpu.device,
            {.setLayoutCount = 1, .pSetLayouts = &*materials.layout, .pushConstantRangeCount = 1, .pPushConstantRanges = &push}};
}

void DrawnScene::draw(vk::CommandBuffer cmd, vk::PipelineLayout layout, const glm::mat4& clip, glm::vec3 eye, float fieldsZ) const
{
    bindVertices(cmd);
    for (const Part& part : source.parts)
    {
        const Material& of = source.materials[part.material];
        const Push push{clip, of.baseColor, of.emission, of.metallic, eye, of.roughness, of.normalScale, of.alphaCutoff, fieldsZ};
        cmd.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, *materials.sets[part.material], {});
        cmd.pushConstants<Push>(layout, kDrawStages, 0, push);
        cmd.drawIndexed(part.indices, 1, part.firstIndex, 0, 0);
    }
}

vk::PipelineVertexInputStateCreateInfo DrawnScene::vertexInput(uint32_t attributes)
{
    static constexpr vk::VertexInputBindingDescription binding{.binding = 0, .stride = sizeof(Vertex)};
    static constexpr vk::VertexInputAttributeDescription all[] = {
        {.location = 0, .format = vk::Format::eR32G32B32Sfloat, .offset = offsetof(Vertex, position)},
        {.location = 1, .format = vk::Format::eR32G32B32Sfloat, .offset = offsetof(Vertex, normal)},
        {.location = 2, .format = vk::Format::eR32G32Sfloat, .offset = offsetof(Vertex, uv)}};
    return {.vertexBindingDescriptionCount = 1,
            .pVertexBindingDescriptions = &binding,
            .vertexAttributeDescriptionCount = attributes,
            .pVertexAttributeDescriptions = all};
}
