#include "runtime/vulkan/host_vulkan.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(OwnDevice, UnknownNameListsTheDevices)
{
    OwnDevice::Desc desc;
    desc.device = "no such device";
    const auto refused = OwnDevice::create(desc);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    EXPECT_NE(refused.error().message.find("no such device"), std::string::npos);
    const auto all = deviceSummary();
    ASSERT_TRUE(all) << all.error().message;
    ASSERT_FALSE(all->empty());
    EXPECT_NE(refused.error().message.find(all->front().name), std::string::npos);
}

/// What a host has switched on stays, and nothing else is.
TEST(RequireFeatures, AddsToWhatTheHostHas)
{
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};
    v13.pNext = &v12;
    v12.descriptorIndexing = v13.maintenance4 = VK_TRUE;
    requireFeatures(v12, v13);
    EXPECT_TRUE(v12.descriptorIndexing && v12.bufferDeviceAddress && v12.scalarBlockLayout);
    EXPECT_TRUE(v13.maintenance4 && v13.dynamicRendering && v13.synchronization2);
    EXPECT_FALSE(v12.shaderFloat16 || v13.robustImageAccess);
    EXPECT_EQ(v13.pNext, &v12);
}

TEST(OwnDevice, IsOneThatLacksNothing)
{
    const auto own = OwnDevice::create();
    ASSERT_TRUE(own) << own.error().message;
    const HostVulkan& host = own->host();
    EXPECT_EQ(missingFeatures(host.getInstanceProcAddr, host.instance, host.physicalDevice), std::vector<std::string>());
    const auto all = deviceSummary();
    ASSERT_TRUE(all) << all.error().message;
    const auto found = std::ranges::find(*all, own->name(), &DeviceSummary::name);
    ASSERT_NE(found, all->end());
    EXPECT_TRUE(found->missing.empty());
    EXPECT_GT(found->heapBytes, 0u);
    EXPECT_GE(found->maxImageSize2D, 4096u); // what Vulkan 1.3 promises, as the next
    EXPECT_GE(found->maxImageLayers, 256u);
    EXPECT_GE(found->maxStorageBuffer, uint64_t(1) << 27);
}

} // namespace
} // namespace sconce
