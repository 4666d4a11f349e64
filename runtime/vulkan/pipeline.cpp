#include "runtime/vulkan/pipeline.h"

#include <cassert>
#include <cstddef>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace sconce
{

Result<DescriptorSet> DescriptorSet::create(Gpu& gpu, std::span<const Binding> bindings)
{
    DescriptorSet made;
    made.gpu = &gpu;
    made.bindings.assign(bindings.begin(), bindings.end());
    std::vector<VkDescriptorSetLayoutBinding> layout;
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& binding : bindings)
    {
        layout.push_back({binding.binding, binding.type, 1, binding.stages, nullptr});
        sizes.push_back({binding.type, 1});
    }
    const auto found = gpu.setLayout(layout);
    if (!found) return found.error();
    made.setLayout = *found;
    // A pool for one set: the set lives and dies with it, beside all others.
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = uint32_t(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    VkResult result = made.pool.make(gpu, gpu.vk.CreateDescriptorPool, gpu.host.device, &poolInfo, gpu.host.allocationCallbacks);
    if (result != VK_SUCCESS) return gpu.failure("vkCreateDescriptorPool", result);
    VkDescriptorSetAllocateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    setInfo.descriptorPool = made.pool.get();
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &made.setLayout;
    result = gpu.vk.AllocateDescriptorSets(gpu.host.device, &setInfo, &made.set);
    if (result != VK_SUCCESS) return gpu.failure("vkAllocateDescriptorSets", result);
    return made;
}

VkDescriptorType DescriptorSet::typeOf(uint32_t binding) const
{
    for (const Binding& one : bindings)
        if (one.binding == binding) return one.type;
    assert(false && "the set has no such binding");
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

void DescriptorSet::write(uint32_t binding, const Buffer& buffer)
{
    const VkDescriptorBufferInfo info{buffer.handle(), 0, VK_WHOLE_SIZE};
    const VkBufferView view = buffer.texels();
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = typeOf(binding);
    write.pBufferInfo = &info;
    write.pTexelBufferView = &view;
    gpu->vk.UpdateDescriptorSets(gpu->host.device, 1, &write, 0, nullptr);
}

void DescriptorSet::write(uint32_t binding, VkImageView view, VkImageLayout imageLayout, VkSampler sampler)
{
    const VkDescriptorImageInfo info{sampler, view, imageLayout};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = typeOf(binding);
    write.pImageInfo = &info;
    gpu->vk.UpdateDescriptorSets(gpu->host.device, 1, &write, 0, nullptr);
}

namespace
{

/// A shader module for as long as a pipeline is being made.
struct Module
{
    Handle<VkShaderModule, &VulkanFunctions::DestroyShaderModule> handle;
    VkResult result = VK_SUCCESS;

    Module(const Gpu& gpu, Spirv code)
    {
        if (code.empty()) return;
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = code.size_bytes();
        info.pCode = code.data();
        result = handle.make(gpu, gpu.vk.CreateShaderModule, gpu.host.device, &info, gpu.host.allocationCallbacks);
    }
};

struct Specialization
{
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};

    explicit Specialization(std::span<const ShaderConstant> constants)
    {
        for (uint32_t i = 0; i < constants.size(); ++i)
            entries.push_back({constants[i].id, uint32_t(i * sizeof(ShaderConstant) + offsetof(ShaderConstant, value)), 4});
        info = {uint32_t(entries.size()), entries.data(), constants.size_bytes(), constants.data()};
    }
};

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, const Module& module, const Specialization& specialization)
{
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module.handle.get();
    info.pName = "main";
    info.pSpecializationInfo = specialization.entries.empty() ? nullptr : &specialization.info;
    return info;
}

} // namespace

Status Pipeline::makeLayout(const Gpu& gpu, Made& of, VkShaderStageFlags stages, std::span<const VkDescriptorSetLayout> sets,
                            uint32_t pushBytes)
{
    const VkPushConstantRange range{stages, 0, pushBytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = uint32_t(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = pushBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    const VkResult result = of.layout.make(gpu, gpu.vk.CreatePipelineLayout, gpu.host.device, &info, gpu.host.allocationCallbacks);
    if (result != VK_SUCCESS) return gpu.failure("vkCreatePipelineLayout", result);
    return success();
}

Result<Pipeline> Pipeline::compute(Gpu& gpu, Spirv shader, std::span<const VkDescriptorSetLayout> sets, uint32_t pushBytes,
                                   std::span<const ShaderConstant> constants, VkPipelineCreateFlags flags)
{
    Pipeline pipeline;
    pipeline.gpu = &gpu;
    pipeline.stages = VK_SHADER_STAGE_COMPUTE_BIT;
    std::vector<uint64_t> key = {XXH3_64bits(shader.data(), shader.size_bytes()), shader.size(), pushBytes, flags, sets.size()};
    for (const VkDescriptorSetLayout set : sets) key.push_back(reinterpret_cast<uint64_t>(set));
    for (const ShaderConstant& constant : constants) key.push_back(uint64_t(constant.id) << 32 | constant.value);
    const auto make = [&](Gpu& home) -> Result<std::shared_ptr<const void>>
    {
        const auto made = std::make_shared<Made>();
        if (auto status = makeLayout(home, *made, pipeline.stages, sets, pushBytes); !status) return status.error();
        const Module module(home, shader);
        if (module.result != VK_SUCCESS) return home.failure("vkCreateShaderModule", module.result);
        const Specialization specialization(constants);
        VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
        info.flags = flags;
        info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module, specialization);
        info.layout = made->layout.get();
        const VkResult result = made->pipeline.make(home, home.vk.CreateComputePipelines, home.host.device, home.host.pipelineCache, 1,
                                                    &info, home.host.allocationCallbacks);
        if (result != VK_SUCCESS) return home.failure("vkCreateComputePipelines", result);
        return std::shared_ptr<const void>(made);
    };
    auto made = gpu.computePipeline(key, make);
    if (!made) return made.error();
    pipeline.made = std::static_pointer_cast<const Made>(*made);
    return pipeline;
}

Result<Pipeline> Pipeline::graphics(Gpu& gpu, const Graphics& desc)
{
    Pipeline pipeline;
    pipeline.gpu = &gpu;
    pipeline.bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    pipeline.stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const auto made = std::make_shared<Made>();
    if (auto status = makeLayout(gpu, *made, pipeline.stages, desc.sets, desc.pushBytes); !status) return status.error();
    const Module vertex(gpu, desc.vertex), fragment(gpu, desc.fragment);
    if (vertex.result != VK_SUCCESS) return gpu.failure("vkCreateShaderModule", vertex.result);
    if (fragment.result != VK_SUCCESS) return gpu.failure("vkCreateShaderModule", fragment.result);
    const Specialization specialization(desc.constants);
    const VkPipelineShaderStageCreateInfo stages[] = {stageInfo(VK_SHADER_STAGE_VERTEX_BIT, vertex, specialization),
                                                      stageInfo(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, specialization)};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = uint32_t(desc.vertexBindings.size());
    input.pVertexBindingDescriptions = desc.vertexBindings.data();
    input.vertexAttributeDescriptionCount = uint32_t(desc.vertexAttributes.size());
    input.pVertexAttributeDescriptions = desc.vertexAttributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = desc.depthFormat != VK_FORMAT_UNDEFINED;
    depth.depthCompareOp = desc.depthCompare;
    std::vector<VkPipelineColorBlendAttachmentState> blends(desc.colorFormats.size());
    // Nothing is blended: transparency is by lot, and light is added by passes that read what was there.
    for (auto& blend : blends) blend.colorWriteMask = 0xf;
    VkPipelineColorBlendStateCreateInfo color{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    color.attachmentCount = uint32_t(blends.size());
    color.pAttachments = blends.data();
    // Dynamic, so that one pipeline draws cube faces, shadow maps and frames of every size. Culling, since every second cube face is seen
    // through a mirror, and two-sided scenes have none.
    const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_CULL_MODE};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = uint32_t(std::size(dynamics));
    dynamic.pDynamicStates = dynamics;
    // Rendering is dynamic: there is no render pass that the formats could come from.
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = uint32_t(desc.colorFormats.size());
    rendering.pColorAttachmentFormats = desc.colorFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    // Without a fragment shader depth alone is drawn, and the second stage has no module.
    info.stageCount = desc.fragment.empty() ? 1 : 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &color;
    info.pDynamicState = &dynamic;
    info.layout = made->layout.get();
    const VkResult result = made->pipeline.make(gpu, gpu.vk.CreateGraphicsPipelines, gpu.host.device, gpu.host.pipelineCache, 1, &info,
                                                gpu.host.allocationCallbacks);
    if (result != VK_SUCCESS) return gpu.failure("vkCreateGraphicsPipelines", result);
    pipeline.made = made;
    return pipeline;
}

void Pipeline::bind(VkCommandBuffer cmd, std::span<const VkDescriptorSet> sets) const
{
    gpu->vk.CmdBindPipeline(cmd, bindPoint, handle());
    if (!sets.empty()) gpu->vk.CmdBindDescriptorSets(cmd, bindPoint, layout(), 0, uint32_t(sets.size()), sets.data(), 0, nullptr);
}

Result<Sampler> Sampler::create(Gpu& gpu, const VkSamplerCreateInfo& info)
{
    Sampler made;
    const VkResult result = made.sampler.make(gpu, gpu.vk.CreateSampler, gpu.host.device, &info, gpu.host.allocationCallbacks);
    if (result != VK_SUCCESS) return gpu.failure("vkCreateSampler", result);
    return made;
}

} // namespace sconce
