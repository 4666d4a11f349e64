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

// What is more than it was made for, or comes without a reset, is left out, and nothing is written beyond what it holds.
TEST(GpuTimer, LeavesOutWhatItHasNoRoomFor)
{
    ValidatedDevice device;
    Gpu& gpu = device.gpu();
    const auto none = GpuTimer::create(gpu, 0);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::badArgument);
    auto timer = GpuTimer::create(gpu, 2);
    ASSERT_TRUE(timer);
    ASSERT_TRUE(gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            timer->reset(cmd);
            for (const char* name : {"one", "two", "three", "four"})
            {
                timer->begin(cmd, name);
                timer->end(cmd);
            }
        }));
    if (!gpu.timestamps) GTEST_SKIP() << "the queue has no timestamps";
    ASSERT_EQ(timer->read().size(), 2u);
    EXPECT_STREQ(timer->read()[1].name, "two");
}

TEST(Gpu, RefusesAFamilyThatItCannotUse)
{
    ValidatedDevice device;
    HostVulkan host = device.host();
    host.queueFamily = 99;
    const auto made = Gpu::create(host);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, ErrorCode::badArgument);
    EXPECT_NE(made.error().message.find("queueFamily is 99"), std::string::npos);
}

} // namespace
} // namespace sconce
