// Maps in blocks: a sampler that isn't ours reads radiance alike, and what both lose is small.
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "runtime/field/distance_block.h"
#include "runtime/field/light_field.h"
#include "runtime/field/map_blocks.h"
#include "runtime/field/radiance_block.h"
#include "runtime/field/tracer_cpu.h"
#include "shaders/shared/field_passes.h"
#include "shaders/shared/pure.h"
#include "tests/support/chain_bounds.h"
#include "tests/support/cornell_field.h"
#include "tests/support/device.h"
#include "tests/support/small_field.h"

namespace sconce
{
namespace
{

using namespace testing_support;
using Text = Pure<float>;

using Block = std::array<uint32_t, 4>;

vec3 texelOf(const Block& block, uint32_t texel)
{
    return Text::blockRadiance({block[0], block[1], block[2], block[3]}, texel);
}

/// A picture of so many blocks a side, as the driver's blit decodes BC6H: four floats a texel. The device of its own isn't validated, for
/// the feature textureCompressionBC, which only this asks for, isn't enabled on it.
std::vector<float> decodedByTheDriver(std::span<const Block> blocks, uint32_t side)
{
    auto own = OwnDevice::create({});
    if (!own) throw std::runtime_error(own.error().message);
    auto gpu = Gpu::create(own->host());
    if (!gpu) throw std::runtime_error(gpu.error().message);
    const uint32_t size = side * Text::kBlockSide;
    const auto words = (*gpu)->makeBufferWith<Block>(blocks, 0, "blocks");
    const auto packed = (*gpu)->makeImage({.format = VK_FORMAT_BC6H_UFLOAT_BLOCK,
                                           .width = size,
                                           .height = size,
                                           .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                                          "blocks' image");
    const auto plain = (*gpu)->makeImage({.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                          .width = size,
                                          .height = size,
                                          .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                                         "their texels");
    std::vector<float> texels(size_t(4) * size * size);
    const auto out = (*gpu)->makeBuffer(texels.size() * sizeof(float), 0, MemoryUse::device, "read back");
    if (!words || !packed || !plain || !out) throw std::runtime_error("the driver made no image of blocks");
    const auto recorded = (*gpu)->submit(
        [&](VkCommandBuffer cmd)
        {
            const VulkanFunctions& vk = (*gpu)->vk;
            const ImageTransition any{VK_IMAGE_LAYOUT_UNDEFINED,
                                      VK_IMAGE_LAYOUT_GENERAL,
                                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                      VK_ACCESS_2_MEMORY_WRITE_BIT,
                                      VK_ACCESS_2_MEMORY_WRITE_BIT};
            const auto then = [&]
            {
                memoryBarrier(**gpu, cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                              VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
            };
            transition(**gpu, cmd, *packed, any);
            transition(**gpu, cmd, *plain, any);
            VkBufferImageCopy copy{};
            copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            copy.imageExtent = {size, size, 1};
            vk.CmdCopyBufferToImage(cmd, words->handle(), packed->handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
            then();
            VkImageBlit blit{};
            blit.srcSubresource = blit.dstSubresource = copy.imageSubresource;
            blit.srcOffsets[1] = blit.dstOffsets[1] = {int32_t(size), int32_t(size), 1};
            vk.CmdBlitImage(cmd, packed->handle(), VK_IMAGE_LAYOUT_GENERAL, plain->handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &blit,
                            VK_FILTER_NEAREST);
            then();
            vk.CmdCopyImageToBuffer(cmd, plain->handle(), VK_IMAGE_LAYOUT_GENERAL, out->handle(), 1, &copy);
            then();
        });
    if (!recorded || !(*gpu)->download(*out, 0, std::as_writable_bytes(std::span(texels)))) throw std::runtime_error("the blit failed");
    return texels;
}

/// Seven probes' faces with a gradient of light over each, brighter by four orders of magnitude on one than on the next.
FieldData shadedCornell()
{
    FieldData field = cornell().field;
    const uint32_t size = field.info.faceSize;
    for (size_t i = 0; i < field.radiance.size(); ++i)
    {
        const float x = float(i % size) / float(size), y = float(i / size % size) / float(size);
        const float level = std::exp2(float(i / (size * size) % 6) * 2.5f - 10.0f);
        field.radiance[i] = Text::packRadianceDithered(level * vec3(0.2f + x, 0.3f + y * y, 1.2f - x * y), Text::ditherOf(uint32_t(i)));
    }
    return field;
}

TEST(RadianceBlocks, ADriversSamplerReadsThemAlike)
{
    constexpr uint32_t kSide = 32;
    std::mt19937 random(3);
    std::vector<Block> blocks(size_t(kSide) * kSide);
    for (Block& block : blocks)
    {
        for (uint32_t& word : block) word = uint32_t(random());
        block[0] = (block[0] & ~31u) | Text::kBlockMode;
    }
    blocks[0] = {0xffffffe0u | Text::kBlockMode, ~0u, ~0u, ~0u}; // the largest endpoints
    blocks[1] = {Text::kBlockMode, 0, 0, 0};
    const std::vector<float> driver = decodedByTheDriver(blocks, kSide);
    const uint32_t size = kSide * Text::kBlockSide;
    for (uint32_t i = 0; i < size * size; ++i)
    {
        const uint32_t x = i % size, y = i / size;
        const vec3 ours = texelOf(blocks[y / 4 * kSide + x / 4], y % 4 * 4 + x % 4);
        for (int c = 0; c < 3; ++c) ASSERT_EQ(ours[c], driver[4 * i + size_t(c)]) << "texel " << x << ", " << y << ", channel " << c;
    }
}

// Endpoints stand 3 % apart, and three channels share the 16 colours between two of them.
TEST(RadianceBlocks, FlatLightIsKeptWithinHalfAPercent)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anyLog(-12.0f, 14.0f), share(0.05f, 1.0f);
    double worst = 0.0, squares = 0.0;
    constexpr int kTried = 2000;
    for (int i = 0; i < kTried; ++i)
    {
        const vec3 light = std::exp2(anyLog(random)) * vec3(share(random), share(random), share(random));
        std::array<vec3, 16> texels;
        texels.fill(light);
        const vec3 got = texelOf(radianceBlockOf(texels, 0xffffu), 9);
        const double error = double(glm::length(got - light) / glm::length(light));
        worst = std::max(worst, error), squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / kTried), 0.0015);
    EXPECT_LT(worst, 0.005);
}

TEST(RadianceBlocks, WhatIsNotReadCountsForNothing)
{
    std::array<vec3, 16> texels;
    texels.fill(vec3(1000.0f, 0.0f, 5.0f));
    texels[6] = vec3(0.5f, 0.25f, 0.125f);
    const Block block = radianceBlockOf(texels, 1u << 6);
    EXPECT_LT(glm::length(texelOf(block, 6) - texels[6]), 0.01f * glm::length(texels[6]));
    EXPECT_EQ(texelOf(radianceBlockOf(texels, 0), 6), vec3(0.0f));
}

TEST(RadianceBlocks, OddLightEndsFinite)
{
    std::array<vec3, 16> texels;
    const float odd[] = {std::nanf(""), INFINITY, -INFINITY, -1.0f, 0.0f, 1e-30f, 1e30f, 65504.0f};
    for (size_t i = 0; i < 16; ++i) texels[i] = vec3(odd[i % 8], odd[(i + 3) % 8], odd[(i / 2 + 5) % 8]);
    const Block block = radianceBlockOf(texels, 0xffffu);
    EXPECT_EQ(block[0] & 31u, Text::kBlockMode);
    for (uint32_t i = 0; i < 16; ++i) EXPECT_TRUE(std::isfinite(glm::length(texelOf(block, i))));
    texels.fill(vec3(0.0f));
    EXPECT_EQ(texelOf(radianceBlockOf(texels, 0xffffu), 0), vec3(0.0f)) << "black stays black";
}

/// Every texel that shows a surface, before and after.
template <class Look> void atEveryTexel(const FieldData& texels, const FieldData& blocks, const Look& look)
{
    twin::LightFieldTwin<float> before(texels, {}), after(blocks, {});
    const uint32_t size = texels.info.faceSize;
    for (uint32_t i = 0; i < texels.info.probeCount * 6 * size * size; ++i)
    {
        const uint32_t probe = i / (6 * size * size), x = i % size, y = i / size % size;
        const int face = int(i / (size * size) % 6);
        look(before.texelWord(before.mapWords(probe, face), x, y), after.texelWord(after.mapWords(probe, face), x, y),
             vec3(before.mapRadiance(probe, face, int(x), int(y))), vec3(after.mapRadiance(probe, face, int(x), int(y))));
    }
}

TEST(MapBlocks, AFieldsLightAndDistancesAreKeptAsWellAsItsTexelsSayThem)
{
    const FieldData texels = shadedCornell();
    FieldData blocks = texels;
    ASSERT_TRUE(putInBlocks(blocks));
    EXPECT_TRUE(inBlocks(blocks.info) && !inBlocks(texels.info));
    EXPECT_EQ(blocks.radiance.size(), texels.radiance.size() / 4);
    EXPECT_LT(double(blocks.distance.size()), 0.57 * double(texels.distance.size()));
    double squares = 0.0, means = 0.0;
    size_t seen = 0, far = 0, turned = 0;
    atEveryTexel(texels, blocks,
                 [&](uint32_t was, uint32_t is, vec3 light, vec3 kept)
                 {
                     ASSERT_EQ((was & 0xffffu) == 0, is == 0) << "sky stays sky, and nothing else becomes it";
                     if (is == 0) return;
                     ++seen;
                     const double error = double(glm::length(kept - light) / glm::length(light));
                     squares += error * error, means += double(glm::length(kept) / glm::length(light));
                     far += std::abs(Text::halfToReal(is) / Text::halfToReal(was) - 1.0f) > 0.002f;
                     turned += std::abs(Text::unpackGradient(is >> 16) - Text::unpackGradient(was >> 16)) > 0.004f ||
                               std::abs(Text::unpackGradient(is >> 24) - Text::unpackGradient(was >> 24)) > 0.004f;
                 });
    EXPECT_LT(std::sqrt(squares / double(seen)), 0.01) << "a texel's own steps are 1.6 and 3 % of it";
    EXPECT_NEAR(means / double(seen), 1.0, 0.0001);
    EXPECT_EQ(far, 0u) << "nowhere over four planes meet in a block of a box with two blocks in it";
    EXPECT_EQ(turned, 0u);
    FieldData again = texels;
    ASSERT_TRUE(putInBlocks(again));
    EXPECT_EQ(again.radiance, blocks.radiance) << "the same bytes each time";
    EXPECT_EQ(again.distance, blocks.distance);
    ASSERT_TRUE(putInBlocks(again));
    EXPECT_EQ(again.distance, blocks.distance) << "once is enough";
}

// Of a plane q is linear over the block: half's steps are 2^-11 of it, those off a plane 2^-11, half of which and half of a step of the
// plane's own gradients a texel may be off.
TEST(MapBlocks, APlaneIsKeptWithinItsSteps)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> slope(-0.06f, 0.06f), logQ(-8.0f, 8.0f);
    for (int tried = 0; tried < 2000; ++tried)
    {
        const float q = std::exp2(logQ(random)), gx = slope(random), gy = slope(random);
        std::array<uint32_t, 16> texels;
        for (int i = 0; i < 16; ++i)
        {
            const float rise = 1.0f + gx * (float(i % 4) - 1.5f) + gy * (float(i / 4) - 1.5f);
            texels[size_t(i)] = Text::packTexel(q * rise, gx / rise, gy / rise);
        }
        const auto block = distanceBlockOf(texels);
        for (uint32_t i = 0; i < 16; ++i)
        {
            const uint32_t x = i % 4, y = i / 4, got = Text::blockTexel(block[Text::blockPlane(block[4 + y], x)], block[4 + y], x, y);
            EXPECT_NEAR(Text::halfToReal(got) / Text::halfToReal(texels[i]), 1.0f, 0.0008f);
            for (const int shift : {16, 24})
                EXPECT_NEAR(Text::unpackGradient(got >> shift), Text::unpackGradient(texels[i] >> shift), 0.002f);
        }
    }
}

// What bounds the texels is built of what the blocks hold, not of what they were made from.
TEST(MapBlocks, TheChainBoundsWhatTheBlocksHold)
{
    FieldData blocks = shadedCornell();
    const uint32_t size = blocks.info.faceSize, whole = blocks.info.wordsPerProbe / 6;
    ASSERT_TRUE(putInBlocks(blocks));
    twin::LightFieldTwin<float> text(blocks, {});
    for (uint32_t face = 0; face < 6 * blocks.info.probeCount; ++face)
    {
        const uint32_t first = text.mapWords(face / 6, int(face % 6));
        std::vector<uint32_t> words;
        for (uint32_t i = 0; i < size * size; ++i) words.push_back(text.texelWord(first, i % size, i / size));
        for (uint32_t i = size * size; i < whole; ++i) words.push_back(blocks.distance[first + text.behindTexels(i)]);
        expectChainBounds(words, size);
    }
}

TEST(MapBlocks, LightThatMayChangeAndOctahedralMapsAreRefused)
{
    FieldData octahedral = smallField(gpu::kChartOctahedral), groups = groupedField();
    for (FieldData* field : {&octahedral, &groups})
    {
        const std::vector<uint32_t> before = field->radiance;
        EXPECT_EQ(putInBlocks(*field).error().code, ErrorCode::badArgument);
        EXPECT_EQ(field->radiance, before);
    }
}

class MapBlocksOnDevice : public DeviceTest
{
};

TEST_F(MapBlocksOnDevice, RaysReadThemAsOnTheProcessor)
{
    const FieldData field = shadedCornell();
    const RaySet set = cornellRays(4000);
    FieldData blocks = field;
    ASSERT_TRUE(putInBlocks(blocks));
    twin::LightFieldTwin<float> texels(field, defaultQuality()), text(blocks, defaultQuality());
    std::vector<gpu::Ray> rays;
    for (size_t i = 0; i < set.size(); ++i) rays.push_back({set.origins[i], set.directions[i], set.normals[i]});
    for (const WordAccess access : {WordAccess::texelBuffers, WordAccess::addresses})
    {
        const auto device = makeLightField(gpu(), blocks, {}, access);
        ASSERT_TRUE(device) << device.error().message;
        EXPECT_NE(device->constants()[gpu::kFieldFlagsId] & gpu::kMapsInBlocks, 0u);
        const auto tracer = makeRayTracer(gpu(), *device);
        std::vector<gpu::RayHit> hits(rays.size());
        ASSERT_TRUE(tracer->trace(rays, hits));
        size_t different = 0, elsewhere = 0;
        double off = 0.0;
        for (size_t i = 0; i < rays.size(); ++i)
        {
            const gpu::RayHit cpu = text.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
            different += cpu.probe != hits[i].probe || std::abs(cpu.t - hits[i].t) > 1e-4f * cpu.t ||
                         glm::length(vec3(cpu.radiance) - vec3(hits[i].radiance)) > 1e-3f * glm::length(vec3(cpu.radiance));
            const gpu::RayHit whole = texels.queryRay(rays[i].origin, rays[i].direction, rays[i].normal);
            if (whole.probe != cpu.probe || std::abs(whole.t - cpu.t) > 0.002f * field.info.diagonal * field.info.scale)
                ++elsewhere;
            else
                off += double(glm::length(vec3(cpu.radiance) - vec3(whole.radiance)) / std::max(glm::length(vec3(whole.radiance)), 1e-6f));
        }
        EXPECT_LE(different, rays.size() / 1000) << "rays that graze a texel's corner may round to its other side";
        EXPECT_LE(elsewhere, rays.size() / 2000) << "rays that end by over 0.2 % of the diagonal elsewhere than through texels";
        EXPECT_LT(off / double(rays.size()), 0.006);
    }
}

} // namespace
} // namespace sconce
