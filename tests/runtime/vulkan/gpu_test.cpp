#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/vulkan/gpu.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using testing_support::ValidatedDevice;

TEST(Gpu, UploadedBytesComeBackAcrossStagingPieces)
{
    ValidatedDevice device;
    Gpu& gpu = device.gpu();
    std::vector<uint32_t> values((size_t(20) << 20) / 4); // more than one staging piece
    std::iota(values.begin(), values.end(), 7u);
    auto buffer = gpu.makeBufferWith<uint32_t>(values, 0, "test values");
    ASSERT_TRUE(buffer) << buffer.error().message;
    EXPECT_NE(buffer->address(), 0u);
    std::vector<uint32_t> back(values.size());
    const auto status = gpu.download(*buffer, 0, std::as_writable_bytes(std::span(back)));
    ASSERT_TRUE(status) << status.error().message;
    EXPECT_EQ(back, values);
}

TEST(GpuTimer, NamesItsScopes)
{
    ValidatedDevice device;
    Gpu& gpu = device.gpu();
    auto timer = GpuTimer::create(gpu, 2);
    auto buffer = gpu.makeBuffer(VkDeviceSize(8) << 20, 0, MemoryUse::device, "filled");
    ASSERT_TRUE(timer && buffer);
    const auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            timer->begin(cmd, "fill");
            gpu.vk.CmdFillBuffer(cmd, buffer->handle(), 0, VK_WHOLE_SIZE, 5);
            timer->end(cmd);
        });
    ASSERT_TRUE(status);
    if (!gpu.timestamps) GTEST_SKIP() << "the queue has no timestamps";
    ASSERT_EQ(timer->read().size(), 1u);
    EXPECT_STREQ(timer->read()[0].name, "fill");
    EXPECT_GT(timer->read()[0].milliseconds, 0.0);
}

// What a host's function of a name is replaced by: notes the cache that a pipeline is made with.
PFN_vkGetDeviceProcAddr ofDriver = nullptr;
PFN_vkCreateComputePipelines makePipelines = nullptr;
std::vector<VkPipelineCache> cachesAsked;

VKAPI_ATTR VkResult VKAPI_CALL noteCache(VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo* infos,
                                         const VkAllocationCallbacks* callbacks, VkPipeline* made)
{
    cachesAsked.push_back(cache);
    return makePipelines(device, cache, count, infos, callbacks, made);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction real = ofDriver(device, name);
    if (std::strcmp(name, "vkCreateComputePipelines") != 0) return real;
    makePipelines = reinterpret_cast<PFN_vkCreateComputePipelines>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(noteCache);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name)
{
    const PFN_vkVoidFunction real = vkGetInstanceProcAddr(instance, name);
    if (std::strcmp(name, "vkGetDeviceProcAddr") != 0) return real;
    ofDriver = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
}

TEST(Gpu, PipelinesAreMadeWithTheHostsCache)
{
    ValidatedDevice device;
    const Gpu& plain = device.gpu();
    const auto create = reinterpret_cast<PFN_vkCreatePipelineCache>(vkGetInstanceProcAddr(plain.host.instance, "vkCreatePipelineCache"));
    const auto destroy = reinterpret_cast<PFN_vkDestroyPipelineCache>(vkGetInstanceProcAddr(plain.host.instance, "vkDestroyPipelineCache"));
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    HostVulkan host = device.host();
    ASSERT_EQ(create(host.device, &info, nullptr, &host.pipelineCache), VK_SUCCESS);
    host.getInstanceProcAddr = instanceFunction;
    setenv("SCONCE_NAN_SCAN", "1", 1); // a pass that is made with the device
    cachesAsked.clear();
    EXPECT_TRUE(Gpu::create(host));
    unsetenv("SCONCE_NAN_SCAN");
    EXPECT_EQ(cachesAsked, std::vector{host.pipelineCache});
    destroy(host.device, host.pipelineCache, nullptr);
}

} // namespace
} // namespace sconce
