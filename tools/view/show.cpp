#include "tools/view/show.h"

#include <algorithm>

#include "runtime/frame/denoiser.h"

#include "spirv/show_comp.h"

namespace sconce::tools
{

namespace
{

struct Push // of show.comp
{
    uint32_t view, compare, made;
    float exposure, split, depthScale, depthMiddle;
};
enum Binding : uint32_t // of show.comp
{
    beautyBinding,
    directBinding,
    diffuseBinding,
    glossyBinding,
    normalBinding,
    baseColorBinding,
    depthBinding,
    countsBinding,
    referenceBinding,
    pictureBinding
};

uint32_t bitOf(std::string_view view)
{
    return 1u << uint32_t(std::ranges::find(kViews, view) - kViews.begin());
}

} // namespace

Result<Show> Show::create(Gpu& gpu, const FramePictures& pictures, uint32_t width, uint32_t height)
{
    Show show(gpu);
    if (Status made = show.make(pictures, width, height); !made) return made.error();
    return show;
}

Status Show::make(const FramePictures& pictures, uint32_t width, uint32_t height)
{
    for (auto [image, format, wide, high, what] :
         {std::tuple{&picture, VK_FORMAT_R8G8B8A8_UNORM, width, height, "the viewer's picture"},
          std::tuple{&reference, VK_FORMAT_R32G32B32A32_SFLOAT, width, height, "the viewer's reference"},
          std::tuple{&noCounts, VK_FORMAT_R32G32B32A32_UINT, 1u, 1u, "the viewer's stand-in for counts"}})
    {
        auto created = makeLightImage(*gpu, format, wide, high, what);
        if (!created) return created.error();
        *image = std::move(*created);
    }
    depthScale = pictures.depthScale;
    have = bitOf("beauty") | bitOf("direct") | bitOf("normal") | bitOf("albedo") | bitOf("depth") | bitOf("roughness");
    if (pictures.diffuseLayer) have |= bitOf("diffuse_indirect");
    if (pictures.glossyLayer) have |= bitOf("glossy_indirect");
    if (pictures.counts) have |= bitOf("probe") | bitOf("handoffs") | bitOf("fetches") | bitOf("unknown");

    std::vector<DescriptorSet::Binding> bindings;
    for (uint32_t i = beautyBinding; i <= pictureBinding; ++i)
        bindings.push_back({i,
                            i >= normalBinding && i <= depthBinding ? VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                            VK_SHADER_STAGE_COMPUTE_BIT});
    auto bound = DescriptorSet::create(*gpu, bindings);
    if (!bound) return bound.error();
    set = std::move(*bound);
    // What isn't made isn't shown: anything of the format may be bound in its place.
    const auto orDirect = [&](const GpuImage* image) { return (image ? image : pictures.direct)->view(); };
    for (auto [binding, view] : {std::pair{beautyBinding, pictures.beauty->view()},
                                 {directBinding, pictures.direct->view()},
                                 {diffuseBinding, orDirect(pictures.diffuseLayer)},
                                 {glossyBinding, orDirect(pictures.glossyLayer)},
                                 {countsBinding, (pictures.counts ? pictures.counts : &noCounts)->view()},
                                 {referenceBinding, reference.view()},
                                 {pictureBinding, picture.view()}})
        set.write(binding, view, VK_IMAGE_LAYOUT_GENERAL);
    for (auto [binding, image] : {std::pair{normalBinding, pictures.normalRoughness},
                                  {baseColorBinding, pictures.baseColorMetallic},
                                  {depthBinding, pictures.depth}})
        set.write(binding, image->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    const VkDescriptorSetLayout layouts[] = {set.layout()};
    auto pipeline = Pipeline::compute(*gpu, show_comp, layouts, sizeof(Push));
    if (!pipeline) return pipeline.error();
    pass = std::move(*pipeline);
    return success();
}

Status Show::setReference(std::span<const float> rgb)
{
    const ImageDesc& desc = reference.desc();
    std::vector<float> rgba(size_t(desc.width) * desc.height * 4, 1.0f);
    for (size_t i = 0; i < rgba.size() / 4; ++i)
        for (size_t c = 0; c < 3; ++c) rgba[4 * i + c] = rgb[3 * i + c];
    auto buffer = gpu->makeBufferWith(std::span<const float>(rgba), 0, "the viewer's reference on its way");
    if (!buffer) return buffer.error();
    const Status copied = gpu->submit(
        [&](VkCommandBuffer cmd)
        {
            // Write after read: the pass of the frame before reads it.
            transition(*gpu, cmd, reference,
                       {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                        VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_MEMORY_READ_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
            VkBufferImageCopy copy{};
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            copy.imageExtent = {desc.width, desc.height, 1};
            vkCmdCopyBufferToImage(cmd, buffer->handle(), reference.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
            // Read after write.
            transition(*gpu, cmd, reference,
                       {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
        });
    if (copied) referenceHeld = true;
    return copied;
}

void Show::record(VkCommandBuffer cmd, const Shown& shown)
{
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    // Read after write: the frame's pictures. Write after read: the copy of the last of these.
    memoryBarrier(*gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT, compute,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    const VkDescriptorSet sets[] = {set.handle()};
    pass.bind(cmd, sets);
    pass.push(cmd, Push{shown.view, referenceHeld ? shown.compare : 0u, have, shown.exposure, shown.split, depthScale, shown.depthMiddle});
    const ImageDesc& desc = picture.desc();
    gpu->vk.CmdDispatch(cmd, (desc.width + 7) / 8, (desc.height + 7) / 8, 1);
    memoryBarrier(*gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT);
}

} // namespace sconce::tools
