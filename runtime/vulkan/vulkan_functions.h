#pragma once

#include <vulkan/vulkan.h>

namespace sconce
{

// Device functions the library calls, each loaded through the host's own vkGetInstanceProcAddr so that layers, fault injection and
// several devices in one process all work.
#define SCONCE_DEVICE_FUNCTIONS(X)                                                                                                         \
    X(AllocateCommandBuffers)                                                                                                              \
    X(AllocateDescriptorSets)                                                                                                              \
    X(AllocateMemory)                                                                                                                      \
    X(BeginCommandBuffer)                                                                                                                  \
    X(BindBufferMemory)                                                                                                                    \
    X(BindImageMemory)                                                                                                                     \
    X(CmdBeginRendering)                                                                                                                   \
    X(CmdBindDescriptorSets)                                                                                                               \
    X(CmdBindIndexBuffer)                                                                                                                  \
    X(CmdBindPipeline)                                                                                                                     \
    X(CmdBindVertexBuffers)                                                                                                                \
    X(CmdBlitImage)                                                                                                                        \
    X(CmdClearColorImage)                                                                                                                  \
    X(CmdCopyBuffer)                                                                                                                       \
    X(CmdCopyBufferToImage)                                                                                                                \
    X(CmdCopyImageToBuffer)                                                                                                                \
    X(CmdDispatch)                                                                                                                         \
    X(CmdDispatchBase)                                                                                                                     \
    X(CmdDispatchIndirect)                                                                                                                 \
    X(CmdDraw)                                                                                                                             \
    X(CmdDrawIndexed)                                                                                                                      \
    X(CmdEndRendering)                                                                                                                     \
    X(CmdFillBuffer)                                                                                                                       \
    X(CmdPipelineBarrier2)                                                                                                                 \
    X(CmdPushConstants)                                                                                                                    \
    X(CmdResetQueryPool)                                                                                                                   \
    X(CmdSetCullMode)                                                                                                                      \
    X(CmdSetScissor)                                                                                                                       \
    X(CmdSetViewport)                                                                                                                      \
    X(CmdUpdateBuffer)                                                                                                                     \
    X(CmdWriteTimestamp2)                                                                                                                  \
    X(CreateBuffer)                                                                                                                        \
    X(CreateBufferView)                                                                                                                    \
    X(CreateCommandPool)                                                                                                                   \
    X(CreateComputePipelines)                                                                                                              \
    X(CreateDescriptorPool)                                                                                                                \
    X(CreateDescriptorSetLayout)                                                                                                           \
    X(CreateFence)                                                                                                                         \
    X(CreateGraphicsPipelines)                                                                                                             \
    X(CreateImage)                                                                                                                         \
    X(CreateImageView)                                                                                                                     \
    X(CreatePipelineLayout)                                                                                                                \
    X(CreateQueryPool)                                                                                                                     \
    X(CreateSampler)                                                                                                                       \
    X(CreateShaderModule)                                                                                                                  \
    X(DestroyBuffer)                                                                                                                       \
    X(DestroyBufferView)                                                                                                                   \
    X(DestroyCommandPool)                                                                                                                  \
    X(DestroyDescriptorPool)                                                                                                               \
    X(DestroyDescriptorSetLayout)                                                                                                          \
    X(DestroyFence)                                                                                                                        \
    X(DestroyImage)                                                                                                                        \
    X(DestroyImageView)                                                                                                                    \
    X(DestroyPipeline)                                                                                                                     \
    X(DestroyPipelineLayout)                                                                                                               \
    X(DestroyQueryPool)                                                                                                                    \
    X(DestroySampler)                                                                                                                      \
    X(DestroyShaderModule)                                                                                                                 \
    X(DeviceWaitIdle)                                                                                                                      \
    X(EndCommandBuffer)                                                                                                                    \
    X(FreeMemory)                                                                                                                          \
    X(GetBufferDeviceAddress)                                                                                                              \
    X(GetBufferMemoryRequirements)                                                                                                         \
    X(GetImageMemoryRequirements)                                                                                                          \
    X(GetQueryPoolResults)                                                                                                                 \
    X(MapMemory)                                                                                                                           \
    X(QueueSubmit)                                                                                                                         \
    X(ResetCommandPool)                                                                                                                    \
    X(ResetFences)                                                                                                                         \
    X(UpdateDescriptorSets)                                                                                                                \
    X(WaitForFences)

struct VulkanFunctions
{
#define SCONCE_MEMBER(name) PFN_vk##name name = nullptr;
    SCONCE_DEVICE_FUNCTIONS(SCONCE_MEMBER)
#undef SCONCE_MEMBER
};

} // namespace sconce
