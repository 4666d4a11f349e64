#include "bench/gpu/spirv_interface.h"

#include <cstring>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "shaders/shared/field_passes.h"

namespace sconce
{
namespace
{

std::vector<uint32_t> pass(const std::string& name)
{
    std::ifstream in(SCONCE_SPIRV_FOLDER "/" + name + ".spv", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<uint32_t> code(bytes.size() / 4);
    std::memcpy(code.data(), bytes.data(), 4 * code.size());
    return code;
}

/// The kind that a binding has; VK_DESCRIPTOR_TYPE_MAX_ENUM where it isn't there.
VkDescriptorType kindOf(const SpirvInterface& made, uint32_t set, uint32_t binding)
{
    for (const SpirvInterface::Binding& one : made.bindings)
        if (one.set == set && one.binding == binding) return one.type;
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

TEST(SpirvInterface, IsWhatTheTextOfTheTracerDeclares)
{
    const auto made = spirvInterface(pass("trace_rays_comp"));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made->pushes);
    EXPECT_EQ(kindOf(*made, 0, gpu::kFieldBlockBinding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
    EXPECT_EQ(kindOf(*made, 0, gpu::kFieldOctreeBinding), VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
    EXPECT_EQ(kindOf(*made, 0, gpu::kFieldDistanceBinding), VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
    EXPECT_EQ(made->bindings.front().binding, gpu::kFieldBlockBinding) << "in their order";
}

TEST(SpirvInterface, KnowsImagesAndBuffersThatAreWritten)
{
    const auto made = spirvInterface(pass("trace_glossy_comp"));
    ASSERT_TRUE(made) << made.error().message;
    size_t images = 0, buffers = 0;
    for (const SpirvInterface::Binding& one : made->bindings)
    {
        images += one.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        buffers += one.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    EXPECT_EQ(images, 3u) << "light, counts and packed pixels";
    EXPECT_GE(buffers, 1u) << "the tiles";
}

TEST(SpirvInterface, RefusesWhatIsNoComputePass)
{
    EXPECT_EQ(spirvInterface(pass("gbuffer_frag")).error().code, ErrorCode::badInput);
    EXPECT_EQ(spirvInterface({}).error().code, ErrorCode::badInput);
    std::vector<uint32_t> code = pass("trace_rays_comp");
    ASSERT_GT(code.size(), 100u);
    const std::vector<uint32_t> other(code.size(), 0x12345678u);
    EXPECT_EQ(spirvInterface(other).error().code, ErrorCode::badInput);
    // Cut anywhere it is an interface of less, or a sentence; never a read beyond its end.
    for (size_t words = 5; words < code.size(); words += 97)
    {
        const auto made = spirvInterface(std::span(code).first(words));
        if (!made)
        {
            EXPECT_EQ(made.error().code, ErrorCode::badInput);
        }
    }
    // A word that says its instruction is longer than what is left.
    code[5] |= 0xffff0000u;
    EXPECT_EQ(spirvInterface(code).error().code, ErrorCode::badInput);
}

} // namespace
} // namespace sconce
