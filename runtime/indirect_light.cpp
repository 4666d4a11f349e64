#include "runtime/indirect_light.h"

#include "spirv/gather_diffuse_comp.h"
#include "spirv/trace_glossy_comp.h"

namespace sconce
{
namespace
{

constexpr VkFormat kLightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

} // namespace

Status IndirectLight::makePass(Pipeline& pipeline, DescriptorSet& set, Spirv shader, uint32_t storageImages)
{
    const DescriptorSet::Binding images[] = {{4, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}, {5, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    auto made = makeFrameSet(*gpu, frame, std::span(images).first(storageImages));
    if (!made) return made.error();
    set = std::move(*made);
    const VkDescriptorSetLayout layouts[] = {field->layout(), set.layout()};
    auto built = Pipeline::compute(*gpu, shader, layouts, 0, field->constants());
    if (!built) return built.error();
    pipeline = std::move(*built);
    return success();
}

Result<IndirectLight> IndirectLight::create(Gpu& gpu, const LightField& field, const Desc& desc)
{
    if (desc.width < 1 || desc.height < 1 || desc.width > gpu.properties.limits.maxImageDimension2D ||
        desc.height > gpu.properties.limits.maxImageDimension2D)
        return Error{ErrorCode::badArgument, "frame size " + std::to_string(desc.width) + "x" + std::to_string(desc.height) +
                                                 " is outside 1.." + std::to_string(gpu.properties.limits.maxImageDimension2D) +
                                                 " pixels a side"};
    IndirectLight made;
    made.gpu = &gpu;
    made.field = &field;
    made.desc = desc;
    auto frame = gpu.makeBuffer(sizeof(gpu::FrameView), 0, MemoryUse::device, "frame view");
    if (!frame) return frame.error();
    made.frame = std::move(*frame);

    auto image = [&](GpuImage& target, VkFormat format, const char* what) -> Status
    {
        ImageDesc imageDesc;
        imageDesc.format = format;
        imageDesc.width = desc.width;
        imageDesc.height = desc.height;
        imageDesc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        auto result = gpu.makeImage(imageDesc, what);
        if (!result) return result.error();
        target = std::move(*result);
        return gpu.submit(
            [&](VkCommandBuffer cmd)
            {
                transition(gpu, cmd, target,
                           {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_NONE,
                            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT});
            });
    };
    if (desc.effects.glossy)
    {
        if (auto s = image(made.noisyGlossy, kLightFormat, "glossy light"); !s) return s.error();
        if (auto s = image(made.countImage, VK_FORMAT_R32G32B32A32_UINT, "trace counts"); !s) return s.error();
        const Spirv shader = desc.glossyShader.empty() ? Spirv(trace_glossy_comp) : desc.glossyShader;
        if (auto s = made.makePass(made.glossyPass, made.glossySet, shader, 2); !s) return s.error();
        made.glossySet.write(4, made.noisyGlossy.view(), VK_IMAGE_LAYOUT_GENERAL);
        made.glossySet.write(5, made.countImage.view(), VK_IMAGE_LAYOUT_GENERAL);
        if (desc.effects.denoise)
        {
            if (auto s = image(made.smoothGlossy, kLightFormat, "denoised glossy light"); !s) return s.error();
            auto denoiser = Denoiser::create(gpu, field.layout(), made.frame, made.noisyGlossy, made.smoothGlossy);
            if (!denoiser) return denoiser.error();
            made.denoiser = std::move(*denoiser);
        }
    }
    if (desc.effects.diffuse)
    {
        if (auto s = image(made.diffuseImage, kLightFormat, "diffuse light"); !s) return s.error();
        if (auto s = made.makePass(made.diffusePass, made.diffuseSet, gather_diffuse_comp, 1); !s) return s.error();
        made.diffuseSet.write(4, made.diffuseImage.view(), VK_IMAGE_LAYOUT_GENERAL);
    }
    return made;
}

void IndirectLight::setInputs(const FrameInputs& inputs)
{
    if (glossyPass) writeInputs(glossySet, inputs);
    if (diffusePass) writeInputs(diffuseSet, inputs);
    if (denoiser) denoiser.setInputs(inputs);
}

void IndirectLight::record(VkCommandBuffer cmd, const gpu::FrameView& view, GpuTimer* timer) noexcept
{
    constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    memoryBarrier(*gpu, cmd, compute, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | compute,
                  VK_ACCESS_2_MEMORY_WRITE_BIT); // the frame before may still read what this one writes
    gpu->vk.CmdUpdateBuffer(cmd, frame.handle(), 0, sizeof(view), &view);
    memoryBarrier(*gpu, cmd, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, compute,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    auto dispatch = [&](const Pipeline& pipeline, const DescriptorSet& set, const char* name)
    {
        if (timer) timer->begin(cmd, name);
        const VkDescriptorSet sets[] = {field->descriptorSet(), set.handle()};
        pipeline.bind(cmd, sets);
        gpu->vk.CmdDispatch(cmd, (desc.width + 7) / 8, (desc.height + 7) / 8, 1);
        if (timer) timer->end(cmd);
    };
    if (glossyPass) dispatch(glossyPass, glossySet, "glossy trace");
    if (diffusePass) dispatch(diffusePass, diffuseSet, "diffuse gather");
    if (denoiser)
    {
        if (timer) timer->begin(cmd, "denoise");
        denoiser.record(cmd, field->descriptorSet(), desc.width, desc.height, true);
        if (timer) timer->end(cmd);
    }
    memoryBarrier(*gpu, cmd, compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT);
}

uint64_t IndirectLight::deviceBytes() const
{
    const uint64_t pixels = uint64_t(desc.width) * desc.height;
    uint64_t bytes = frame.size();
    for (const GpuImage* image : {&noisyGlossy, &smoothGlossy, &countImage, &diffuseImage})
        if (*image) bytes += 16 * pixels;
    return bytes;
}

} // namespace sconce
