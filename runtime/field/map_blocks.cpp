#include "runtime/field/map_blocks.h"

#include <algorithm>

#include "base/parallel.h"
#include "runtime/field/distance_block.h"
#include "runtime/field/field_space.h"
#include "runtime/field/radiance_block.h"
#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

constexpr size_t kTexels = 16;

/// Words of the texels of a block of a face, row by row.
std::array<uint32_t, kTexels> texelsOf(const uint32_t* face, uint32_t faceSize, size_t block)
{
    const uint32_t side = faceSize / Text::kBlockSide;
    const uint32_t* const first = face + (block / side * faceSize + block % side) * Text::kBlockSide;
    std::array<uint32_t, kTexels> words;
    for (size_t i = 0; i < kTexels; ++i) words[i] = first[i / Text::kBlockSide * faceSize + i % Text::kBlockSide];
    return words;
}

std::array<uint32_t, 4> radianceBlock(const uint32_t* radiance, const uint32_t* distance, uint32_t faceSize, size_t block)
{
    const auto light = texelsOf(radiance, faceSize, block), seen = texelsOf(distance, faceSize, block);
    std::array<glm::vec3, kTexels> texels;
    uint32_t counts = 0;
    for (size_t i = 0; i < kTexels; ++i)
    {
        texels[i] = Text::unpackRadiance(light[i]);
        counts |= uint32_t((seen[i] & 0xffffu) != 0) << i;
    }
    return radianceBlockOf(texels, counts);
}

/// A face's words in blocks. @param face  its words; level 0 becomes what the blocks hold, and the rest of the chain that of it
void putFaceInBlocks(uint32_t* face, uint32_t faceSize, std::span<uint32_t> out)
{
    const size_t side = faceSize / Text::kBlockSide;
    auto next = out.begin();
    for (size_t block = 0; block < side * side; ++block)
    {
        const std::array<uint32_t, Text::kDistanceBlockWords> words = distanceBlockOf(texelsOf(face, faceSize, block));
        next = std::ranges::copy(words, next).out;
        for (uint32_t i = 0; i < kTexels; ++i)
        {
            const uint32_t x = i % Text::kBlockSide, y = i / Text::kBlockSide;
            face[(block / side * Text::kBlockSide + y) * faceSize + block % side * Text::kBlockSide + x] =
                Text::blockTexel(words[Text::blockPlane(words[4 + y], x)], words[4 + y], x, y);
        }
    }
    buildChain(face, faceSize);
    std::copy_n(face + size_t(faceSize) * faceSize, out.end() - next, next);
}

} // namespace

Status putInBlocks(FieldData& field)
{
    if (inBlocks(field.info)) return success();
    if (field.info.chart != gpu::kChartCube)
        return Error{ErrorCode::badArgument, "maps go in blocks of cube faces' texels, and these are octahedral"};
    if (!field.groups.empty() || field.live.links > 0)
        return Error{ErrorCode::badArgument, "maps whose light may change, by light groups or live links, can't be in blocks"};
    const uint32_t size = field.info.faceSize, words = blockedDistanceWords(size);
    const size_t faces = field.probes.size() * 6, texels = size_t(size) * size, blocks = texels / kTexels;
    const bool lit = !field.radiance.empty();
    std::vector<uint32_t> distance(field.probes.size() * words), radiance(lit ? faces * blocks * 4 : 0);
    parallelFor(faces,
                [&](size_t face)
                {
                    uint32_t* const seen = field.distance.data() + face * (field.info.wordsPerProbe / 6);
                    putFaceInBlocks(seen, size, std::span(distance).subspan(face * (words / 6), words / 6));
                    for (size_t block = 0; lit && block < blocks; ++block)
                        std::ranges::copy(radianceBlock(field.radiance.data() + face * texels, seen, size, block),
                                          radiance.begin() + std::ptrdiff_t((face * blocks + block) * 4));
                });
    field.distance = std::move(distance);
    field.radiance = std::move(radiance);
    field.info.wordsPerProbe = words;
    return success();
}

} // namespace sconce
