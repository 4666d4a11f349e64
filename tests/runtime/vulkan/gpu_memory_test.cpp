#include "runtime/vulkan/gpu_memory.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "runtime/vulkan/gpu.h"
#include "tests/support/device.h"

namespace sconce
{
namespace
{

using testing_support::ValidatedDevice;

constexpr uint64_t kMiB = uint64_t(1) << 20;

TEST(GpuMemory, IsGivenBackWhenResourcesGo)
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

TEST(GpuMemory, BudgetRefusesWithTheNumbers)
{
    ValidatedDevice device(uint64_t(32) << 20);
    const auto refused = device.gpu().makeBuffer(VkDeviceSize(40) << 20, 0, MemoryUse::device, "The test buffer");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::outOfMemory);
    for (const char* part : {"The test buffer", "40 MiB", "32 MiB", "budget"})
        EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    EXPECT_TRUE(device.gpu().makeBuffer(VkDeviceSize(1) << 20, 0, MemoryUse::device, "small")); // a block of 64 MiB isn't forced on it
}

TEST(GpuMemory, HostsAllocatorIsAsked)
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

struct Held
{
    GpuMemory::Piece piece;
    VkMemoryRequirements needs;
    bool linear;
};

// Thousands of pieces taken and given back in any order: within the budget always, aligned, apart from one another, and all given back.
TEST(GpuMemory, AnyOrderKeepsTheBudgetAndKeepsPiecesApart)
{
    ValidatedDevice device(300 * kMiB);
    GpuMemory memory(device.host(), device.gpu().vk);
    ASSERT_EQ(memory.budget(), 300 * kMiB);
    std::vector<Held> held;
    std::mt19937_64 random(11);
    size_t refusals = 0;
    for (int step = 0; step < 4000; ++step)
    {
        if (!held.empty() && random() % (step / 500 % 2 ? 2 : 3) == 0) // mostly growing, then steady, and again
        {
            const size_t gone = random() % held.size();
            memory.release(held[gone].piece);
            EXPECT_EQ(held[gone].piece.block, nullptr);
            held.erase(held.begin() + ptrdiff_t(gone));
            continue;
        }
        Held next{{}, {1 + random() % (random() % 20 == 0 ? 40 * kMiB : kMiB), VkDeviceSize(1) << random() % 13, ~0u}, random() % 2 == 0};
        auto made = memory.allocate(next.needs, random() % 3 == 0 ? MemoryUse::upload : MemoryUse::device, next.linear, "a piece");
        ASSERT_LE(memory.used(), memory.budget());
        ASSERT_LE(memory.used(), memory.peak());
        if (!made)
        {
            EXPECT_EQ(made.error().code, ErrorCode::outOfMemory);
            ++refusals;
            continue;
        }
        next.piece = *made;
        ASSERT_EQ(next.piece.offset % next.needs.alignment, 0u);
        ASSERT_EQ(next.piece.size, next.needs.size);
        for (const Held& other : held)
            if (other.piece.memory() == next.piece.memory())
            {
                ASSERT_TRUE(other.piece.offset + other.piece.size <= next.piece.offset ||
                            next.piece.offset + next.piece.size <= other.piece.offset);
                ASSERT_EQ(other.linear, next.linear) << "buffers and images share no block";
            }
        held.push_back(next);
    }
    EXPECT_GT(refusals, 10u) << "the budget was never reached";
    EXPECT_GT(memory.peak(), 250 * kMiB);
    std::ranges::shuffle(held, random);
    for (Held& one : held) memory.release(one.piece);
    EXPECT_EQ(memory.used(), 0u);
}

TEST(GpuMemory, MappedPiecesHoldWhatWasWritten)
{
    ValidatedDevice device;
    GpuMemory memory(device.host(), device.gpu().vk);
    std::vector<GpuMemory::Piece> pieces;
    for (size_t i = 0; i < 50; ++i)
    {
        auto made = memory.allocate({1000 + 37 * i, 16, ~0u}, i % 2 ? MemoryUse::upload : MemoryUse::readback, true, "a piece");
        ASSERT_TRUE(made);
        ASSERT_NE(made->mapped(), nullptr);
        std::fill_n(made->mapped(), made->size, std::byte(i));
        pieces.push_back(*made);
    }
    for (size_t i = 0; i < 50; ++i)
        EXPECT_EQ(size_t(std::count(pieces[i].mapped(), pieces[i].mapped() + pieces[i].size, std::byte(i))), pieces[i].size) << i;
    for (GpuMemory::Piece& piece : pieces) memory.release(piece);
    auto unmapped = memory.allocate({1000, 16, ~0u}, MemoryUse::device, true, "a piece");
    ASSERT_TRUE(unmapped);
    EXPECT_EQ(unmapped->mapped(), nullptr);
    memory.release(*unmapped);
    memory.release(*unmapped); // an empty piece is nothing to give back
    EXPECT_EQ(memory.used(), 0u);
}

TEST(GpuMemory, ADeviceWithoutTheMemoryTypeIsNamed)
{
    ValidatedDevice device;
    GpuMemory memory(device.host(), device.gpu().vk);
    const auto refused = memory.allocate({1000, 16, 0}, MemoryUse::device, true, "the test buffer");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::missingFeature);
    EXPECT_NE(refused.error().message.find("the test buffer"), std::string::npos);
}

} // namespace
} // namespace sconce
