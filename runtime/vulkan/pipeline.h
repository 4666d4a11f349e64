#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "runtime/vulkan/gpu.h"

namespace sconce
{

/// One descriptor set with its pool. Write before it is first bound; the written resources must outlive its use.
class DescriptorSet
{
public:
    struct Binding
    {
        uint32_t binding;
        VkDescriptorType type;
        VkShaderStageFlags stages = VK_SHADER_STAGE_ALL;
    };
    static Result<DescriptorSet> create(Gpu& gpu, std::span<const Binding> bindings);

    VkDescriptorSetLayout layout() const { return setLayout; } // the Gpu's, of all sets with these bindings
    VkDescriptorSet handle() const { return set; }
    void write(uint32_t binding, const Buffer& buffer); // a texel buffer by its view
    void write(uint32_t binding, VkImageView view, VkImageLayout imageLayout, VkSampler sampler = VK_NULL_HANDLE);

private:
    VkDescriptorType typeOf(uint32_t binding) const;
    Gpu* gpu = nullptr;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    Handle<VkDescriptorPool, &VulkanFunctions::DestroyDescriptorPool> pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<Binding> bindings;
};

using Spirv = std::span<const uint32_t>;

/// The value of a shader's specialisation constant.
struct ShaderConstant
{
    uint32_t id;
    uint32_t value; // or the bits of a float
};

inline constexpr uint32_t kMostWorkgroups = 65535; // along an axis, that every device dispatches

/// Of a pass over so many invocations: its shader goes on by strides where they are too many for one row.
constexpr uint32_t workgroupsInARow(uint64_t invocations, uint32_t group)
{
    return uint32_t(std::min<uint64_t>((invocations + group - 1) / group, kMostWorkgroups));
}

/// A compute or graphics pipeline with its layout.
class Pipeline
{
public:
    /// One for all that is made alike on a Gpu: making it again, as for a window of another size, asks no compiler.
    /// @param constants  those with an id that the shader lacks change nothing
    static Result<Pipeline> compute(Gpu& gpu, Spirv shader, std::span<const VkDescriptorSetLayout> sets, uint32_t pushBytes,
                                    std::span<const ShaderConstant> constants = {}, VkPipelineCreateFlags flags = 0);

    struct Graphics
    {
        Spirv vertex;
        Spirv fragment; // empty: depth only
        std::span<const VkDescriptorSetLayout> sets;
        uint32_t pushBytes = 0;
        std::span<const VkVertexInputBindingDescription> vertexBindings;
        std::span<const VkVertexInputAttributeDescription> vertexAttributes;
        std::span<const VkFormat> colorFormats;
        VkFormat depthFormat = VK_FORMAT_UNDEFINED;
        VkCompareOp depthCompare = VK_COMPARE_OP_GREATER; // depth 0 is infinitely far
        std::span<const ShaderConstant> constants;        // of both stages
    };
    static Result<Pipeline> graphics(Gpu& gpu, const Graphics& desc);

    VkPipeline handle() const { return made->pipeline.get(); }
    VkPipelineLayout layout() const { return made->layout.get(); }
    explicit operator bool() const { return bool(made); }

    void bind(VkCommandBuffer cmd, std::span<const VkDescriptorSet> sets = {}) const;
    template <class T> void push(VkCommandBuffer cmd, const T& values) const
    {
        static_assert(sizeof(T) % 4 == 0 && sizeof(T) <= 128, "push constants are at most 128 bytes everywhere");
        gpu->vk.CmdPushConstants(cmd, layout(), stages, 0, sizeof(T), &values);
    }

private:
    struct Made
    {
        Handle<VkPipelineLayout, &VulkanFunctions::DestroyPipelineLayout> layout;
        Handle<VkPipeline, &VulkanFunctions::DestroyPipeline> pipeline;
    };
    static Status makeLayout(const Gpu& gpu, Made& of, VkShaderStageFlags stages, std::span<const VkDescriptorSetLayout> sets,
                             uint32_t pushBytes);
    Gpu* gpu = nullptr;
    std::shared_ptr<const Made> made;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    VkShaderStageFlags stages = 0;
};

/// A sampler; move-only.
class Sampler
{
public:
    static Result<Sampler> create(Gpu& gpu, const VkSamplerCreateInfo& info);
    VkSampler handle() const { return sampler.get(); }

private:
    Handle<VkSampler, &VulkanFunctions::DestroySampler> sampler;
};

} // namespace sconce
