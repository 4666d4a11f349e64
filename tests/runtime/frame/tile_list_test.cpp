#include "runtime/frame/tile_list.h"

#include <gtest/gtest.h>

#include "tests/support/device.h"

namespace sconce
{
namespace
{

// A device binds at most so much of a buffer; beyond it reads give 0, and pixels were black.
TEST(TileListTest, ListsThatADeviceCannotBindAreRefused)
{
    testing_support::ValidatedDevice owner;
    Gpu& gpu = owner.gpu();
    auto frame = gpu.makeBuffer(sizeof(gpu::FrameView), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, MemoryUse::device, "frame");
    ASSERT_TRUE(frame) << frame.error().message;
    TileList::Desc desc{.width = 256, .height = 144};
    desc.lookUps = {{1, gpu::kLookUpsPerPixel}};
    const auto small = TileList::create(gpu, *frame, desc);
    ASSERT_TRUE(small) << small.error().message;
    gpu.properties.limits.maxStorageBufferRange = uint32_t(small->buffer().size());
    EXPECT_TRUE(TileList::create(gpu, *frame, desc)) << "as much as the device binds";
    desc.height += gpu::kTileSide;
    const auto refused = TileList::create(gpu, *frame, desc);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::badArgument);
    for (const std::string& part : {"256 x " + std::to_string(desc.height), std::to_string(small->buffer().size()), std::string("smaller")})
        EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
}

} // namespace
} // namespace sconce
