#include "runtime/scene/scene_textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/parallel.h"
#include "shaders/shared/frame.h"

namespace sconce
{

namespace
{

/// Both ways between 8-bit sRGB codes and linear values (IEC 61966-2-1); data is linear both ways.
struct Codec
{
    std::array<float, 256> linear{};
    std::array<uint8_t, 4096> code{}; // of linear values, for the root of the value: even steps where the eye needs them

    explicit Codec(bool srgb)
    {
        for (int i = 0; i < 256; ++i)
        {
            const double s = i / 255.0;
            linear[size_t(i)] = float(!srgb ? s : s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
        }
        for (int i = 0; i < 4096; ++i)
        {
            const double root = i / 4095.0, v = root * root;
            const double s = !srgb ? v : v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
            code[size_t(i)] = uint8_t(std::lround(255.0 * s));
        }
    }
    uint8_t encode(float v) const { return code[size_t(std::sqrt(std::clamp(v, 0.0f, 1.0f)) * 4095.0f + 0.5f)]; }
};

using Texels = std::vector<vec4>; // [y][x], linear

/// Bilinear where it grows, a box where it shrinks; the edges repeat.
Texels resized(const Image& image, uint32_t size, const Codec& codec)
{
    const auto at = [&](uint32_t x, uint32_t y)
    {
        const uint8_t* p = &image.rgba[(size_t(y % image.height) * image.width + x % image.width) * 4];
        return vec4(codec.linear[p[0]], codec.linear[p[1]], codec.linear[p[2]], float(p[3]) / 255.0f);
    };
    Texels texels(size_t(size) * size);
    const double stepX = double(image.width) / size, stepY = double(image.height) / size;
    const int tapsX = std::max(1, int(std::ceil(stepX))), tapsY = std::max(1, int(std::ceil(stepY)));
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
        {
            vec4 sum(0.0f);
            for (int j = 0; j < tapsY; ++j)
                for (int i = 0; i < tapsX; ++i)
                {
                    const double px = (x + (i + 0.5) / tapsX) * stepX - 0.5 + image.width;
                    const double py = (y + (j + 0.5) / tapsY) * stepY - 0.5 + image.height;
                    const auto x0 = uint32_t(px), y0 = uint32_t(py);
                    const auto fx = float(px - x0), fy = float(py - y0);
                    sum += glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), fx), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), fx), fy);
                }
            texels[size_t(y) * size + x] = sum / float(tapsX * tapsY);
        }
    return texels;
}

Texels halved(const Texels& finer, uint32_t size)
{
    Texels texels(size_t(size) * size);
    for (size_t y = 0; y < size; ++y)
        for (size_t x = 0; x < size; ++x)
        {
            const vec4* p = &finer[2 * y * 2 * size + 2 * x];
            texels[y * size + x] = 0.25f * (p[0] + p[1] + p[2 * size] + p[2 * size + 1]);
        }
    return texels;
}

void encode(const Texels& texels, const Codec& codec, uint8_t* out)
{
    for (const vec4& t : texels)
    {
        for (int c = 0; c < 3; ++c) *out++ = codec.encode(t[c]);
        *out++ = uint8_t(std::clamp(t.a, 0.0f, 1.0f) * 255.0f + 0.5f);
    }
}

/// All mips of one image, one after another.
std::vector<uint8_t> mipChain(const Image& image, uint32_t size, bool srgb)
{
    static const Codec codecs[2] = {Codec(false), Codec(true)};
    const Codec& codec = codecs[srgb ? 1 : 0];
    size_t bytes = 0;
    for (uint32_t s = size; s > 0; s /= 2) bytes += size_t(s) * s * 4;
    std::vector<uint8_t> chain(bytes);
    uint8_t* out = chain.data();
    Texels texels = resized(image, size, codec);
    // The full size of an image that is not resized is taken as it is, so that no code is rounded twice.
    if (image.width == size && image.height == size)
        std::memcpy(out, image.rgba.data(), image.rgba.size());
    else
        encode(texels, codec, out);
    out += size_t(size) * size * 4;
    for (uint32_t s = size / 2; s > 0; s /= 2)
    {
        texels = halved(texels, s);
        encode(texels, codec, out);
        out += size_t(s) * s * 4;
    }
    return chain;
}

gpu::GpuTexture gpuTexture(const TextureRef& texture, const TextureArray& array)
{
    gpu::GpuTexture made{};
    made.uvMatrix = vec4(texture.uvScaleRotate[0], texture.uvScaleRotate[1]);
    made.uvOffset = texture.uvOffset;
    made.layer = texture.image < 0 ? -1 : array.layerOfImage[size_t(texture.image)];
    made.wrap = uint32_t(texture.wrapU) | uint32_t(texture.wrapV) << 2;
    return made;
}

} // namespace

Result<TextureArray> makeTextureArray(Gpu& gpu, const Scene& scene, TextureKind kind, uint32_t maxSize)
{
    TextureArray array;
    array.layerOfImage.assign(scene.images.size(), -1);
    std::vector<const Image*> layers;
    uint32_t size = 1;
    // Of the images those alone that a material uses in this way, each once: all layers are as large as the largest.
    const auto use = [&](const TextureRef& texture)
    {
        if (texture.image < 0 || array.layerOfImage[size_t(texture.image)] >= 0) return;
        const Image& image = scene.images[size_t(texture.image)];
        array.layerOfImage[size_t(texture.image)] = int(layers.size());
        layers.push_back(&image);
        size = std::max(size, std::bit_ceil(std::max(image.width, image.height)));
    };
    for (const Material& material : scene.materials)
    {
        if (kind == TextureKind::data)
            use(material.metallicRoughnessTexture), use(material.normalTexture);
        else
            use(material.baseColorTexture), use(material.emissionTexture);
    }
    if (const uint32_t most = gpu.properties.limits.maxImageArrayLayers; layers.size() > most)
        return Error{
            ErrorCode::missingFeature,
            fmt::format("The materials of scene '{}' use {} images as {}, and '{}' binds {} in one array; join small images, or let "
                        "materials share them",
                        scene.name, layers.size(), kind == TextureKind::color ? "colour" : "data", gpu.properties.deviceName, most)};
    // All layers of an array have one size. A power of two, so that every mip is exactly half of the one above.
    size = std::min(size, std::bit_floor(maxSize));

    ImageDesc desc;
    desc.format = kind == TextureKind::color ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    desc.width = desc.height = size;
    // A scene without textures has a layer too: its binding wants an image, and no material names it.
    desc.layers = std::max(uint32_t(layers.size()), 1u);
    desc.mips = uint32_t(std::bit_width(size));
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    desc.array = true;
    auto image = gpu.makeImage(desc, "The scene's textures");
    if (!image) return image.error();
    array.image = std::move(*image);
    auto status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            // A new image: nothing used it. In a submit of its own, since the copies come in many.
            transition(gpu, cmd, array.image,
                       {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_NONE,
                        VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_ACCESS_2_TRANSFER_WRITE_BIT});
        });
    if (!status) return status.error();
    constexpr size_t kAtOnce = 8; // images in host memory as floats
    for (size_t first = 0; first < layers.size(); first += kAtOnce)
    {
        const size_t count = std::min(kAtOnce, layers.size() - first);
        std::vector<std::vector<uint8_t>> chains(count);
        parallelFor(count, [&](size_t i) { chains[i] = mipChain(*layers[first + i], size, kind == TextureKind::color); });
        for (size_t i = 0; i < count; ++i)
        {
            // Staged one by one: submit() waits for the copy, so that staging never takes more than one image's bytes.
            auto staging = gpu.makeBuffer(chains[i].size(), 0, MemoryUse::upload, "A texture's staging buffer");
            if (!staging) return staging.error();
            std::memcpy(staging->mapped(), chains[i].data(), chains[i].size());
            // All mips in one copy, one behind the other as mipChain() gives them.
            std::vector<VkBufferImageCopy> copies;
            VkDeviceSize offset = 0;
            for (uint32_t mip = 0; mip < desc.mips; ++mip)
            {
                VkBufferImageCopy copy{};
                copy.bufferOffset = offset;
                copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, uint32_t(first + i), 1};
                copy.imageExtent = {size >> mip, size >> mip, 1};
                copies.push_back(copy);
                offset += VkDeviceSize(size >> mip) * (size >> mip) * 4;
            }
            status = gpu.submit(
                [&](VkCommandBuffer cmd)
                {
                    gpu.vk.CmdCopyBufferToImage(cmd, staging->handle(), array.image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                uint32_t(copies.size()), copies.data());
                });
            if (!status) return status.error();
        }
    }
    status = gpu.submit(
        [&](VkCommandBuffer cmd)
        {
            // Read after write, for the copies of all submits before. All commands: which draw or pass samples it first is not known here.
            transition(gpu, cmd, array.image,
                       {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT,
                        VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
        });
    if (!status) return status.error();
    return array;
}

std::vector<gpu::GpuMaterial> gpuMaterials(const Scene& scene, const TextureArray& color, const TextureArray& data)
{
    std::vector<gpu::GpuMaterial> materials;
    for (const Material& material : scene.materials)
        materials.push_back({material.baseColor, material.emission, material.metallic, material.roughness,
                             material.blended ? gpu::kBlended : material.alphaCutoff, material.normalStrength,
                             material.retroreflective ? gpu::kRetro : 0.0f, gpuTexture(material.baseColorTexture, color),
                             gpuTexture(material.metallicRoughnessTexture, data), gpuTexture(material.emissionTexture, color),
                             gpuTexture(material.normalTexture, data)});
    return materials;
}

} // namespace sconce
