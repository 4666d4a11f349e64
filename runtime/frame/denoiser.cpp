#include "runtime/frame/denoiser.h"

#include <iterator>

#include "runtime/vulkan/nan_scan.h"

#include "spirv/denoise_comp.h"
#include "spirv/temporal_comp.h"

namespace sconce
{
namespace
{

constexpr int kStrides[] = {1, 2, 4, 8}; // pixels; an even number of steps ends where it began

} // namespace

Result<DescriptorSet> makeFrameSet(Gpu& gpu, const Buffer& frame, std::span<const DescriptorSet::Binding> passBindings)
{
    std::vector<DescriptorSet::Binding> bindings = {{gpu::kDepthBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {gpu::kNormalRoughnessBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {gpu::kBaseColorMetallicBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {gpu::kFrameBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    bindings.insert(bindings.end(), passBindings.begin(), passBindings.end());
    for (DescriptorSet::Binding& binding : bindings) binding.stages = VK_SHADER_STAGE_COMPUTE_BIT;
    auto set = DescriptorSet::create(gpu, bindings);
    if (set) set->write(gpu::kFrameBinding, frame);
    return set;
}

Result<GpuImage> makeLightImage(Gpu& gpu, VkFormat format, uint32_t width, uint32_t height, const char* what)
{
    ImageDesc desc;
    desc.format = format;
    desc.width = width;
    desc.height = height;
    desc.usage =
        VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    auto image = gpu.makeImage(desc, what);
    if (!image) return image.error();
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            // A new image: nothing used it, and nothing in it is kept.
            transition(gpu, cmd, *image,
                       {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_NONE, VK_PIPELINE_STAGE_2_CLEAR_BIT, 0,
                        VK_ACCESS_2_TRANSFER_WRITE_BIT});
            // Passes write the pixels of their term alone; the others must be numbers all the same: the scan for NaN reads whole images.
            const VkClearColorValue nothing{};
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            gpu.vk.CmdClearColorImage(cmd, image->handle(), VK_IMAGE_LAYOUT_GENERAL, &nothing, 1, &all);
            // All commands, reads and writes: this serves passes and a host's outputs alike, and happens once an image.
            memoryBarrier(gpu, cmd, VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                          VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
        });
    if (!status) return status.error();
    return image;
}

void writeInputs(DescriptorSet& set, const FrameInputs& inputs)
{
    set.write(gpu::kDepthBinding, inputs.depth, inputs.layout);
    set.write(gpu::kNormalRoughnessBinding, inputs.normalRoughness, inputs.layout);
    set.write(gpu::kBaseColorMetallicBinding, inputs.baseColorMetallic, inputs.layout);
}

Result<DescriptorSet> Denoiser::makeStep(const Buffer& frame, const GpuImage& from, const GpuImage& to)
{
    const DescriptorSet::Binding bindings[] = {{gpu::kFilterFromBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                               {gpu::kFilterToBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                               {gpu::kPackedBinding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                                               {gpu::kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    auto set = makeFrameSet(*gpu, frame, bindings);
    if (!set) return set.error();
    set->write(gpu::kFilterFromBinding, from.view(), VK_IMAGE_LAYOUT_GENERAL);
    set->write(gpu::kFilterToBinding, to.view(), VK_IMAGE_LAYOUT_GENERAL);
    set->write(gpu::kPackedBinding, desc.tiles->packedPixels().view(), VK_IMAGE_LAYOUT_GENERAL);
    set->write(gpu::kTileBinding, desc.tiles->buffer());
    return set;
}

Status Denoiser::makeHistory(const Buffer& frame, const GpuImage& light, const GpuImage& scratch)
{
    for (History& history : histories)
    {
        for (const auto& [image, format] : {std::pair{&history.light, kLightFormat}, {&history.points, VK_FORMAT_R32_UINT}})
        {
            auto made = makeLightImage(*gpu, format, desc.width, desc.height, "the history of a filter over time");
            if (!made) return made.error();
            *image = std::move(*made);
        }
        auto first = makeStep(frame, history.light, scratch);
        if (!first) return first.error();
        history.first = std::move(*first);
    }
    for (uint32_t i = 0; i < 2; ++i)
    {
        const History &own = histories[i], &other = histories[1 - i];
        struct Bound
        {
            uint32_t binding;
            const GpuImage& image;
            VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        };
        const Bound images[] = {{gpu::kBlendLightBinding, light},
                                {gpu::kBlendBeforeBinding, other.light, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                {gpu::kBlendPointsBeforeBinding, other.points, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                {gpu::kBlendAfterBinding, own.light},
                                {gpu::kBlendPointsAfterBinding, own.points},
                                {gpu::kPackedBinding, desc.tiles->packedPixels()}};
        std::vector<DescriptorSet::Binding> bindings = {{gpu::kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
        for (const Bound& bound : images) bindings.push_back({bound.binding, bound.type});
        auto set = makeFrameSet(*gpu, frame, bindings);
        if (!set) return set.error();
        for (const Bound& bound : images) set->write(bound.binding, bound.image.view(), VK_IMAGE_LAYOUT_GENERAL);
        set->write(gpu::kTileBinding, desc.tiles->buffer());
        histories[i].blend = std::move(*set);
    }
    const VkDescriptorSetLayout layouts[] = {desc.firstSet, histories[0].blend.layout()};
    const ShaderConstant constants[] = {desc.tiles->constant(), {gpu::kTermId, desc.term}, {gpu::kMovingId, desc.moving ? 1u : 0u}};
    auto built = Pipeline::compute(*gpu, temporal_comp, layouts, 0, constants);
    if (!built) return built.error();
    temporal = std::move(*built);
    return success();
}

Result<Denoiser> Denoiser::create(Gpu& gpu, const Desc& desc, const Buffer& frame, const GpuImage& light, const GpuImage& scratch)
{
    Denoiser made;
    made.gpu = &gpu;
    made.desc = desc;
    for (bool forward : {true, false})
    {
        auto set = made.makeStep(frame, forward ? light : scratch, forward ? scratch : light);
        if (!set) return set.error();
        (forward ? made.forth : made.back) = std::move(*set);
    }
    if (desc.temporal)
        if (auto status = made.makeHistory(frame, light, scratch); !status) return status.error();
    const VkDescriptorSetLayout layouts[] = {desc.firstSet, made.forth.layout()};
    const ShaderConstant constants[] = {desc.tiles->constant(), {gpu::kTermId, desc.term}, {gpu::kBlendedId, desc.temporal ? 1u : 0u}};
    auto built = Pipeline::compute(gpu, denoise_comp, layouts, sizeof(gpu::DenoisePush), constants);
    if (!built) return built.error();
    made.pipeline = std::move(*built);
    return made;
}

void Denoiser::setInputs(const FrameInputs& inputs)
{
    writeInputs(forth, inputs);
    writeInputs(back, inputs);
    if (!desc.temporal) return;
    for (History& history : histories)
    {
        writeInputs(history.blend, inputs);
        writeInputs(history.first, inputs);
    }
}

void Denoiser::blend(VkCommandBuffer cmd, VkDescriptorSet firstSet)
{
    now = 1 - now;
    const History& own = histories[now];
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    const VkClearColorValue nothing{};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    // Two histories take turns: these points were written two frames ago and read by the blend of the frame before. The clear must come
    // after both, which were compute passes.
    memoryBarrier(*gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, transfer,
                  VK_ACCESS_2_TRANSFER_WRITE_BIT);
    gpu->vk.CmdClearColorImage(cmd, own.points.handle(), VK_IMAGE_LAYOUT_GENERAL, &nothing, 1, &all); // no pixel is of this frame yet
    // The blend writes over the cleared points (hence transfer) and reads this frame's light, which the passes before made, and the other
    // history, of the frame before (hence compute).
    memoryBarrier(*gpu, cmd, transfer | compute, VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, compute,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    const VkDescriptorSet sets[] = {firstSet, own.blend.handle()};
    temporal.bind(cmd, sets);
    desc.tiles->dispatch(cmd, desc.term);
    scanImage(*gpu, cmd, "blend over time", own.light);
}

void Denoiser::record(VkCommandBuffer cmd, VkDescriptorSet firstSet)
{
    if (desc.temporal) blend(cmd, firstSet);
    const DescriptorSet* step = desc.temporal ? &histories[now].first : &forth;
    for (int stride : kStrides)
    {
        // A step reads what the one before wrote, and writes over what that one read: light and scratch swap roles. Before the first step
        // this orders the pass that made the light; after the last one the caller does.
        memoryBarrier(*gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        const VkDescriptorSet sets[] = {firstSet, step->handle()};
        pipeline.bind(cmd, sets);
        pipeline.push(cmd, gpu::DenoisePush{stride, desc.followRoughness ? 1 : 0, stride == std::end(kStrides)[-1] ? 1 : 0});
        desc.tiles->dispatch(cmd, desc.term);
        step = step == &back ? &forth : &back;
    }
}

uint64_t Denoiser::deviceBytes() const
{
    uint64_t bytes = 0;
    for (const History& history : histories)
        for (const GpuImage* image : {&history.light, &history.points})
            if (*image) bytes += image->bytes();
    return bytes;
}

} // namespace sconce
