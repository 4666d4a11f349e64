#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "scene/scene.h"

namespace sconce
{

/// How layers of parts of a reference's paths are called after their whole (ReferenceSettings::parts): a quarter, another, and the half
/// that is left.
inline constexpr const char* kParts[] = {"_a", "_b", "_c"};

/// One named picture of 1 or 3 floats a pixel, row 0 at the top.
struct Layer
{
    std::string name;
    uint32_t channels = 3;
    std::vector<float> pixels; // [height][width][channels]
};

/// Pictures of one size: the AOVs of a render.
struct ImageSet
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<Layer> layers;

    const Layer* find(std::string_view name) const;
    Layer& add(std::string name, uint32_t channels); // zeroed; the reference lasts until the next add
    size_t pixelCount() const { return size_t(width) * height; }
};

/// 32-bit float EXR. Layer "beauty" is R,G,B, any other NAME is NAME.R,NAME.G,NAME.B, or NAME.Y with one channel. The file appears
/// whole or not at all (temporary name, then rename). Errors: badArgument, fileError.
Status writeExr(const ImageSet& images, const std::filesystem::path& file);

/// Reads what writeExr writes, and other EXR files of one part of scan lines, packed by RLE, ZIP or PIZ or not at all (exr_guard.h): a
/// single channel without colours becomes a layer of its own. Errors: fileError, badInput.
Result<ImageSet> readExr(const std::filesystem::path& file);

/// 8-bit sRGB PNG of linear RGB in [0,1] (clamped, not tone-mapped here). Crash-safe as writeExr.
Status writePng(std::span<const float> linearRgb, uint32_t width, uint32_t height, const std::filesystem::path& file);

/// Tone map of a non-negative value: Narkowicz 2015, "ACES Filmic Tone Mapping Curve", with its customary exposure of 0.6. In [0,1].
float toneMapAces(float value);
/// The value that toneMapAces takes to `mapped`, in (0,1).
float inverseToneMapAces(float mapped);
/// exposure * colour through toneMapAces, per channel; linear [0,1] out.
std::vector<float> toneMap(std::span<const float> linearRgb, float exposure);

/// Scale that takes the log-average luminance to 0.18 (Reinhard et al. 2002, "Photographic Tone Reproduction"); black pixels are left
/// out, 1 for a black picture.
float autoExposure(std::span<const float> linearRgb);

/// Rec. 709 luminance.
float srgbFromLinear(float value); // IEC 61966-2-1, clamped to [0,1]

} // namespace sconce
