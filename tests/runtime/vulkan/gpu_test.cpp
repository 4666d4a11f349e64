#include <numeric>

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

TEST(Gpu, MemoryIsGivenBackWhenResourcesGo)
{
    ValidatedDevice device;
    Gpu& gpu = device.gpu();
    const uint64_t before = gpu.memory().used();
    {
        std::vector<Buffer> many;
        for (int i = 1; i < 40; ++i)
        {
            auto buffer = gpu.makeBuffer(VkDeviceSize(i) * 100'000, 0, MemoryUse::device, "piece");
            ASSERT_TRUE(buffer);
            many.push_back(std::move(*buffer));
            if (i % 3 == 0) many.erase(many.begin()); // leaves holes that later pieces may take
        }
        EXPECT_GT(gpu.memory().used(), before);
    }
    EXPECT_EQ(gpu.memory().used(), before);
    EXPECT_GT(gpu.memory().peak(), before);
}

TEST(Gpu, BudgetRefusesWithTheNumbers)
{
    ValidatedDevice device(uint64_t(32) << 20);
    const auto refused = device.gpu().makeBuffer(VkDeviceSize(40) << 20, 0, MemoryUse::device, "The test buffer");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::outOfMemory);
    for (const char* part : {"The test buffer", "40 MiB", "32 MiB", "budget"})
        EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    EXPECT_TRUE(device.gpu().makeBuffer(VkDeviceSize(1) << 20, 0, MemoryUse::device, "small")); // a block of 64 MiB isn't forced on it
}

TEST(Gpu, HostsAllocatorIsAsked)
{
    unsetenv("SCONCE_NAN_SCAN"); // takes memory of its own
    ValidatedDevice device;
    HostVulkan host = device.host();
    int calls = 0;
    host.allocateMemory = [&](const VkMemoryAllocateInfo&, VkDeviceMemory&)
    {
        ++calls;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    };
    auto gpu = Gpu::create(host);
    ASSERT_TRUE(gpu);
    const auto refused = (*gpu)->makeBuffer(1024, 0, MemoryUse::device, "a buffer");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::outOfMemory);
    EXPECT_EQ(calls, 1);
}

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

} // namespace
} // namespace sconce
