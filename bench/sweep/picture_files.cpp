#include "bench/sweep/picture_files.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include <glm/gtc/packing.hpp>

#include "base/safe_file.h"

namespace sconce
{
namespace
{

static_assert(std::endian::native == std::endian::little, "the files are little endian and written as they lie in memory");

constexpr float kLargestHalf = 65504.0f;

struct Header
{
    char magic[4] = {'S', 'C', 'N', 'I'};
    uint32_t width, height, kind;
};
static_assert(sizeof(Header) == 16);

Status write(const std::filesystem::path& file, const Header& header, std::span<const std::byte> pixels)
{
    auto target = SafeFile::create(file);
    if (!target) return target.error();
    if (auto status = target->append(std::as_bytes(std::span(&header, 1))); !status) return status;
    if (auto status = target->append(pixels); !status) return status;
    return target->commit();
}

void addColours(ImageSet& images, const char* name, const std::vector<vec3>& pixels)
{
    Layer& layer = images.add(name, 3);
    for (size_t i = 0; i < pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) layer.pixels[3 * i + size_t(c)] = pixels[i][c];
}

} // namespace

ImageSet lightLayers(const RenderedFrame& frame)
{
    ImageSet images;
    images.width = frame.width;
    images.height = frame.height;
    addColours(images, "beauty", frame.beauty);
    addColours(images, "diffuse_indirect", frame.diffuseIndirect);
    addColours(images, "glossy_indirect", frame.glossyIndirect);
    images.add("depth", 1).pixels = frame.depth;
    return images;
}

Status writeHalfPicture(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const float> rgb)
{
    assert(rgb.size() == size_t(width) * height * 3);
    std::vector<uint16_t> halves(rgb.size());
    for (size_t i = 0; i < rgb.size(); ++i) halves[i] = glm::packHalf1x16(std::min(rgb[i], kLargestHalf)); // a NaN stays one
    return write(file, {.width = width, .height = height, .kind = 0}, std::as_bytes(std::span(halves)));
}

Status writeNumberPicture(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const uint32_t> numbers)
{
    assert(numbers.size() == size_t(width) * height);
    return write(file, {.width = width, .height = height, .kind = 1}, std::as_bytes(numbers));
}

} // namespace sconce
