#pragma once

#include <filesystem>

#include "bench/reference/image_io.h"
#include "runtime/scene/scene_renderer.h"

namespace sconce
{

/// A frame's beauty, diffuse_indirect and glossy_indirect, to be compared with a reference's, and the depth that tells where both see the
/// same.
ImageSet lightLayers(const RenderedFrame& frame);

/// The pictures that a report embeds (docs/formats.md): 16 bytes "SCNI", width, height, kind; then rows from the top, little endian.
/// Kind 0: RGB half floats. Kind 1: one number a pixel, 32 bits without sign, all ones: none.
Status writeHalfPicture(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const float> rgb);
Status writeNumberPicture(const std::filesystem::path& file, uint32_t width, uint32_t height, std::span<const uint32_t> numbers);

} // namespace sconce
