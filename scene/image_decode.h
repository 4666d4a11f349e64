#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

inline constexpr uint32_t kMaxImageSide = 16384;       // pixels
inline constexpr uint64_t kMaxImagePixels = 64u << 20; // of one image

/// Decodes a PNG, JPEG or WebP (told apart by their first bytes, not by name or MIME type) to RGBA8. The size in the header is checked
/// before any pixel is allocated. Colour profiles and gamma chunks are ignored, as glTF 2.0 asks. Errors: badInput, naming the image.
Result<Image> decodeImage(std::span<const uint8_t> bytes, std::string_view name);

} // namespace sconce
