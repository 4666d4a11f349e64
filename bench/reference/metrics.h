#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "bench/reference/image_io.h"

namespace sconce
{

/// Mean of (a - b)^2 over all values, linear radiance.
double meanSquaredError(std::span<const float> a, std::span<const float> reference);
/// Mean of (a - b)^2 / (b^2 + 0.01), b the reference: errors in the dark count as much as those in the light.
double relativeMeanSquaredError(std::span<const float> a, std::span<const float> reference);
/// An error and about its standard error by the noise of what it is measured against.
struct Estimate
{
    double value = 0.0, unsure = 0.0;
};
/// Both errors without the noise of the reference: a's differences from two parts of its paths are multiplied, whose noises are
/// independent, so that the product's mean is the squared difference from what both tend to. It may come out below 0.
/// @param scale  a third part: what relative errors are relative to. Its noise makes them larger by a factor, of every picture the same
Estimate meanSquaredError(std::span<const float> a, std::span<const float> part, std::span<const float> other);
Estimate relativeMeanSquaredError(std::span<const float> a, std::span<const float> part, std::span<const float> other,
                                  std::span<const float> scale);
/// Mean of all values over the reference's mean: whether there is too much light, or too little. NaN where the reference is black.
double meanOverMean(std::span<const float> a, std::span<const float> reference);
/// 10 log10(1 / MSE) of both pictures as shown: exposure, toneMapAces, sRGB; peak 1. +infinity when equal. Decibels.
double peakSignalToNoise(std::span<const float> a, std::span<const float> reference, float exposure);

struct CompareSettings
{
    std::string layer = "beauty";
    bool mse = true;
    bool relMse = true;
    bool psnr = true;
    bool flip = true;
    bool mean = true;
    std::optional<float> exposure; // set: PSNR and LDR-FLIP at it. Unset: PSNR at the reference's autoExposure, and HDR-FLIP
    float pixelsPerDegree = 67.0f; // of FLIP
    bool sameSurface =
        false; // leaves out pixels in which the two see different surfaces: by their layer `depth`, more than kOtherSurface apart
    const ImageSet* before = nullptr; // another reference, before something came or went: only pixels count in which that changed...
    bool newSurface = false; // ... the layer's luminance, by over kChanged of the larger, on a surface that stayed; true: the surface
};
inline constexpr float kOtherSurface = 0.01f; // relative difference of depth
inline constexpr float kChanged = 0.1f;

struct CompareResult
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::optional<double> mse;
    std::optional<double> relMse;
    std::optional<double> relMseUnsure; // standard error by the reference's noise, where it has parts
    std::optional<double> psnr;         // dB, +infinity when equal
    std::optional<double> flip;         // mean of the map, [0,1]
    std::optional<double> mean;         // over the reference's
    std::vector<float> errorMap;        // [height][width] in [0,1]: FLIP, or min(1, relative error) where FLIP was not asked for
    uint64_t nonFinitePixels = 0;       // of the compared picture; any makes the metrics NaN
    uint64_t otherSurfacePixels = 0;    // left out, see CompareSettings::sameSurface and before; in maps they are as the reference's
};

/// Compares a layer of two pictures of equal size. Where the reference has the layer's parts (ReferenceSettings::parts), MSE and relMSE
/// are without its noise, but for what that leaves unsure: they are no less. Errors: badInput names the layer, the sizes, or the
/// reference's non-finite pixels.
/// Surfaces differ where a blended material is there by chance, and along edges: whoever judges light alone leaves such pixels out.
Result<CompareResult> compareImages(const ImageSet& a, const ImageSet& reference, const CompareSettings& settings = {});

/// The map in false colours from black over purple to yellow (magma, Smith and van der Walt 2015), as linear RGB for writePng.
std::vector<float> errorColours(std::span<const float> errorMap);
Status writeErrorMap(const CompareResult& result, const std::filesystem::path& png);
/// The compared layer of both, tone-mapped alike, and the error map, beside each other. `settings` and `result`: of compareImages() before.
Status writeSideBySide(const ImageSet& a, const ImageSet& reference, const CompareSettings& settings, const CompareResult& result,
                       const std::filesystem::path& png);

} // namespace sconce
