#include "tests/support/kept_pipelines.h"

#include <cstdint>

namespace sconce::testing_support
{
namespace
{

/// Bytes of values that have no holes and no pointers.
template <class T> void add(std::string& key, const T* values, size_t count)
{
    const uint64_t bytes = count * sizeof(T);
    key.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    if (bytes > 0) key.append(reinterpret_cast<const char*>(values), bytes);
}
template <class T> void add(std::string& key, const T& value)
{
    add(key, &value, 1);
}

} // namespace

void KeptPipelines::note(const VkShaderModuleCreateInfo& info, VkShaderModule made)
{
    modules[made] = std::string(reinterpret_cast<const char*>(info.pCode), info.codeSize);
}

void KeptPipelines::note(const VkDescriptorSetLayoutCreateInfo& info, VkDescriptorSetLayout made)
{
    std::string& key = sets[made] = {};
    for (uint32_t i = 0; i < info.bindingCount; ++i)
    {
        const VkDescriptorSetLayoutBinding& binding = info.pBindings[i];
        add(key, binding.binding), add(key, binding.descriptorType), add(key, binding.descriptorCount), add(key, binding.stageFlags);
    }
}

void KeptPipelines::note(const VkPipelineLayoutCreateInfo& info, VkPipelineLayout made)
{
    std::string& key = layouts[made] = {};
    for (uint32_t i = 0; i < info.setLayoutCount; ++i)
    {
        const std::string& set = sets[info.pSetLayouts[i]];
        add(key, set.data(), set.size());
    }
    add(key, info.pPushConstantRanges, info.pushConstantRangeCount);
}

std::string KeptPipelines::keyOf(const VkPipelineShaderStageCreateInfo& stage) const
{
    std::string key;
    add(key, stage.stage);
    if (const auto found = modules.find(stage.module); found != modules.end()) add(key, found->second.data(), found->second.size());
    if (const VkSpecializationInfo* constants = stage.pSpecializationInfo)
    {
        add(key, static_cast<const char*>(constants->pData), constants->dataSize);
        for (uint32_t i = 0; i < constants->mapEntryCount; ++i)
            add(key, constants->pMapEntries[i].constantID), add(key, constants->pMapEntries[i].offset);
    }
    return key;
}

std::string KeptPipelines::keyOf(const VkComputePipelineCreateInfo& info) const
{
    return keyOf(info.stage) + layouts.at(info.layout);
}

std::string KeptPipelines::keyOf(const VkGraphicsPipelineCreateInfo& info) const
{
    std::string key = layouts.at(info.layout);
    for (uint32_t i = 0; i < info.stageCount; ++i) key += keyOf(info.pStages[i]);
    const auto& rendering = *static_cast<const VkPipelineRenderingCreateInfo*>(info.pNext);
    add(key, rendering.pColorAttachmentFormats, rendering.colorAttachmentCount);
    add(key, rendering.depthAttachmentFormat), add(key, info.pDepthStencilState->depthCompareOp);
    const VkPipelineVertexInputStateCreateInfo& input = *info.pVertexInputState;
    add(key, input.pVertexBindingDescriptions, input.vertexBindingDescriptionCount);
    add(key, input.pVertexAttributeDescriptions, input.vertexAttributeDescriptionCount);
    return key;
}

} // namespace sconce::testing_support
