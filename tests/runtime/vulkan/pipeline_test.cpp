#include "runtime/vulkan/pipeline.h"

#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/field/light_field.h"
#include "tests/support/device.h"
#include "tests/support/small_field.h"

namespace sconce
{
namespace
{

using testing_support::ValidatedDevice;

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

/// A host that notes the pipelines that are made.
HostVulkan notingHost(ValidatedDevice& device)
{
    HostVulkan host = device.host();
    host.getInstanceProcAddr = instanceFunction;
    cachesAsked.clear();
    return host;
}

TEST(Pipeline, IsMadeWithTheHostsCache)
{
    ValidatedDevice device;
    const Gpu& plain = device.gpu();
    const auto create = reinterpret_cast<PFN_vkCreatePipelineCache>(vkGetInstanceProcAddr(plain.host.instance, "vkCreatePipelineCache"));
    const auto destroy = reinterpret_cast<PFN_vkDestroyPipelineCache>(vkGetInstanceProcAddr(plain.host.instance, "vkDestroyPipelineCache"));
    const VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO, nullptr, 0, 0, nullptr};
    HostVulkan host = notingHost(device);
    ASSERT_EQ(create(host.device, &info, nullptr, &host.pipelineCache), VK_SUCCESS);
    setenv("SCONCE_NAN_SCAN", "1", 1); // a pass that is made with the device
    EXPECT_TRUE(Gpu::create(host));
    unsetenv("SCONCE_NAN_SCAN");
    EXPECT_EQ(cachesAsked, std::vector{host.pipelineCache});
    destroy(host.device, host.pipelineCache, nullptr);
}

// A window of another size, a second view, the next field: all want the passes that were there a moment before.
TEST(Pipeline, IsMadeOnceForAllThatIsAskedForAlike)
{
    ValidatedDevice device;
    const auto gpu = Gpu::create(notingHost(device));
    ASSERT_TRUE(gpu) << gpu.error().message;
    const gpu::Ray ray{{0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    std::vector<gpu::RayHit> first(1), again(1), other(1);
    const auto tracedBy = [&](int order, std::vector<gpu::RayHit>& hits)
    {
        Quality quality;
        quality.trace.order = order;
        const auto field = makeLightField(**gpu, testing_support::smallField(), quality);
        ASSERT_TRUE(field) << field.error().message;
        const auto tracer = makeRayTracer(**gpu, *field);
        ASSERT_TRUE(tracer) << tracer.error().message;
        const auto status = tracer->trace(std::span(&ray, 1), hits);
        ASSERT_TRUE(status) << status.error().message;
    };
    tracedBy(gpu::kOrderRanked, first);
    const size_t made = cachesAsked.size();
    EXPECT_GT(made, 0u);
    tracedBy(gpu::kOrderRanked, again);
    EXPECT_EQ(cachesAsked.size(), made) << "the same pass, of a field that has gone since";
    EXPECT_EQ(std::memcmp(first.data(), again.data(), sizeof(gpu::RayHit)), 0);
    tracedBy(gpu::kOrderNearestLine, other);
    EXPECT_EQ(cachesAsked.size(), made + 1) << "another constant, another pass";
}

// A thread that loads fields and one that draws them ask for the same passes, and either may be gone before the other.
TEST(Pipeline, IsMadeOnceForAllThreads)
{
    ValidatedDevice device;
    auto first = *Gpu::create(notingHost(device));
    auto other = *first->forThread();
    const std::vector<VkDescriptorSetLayoutBinding> bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr}};
    EXPECT_EQ(*first->setLayout(bindings), *other->setLayout(bindings));
    EXPECT_EQ(&first->memory(), &other->memory());
    const gpu::Ray ray{{0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    std::vector<gpu::RayHit> hits(1);
    std::optional<LightField> field = *makeLightField(*first, testing_support::smallField());
    ASSERT_TRUE(makeRayTracer(*other, *field)->trace(std::span(&ray, 1), hits));
    const size_t made = cachesAsked.size();
    EXPECT_GT(made, 0u);
    ASSERT_TRUE(makeRayTracer(*first, *field)->trace(std::span(&ray, 1), hits));
    EXPECT_EQ(cachesAsked.size(), made);
    first.reset();
    ASSERT_TRUE(makeRayTracer(*other, *field)->trace(std::span(&ray, 1), hits));
    EXPECT_EQ(cachesAsked.size(), made);
}

} // namespace
} // namespace sconce
