#pragma once

#include <map>
#include <optional>
#include <string>

#include <vulkan/vulkan.h>

namespace sconce::testing_support
{

/// Pipelines that live on after their owner has destroyed them, for whoever makes the same again: what takes a software driver most of the
/// time of small work is to compile.
class KeptPipelines
{
public:
    void note(const VkShaderModuleCreateInfo& info, VkShaderModule made);
    void note(const VkDescriptorSetLayoutCreateInfo& info, VkDescriptorSetLayout made);
    void note(const VkPipelineLayoutCreateInfo& info, VkPipelineLayout made);
    /// All that a pipeline is made of.
    std::string keyOf(const VkComputePipelineCreateInfo& info) const;
    std::string keyOf(const VkGraphicsPipelineCreateInfo& info) const; // of those that Pipeline::graphics() makes

    std::map<std::string, VkPipeline> kept;

private:
    std::string keyOf(const VkPipelineShaderStageCreateInfo& stage) const;
    std::map<VkShaderModule, std::string> modules;
    std::map<VkDescriptorSetLayout, std::string> sets;
    std::map<VkPipelineLayout, std::string> layouts;
};

} // namespace sconce::testing_support
