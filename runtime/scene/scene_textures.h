#pragma once

#include <vector>

#include "runtime/vulkan/gpu.h"
#include "scene/scene.h"
#include "shaders/shared/material.h"

namespace sconce
{

/// A scene's images as one array of one size with all mips: sRGB for colours, or linear for data.
struct TextureArray
{
    GpuImage image;
    std::vector<int> layerOfImage; // [Scene::images], -1: not used by this array
};

enum class TextureKind
{
    color,
    data
};

/// @param maxSize  largest side, texels; images are resized to the next power of two of the largest image used, at most this
Result<TextureArray> makeTextureArray(Gpu& gpu, const Scene& scene, TextureKind kind, uint32_t maxSize);

/// The materials as the shaders read them.
std::vector<gpu::GpuMaterial> gpuMaterials(const Scene& scene, const TextureArray& color, const TextureArray& data);

} // namespace sconce
