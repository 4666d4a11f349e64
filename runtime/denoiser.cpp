#include "runtime/denoiser.h"

#include <array>

#include "spirv/denoise_comp.h"

namespace sconce
{
namespace
{

struct DenoisePush // as shaders/denoise.comp
{
    int stride;
    int followRoughness;
};
constexpr int kStrides[] = {1, 2, 4}; // pixels; an odd number of steps ends in the second image

} // namespace

Result<DescriptorSet> makeFrameSet(Gpu& gpu, const Buffer& frame, std::span<const DescriptorSet::Binding> passBindings)
{
    std::vector<DescriptorSet::Binding> bindings = {{0, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {1, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {2, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                                                    {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    bindings.insert(bindings.end(), passBindings.begin(), passBindings.end());
    auto set = DescriptorSet::create(gpu, bindings);
    if (set) set->write(3, frame);
    return set;
}

void writeInputs(DescriptorSet& set, const FrameInputs& inputs)
{
    set.write(0, inputs.depth, inputs.layout);
    set.write(1, inputs.normalRoughness, inputs.layout);
    set.write(2, inputs.baseColorMetallic, inputs.layout);
}

Result<Denoiser> Denoiser::create(Gpu& gpu, const Desc& desc, const Buffer& frame, const GpuImage& noisy, const GpuImage& filtered)
{
    Denoiser made;
    made.gpu = &gpu;
    made.desc = desc;
    const DescriptorSet::Binding images[] = {
        {4, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}, {5, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}, {kTileBinding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
    for (bool forward : {true, false})
    {
        auto set = makeFrameSet(gpu, frame, images);
        if (!set) return set.error();
        set->write(4, (forward ? noisy : filtered).view(), VK_IMAGE_LAYOUT_GENERAL);
        set->write(5, (forward ? filtered : noisy).view(), VK_IMAGE_LAYOUT_GENERAL);
        set->write(kTileBinding, desc.tiles ? desc.tiles->buffer() : frame); // without tiles it is not read
        (forward ? made.forth : made.back) = std::move(*set);
    }
    const VkDescriptorSetLayout layouts[] = {desc.firstSet, made.forth.layout()};
    const uint32_t constants[] = {desc.tiles ? 1u : 0u, desc.term};
    auto built = Pipeline::compute(gpu, denoise_comp, layouts, sizeof(DenoisePush), constants);
    if (!built) return built.error();
    made.pipeline = std::move(*built);
    return made;
}

void Denoiser::setInputs(const FrameInputs& inputs)
{
    writeInputs(forth, inputs);
    writeInputs(back, inputs);
}

void Denoiser::record(VkCommandBuffer cmd, VkDescriptorSet firstSet) const
{
    bool forward = true;
    for (int stride : kStrides)
    {
        memoryBarrier(*gpu, cmd, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        const VkDescriptorSet sets[] = {firstSet, (forward ? forth : back).handle()};
        pipeline.bind(cmd, sets);
        pipeline.push(cmd, DenoisePush{stride, desc.followRoughness ? 1 : 0});
        dispatchTiles(*gpu, cmd, desc.tiles, desc.term, desc.width, desc.height);
        forward = !forward;
    }
}

} // namespace sconce
