#include "bench/reference/metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "base/listed.h"
#include "bench/reference/flip.h"

namespace sconce
{
namespace
{

double relativeSquare(float a, float b)
{
    const double d = double(a) - double(b);
    return d * d / (double(b) * double(b) + 0.01);
}

uint64_t nonFinitePixels(const Layer& layer)
{
    uint64_t count = 0;
    for (size_t i = 0; i < layer.pixels.size(); i += layer.channels)
        count += !std::all_of(layer.pixels.begin() + static_cast<ptrdiff_t>(i),
                              layer.pixels.begin() + static_cast<ptrdiff_t>(i + layer.channels), [](float v) { return std::isfinite(v); });
    return count;
}

/// One-channel layers are compared as grey.
std::vector<float> asRgb(const Layer& layer)
{
    if (layer.channels == 3) return layer.pixels;
    std::vector<float> rgb;
    rgb.reserve(layer.pixels.size() * 3);
    for (float v : layer.pixels) rgb.insert(rgb.end(), 3, v);
    return rgb;
}

/// Whether both pictures show the same surface, a pixel each. Errors: badInput, a picture without depth.
Result<std::vector<bool>> sameSurfaces(const ImageSet& a, const ImageSet& reference)
{
    const Layer* const left = a.find("depth");
    const Layer* const right = reference.find("depth");
    if (!left || !right || left->pixels.size() != a.pixelCount() || right->pixels.size() != a.pixelCount())
        return Error{ErrorCode::badInput, fmt::format("{} has no layer 'depth', which tells where both see the same surface; render it "
                                                      "with one, or compare all pixels",
                                                      left && left->pixels.size() == a.pixelCount() ? "the reference" : "the picture")};
    std::vector<bool> same(a.pixelCount());
    for (size_t p = 0; p < same.size(); ++p)
    {
        const float d = left->pixels[p], truth = right->pixels[p];
        same[p] = d == truth || (std::isfinite(truth) && std::abs(d - truth) <= kOtherSurface * std::abs(truth)); // the sky's are equal
    }
    return same;
}

/// Which pixels count, by what has changed in the reference. Errors: badInput.
Result<std::vector<bool>> changedPixels(const ImageSet& reference, const CompareSettings& settings)
{
    const Layer *const now = reference.find(settings.layer), *const then = settings.before->find(settings.layer);
    if (!then || settings.before->width != reference.width || settings.before->height != reference.height ||
        then->channels != now->channels)
        return Error{ErrorCode::badInput,
                     fmt::format("the picture before the change is {}x{} and {} layer '{}'; render it as the reference",
                                 settings.before->width, settings.before->height, then ? "has another" : "has no", settings.layer)};
    auto changed = sameSurfaces(*settings.before, reference);
    if (!changed) return changed;
    const std::vector<float> light = asRgb(*now), was = asRgb(*then);
    const auto luminance = [](const std::vector<float>& rgb, size_t p)
    { return 0.2126f * rgb[3 * p] + 0.7152f * rgb[3 * p + 1] + 0.0722f * rgb[3 * p + 2]; };
    for (size_t p = 0; p < changed->size(); ++p)
    {
        const float a = luminance(light, p), b = luminance(was, p);
        (*changed)[p] = settings.newSurface ? !(*changed)[p] : (*changed)[p] && std::abs(a - b) > kChanged * std::max(a, b);
    }
    return changed;
}

/// The values of the pixels that count.
std::vector<float> judgedOnly(std::vector<float> rgb, const std::vector<bool>& judged)
{
    if (judged.empty()) return rgb;
    size_t kept = 0;
    for (size_t p = 0; p < judged.size(); ++p)
        if (judged[p])
            for (size_t i = 3 * p; i < 3 * p + 3; ++i) rgb[kept++] = rgb[i];
    rgb.resize(kept);
    return rgb;
}

Result<const Layer*> findLayer(const ImageSet& images, const std::string& name, const char* which)
{
    if (const Layer* layer = images.find(name)) return layer;
    const std::string names = listed(images.layers, &Layer::name);
    return Error{ErrorCode::badInput, fmt::format("{} has no layer '{}'; it has: {}", which, name, names.empty() ? "none" : names)};
}

} // namespace

double meanSquaredError(std::span<const float> a, std::span<const float> reference)
{
    assert(a.size() == reference.size());
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += (double(a[i]) - reference[i]) * (double(a[i]) - reference[i]);
    return sum / static_cast<double>(a.size());
}

double relativeMeanSquaredError(std::span<const float> a, std::span<const float> reference)
{
    assert(a.size() == reference.size());
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += relativeSquare(a[i], reference[i]);
    return sum / static_cast<double>(a.size());
}

namespace
{

/// @param scale  i -> what the square of a difference is divided by
template <class Scale>
Estimate crossed(std::span<const float> a, std::span<const float> part, std::span<const float> other, const Scale& scale)
{
    assert(a.size() == part.size() && a.size() == other.size());
    double sum = 0.0, variances = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
    {
        const double product = (double(a[i]) - part[i]) * (double(a[i]) - other[i]), by = scale(i);
        // With parts of variance v each, the product's is 2 v d^2 + v^2. Their difference squared has the mean 2 v, its square 12 v^2, and
        // the product times it 2 v d^2 - 2 v^2 (normal noise).
        const double noise = (double(part[i]) - other[i]) * (double(part[i]) - other[i]);
        sum += product / by;
        variances += (product * noise + 0.25 * noise * noise) / (by * by);
    }
    return {sum / double(a.size()), std::sqrt(std::max(variances, 0.0)) / double(a.size())};
}

} // namespace

Estimate meanSquaredError(std::span<const float> a, std::span<const float> part, std::span<const float> other)
{
    return crossed(a, part, other, [](size_t) { return 1.0; });
}

Estimate relativeMeanSquaredError(std::span<const float> a, std::span<const float> part, std::span<const float> other,
                                  std::span<const float> scale)
{
    assert(a.size() == scale.size());
    return crossed(a, part, other, [&](size_t i) { return double(scale[i]) * double(scale[i]) + 0.01; });
}

double meanOverMean(std::span<const float> a, std::span<const float> reference)
{
    assert(a.size() == reference.size());
    const double sum = std::accumulate(a.begin(), a.end(), 0.0), truth = std::accumulate(reference.begin(), reference.end(), 0.0);
    return truth > 0.0 ? sum / truth : std::numeric_limits<double>::quiet_NaN();
}

double peakSignalToNoise(std::span<const float> a, std::span<const float> reference, float exposure)
{
    assert(a.size() == reference.size());
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
    {
        const double d = double(srgbFromLinear(toneMapAces(exposure * a[i]))) - srgbFromLinear(toneMapAces(exposure * reference[i]));
        sum += d * d;
    }
    if (sum == 0.0) return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(static_cast<double>(a.size()) / sum);
}

namespace
{

/// The metrics that are means over pixels.
Status measureValues(CompareResult& result, const std::vector<float>& left, const std::vector<float>& right, const ImageSet& reference,
                     const std::vector<bool>& judged, const CompareSettings& settings)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    // A mean over a pixel that is not a number is none either: said as NaN, beside how many such pixels there are.
    const bool whole = result.nonFinitePixels == 0;
    if (settings.mse) result.mse = whole ? meanSquaredError(left, right) : nan;
    if (settings.relMse) result.relMse = whole ? relativeMeanSquaredError(left, right) : nan;
    if (settings.mean) result.mean = whole ? meanOverMean(left, right) : nan;
    if (settings.psnr) result.psnr = whole ? peakSignalToNoise(left, right, settings.exposure.value_or(autoExposure(right))) : nan;
    std::vector<std::vector<float>> parts;
    for (const char* name : kParts)
        if (const Layer* part = reference.find(settings.layer + name))
        {
            parts.push_back(judgedOnly(asRgb(*part), judged));
            if (parts.back().size() != left.size() || nonFinitePixels(*part) > 0)
                return Error{ErrorCode::badInput, fmt::format("the reference's layer '{}' is damaged; render it again", part->name)};
        }
    if (!whole || parts.size() != std::size(kParts)) return success();
    // Never below what is unsure of it: a difference that can't be told from none is not one below 0.
    const Estimate square = meanSquaredError(left, parts[0], parts[1]);
    if (settings.mse) result.mse = std::max(square.value, square.unsure);
    const Estimate relative = relativeMeanSquaredError(left, parts[0], parts[1], parts[2]);
    if (settings.relMse) result.relMse = std::max(relative.value, relative.unsure), result.relMseUnsure = relative.unsure;
    return success();
}

/// FLIP and its map, or that of the relative error.
void measureMap(CompareResult& result, const std::vector<float>& left, const std::vector<float>& right, const CompareSettings& settings)
{
    if (settings.flip && result.nonFinitePixels == 0)
    {
        // HDR-FLIP sweeps exposures of its own; where one is asked for, the picture is compared as it is shown.
        const auto [width, height] = std::pair(result.width, result.height);
        result.errorMap = settings.exposure ? flipLdr(toneMap(left, *settings.exposure), toneMap(right, *settings.exposure), width, height,
                                                      settings.pixelsPerDegree)
                                            : flipHdr(left, right, width, height, settings.pixelsPerDegree);
        result.flip = std::accumulate(result.errorMap.begin(), result.errorMap.end(), 0.0) /
                      static_cast<double>(result.errorMap.size() - result.otherSurfacePixels);
        return;
    }
    if (settings.flip) result.flip = std::numeric_limits<double>::quiet_NaN();
    result.errorMap.resize(left.size() / 3);
    for (size_t p = 0; p < result.errorMap.size(); ++p)
    {
        double worst = 0.0;
        for (size_t i = 3 * p; i < 3 * p + 3; ++i)
            worst = std::max(worst, std::isfinite(left[i]) ? relativeSquare(left[i], right[i]) : 1.0);
        result.errorMap[p] = static_cast<float>(std::min(1.0, std::sqrt(worst)));
    }
}

} // namespace

Result<CompareResult> compareImages(const ImageSet& a, const ImageSet& reference, const CompareSettings& settings)
{
    const auto layerA = findLayer(a, settings.layer, "the picture");
    if (!layerA) return layerA.error();
    const auto layerB = findLayer(reference, settings.layer, "the reference");
    if (!layerB) return layerB.error();
    if (a.width != reference.width || a.height != reference.height || (*layerA)->channels != (*layerB)->channels || a.pixelCount() == 0)
        return Error{ErrorCode::badInput,
                     fmt::format("the pictures differ in size: {}x{}x{} and {}x{}x{}; render both with the same --size", a.width, a.height,
                                 (*layerA)->channels, reference.width, reference.height, (*layerB)->channels)};
    if (!(settings.pixelsPerDegree >= 1.0f && settings.pixelsPerDegree <= 1000.0f))
        return Error{ErrorCode::badArgument, fmt::format("pixels per degree is {:f}; choose 1 to 1000", settings.pixelsPerDegree)};
    if (settings.exposure && !(*settings.exposure > 0.0f && std::isfinite(*settings.exposure)))
        return Error{ErrorCode::badArgument, fmt::format("exposure is {:f}; choose a positive number", *settings.exposure)};
    if (const uint64_t bad = nonFinitePixels(**layerB))
        return Error{ErrorCode::badInput,
                     fmt::format("the reference's layer '{}' has {} pixels that are not finite; render it again", settings.layer, bad)};

    std::vector<bool> judged; // empty: all pixels
    if (settings.sameSurface)
    {
        auto same = sameSurfaces(a, reference);
        if (!same) return same.error();
        judged = std::move(*same);
    }
    if (settings.before)
    {
        auto changed = changedPixels(reference, settings);
        if (!changed) return changed.error();
        if (std::ranges::count(*changed, true) == 0)
            return Error{ErrorCode::badInput, "nothing has changed between the two references; compare all pixels"};
        judged.resize(changed->size(), true);
        for (size_t p = 0; p < judged.size(); ++p) judged[p] = judged[p] && (*changed)[p];
    }
    CompareResult result;
    result.width = a.width;
    result.height = a.height;
    result.nonFinitePixels = nonFinitePixels(**layerA);
    result.otherSurfacePixels = uint64_t(std::ranges::count(judged, false));
    if (!judged.empty() && result.otherSurfacePixels == judged.size())
        return Error{ErrorCode::badInput,
                     "no pixel of the two pictures shows the same surface that counts; render both with the same camera"};
    const std::vector<float> right = asRgb(**layerB);
    std::vector<float> left = asRgb(**layerA);
    for (size_t p = 0; p < judged.size(); ++p) // in maps of the error, which need their neighbours
        if (!judged[p]) std::copy_n(right.begin() + ptrdiff_t(3 * p), 3, left.begin() + ptrdiff_t(3 * p));
    if (auto status = measureValues(result, judgedOnly(left, judged), judgedOnly(right, judged), reference, judged, settings); !status)
        return status.error();
    measureMap(result, left, right, settings);
    return result;
}

std::vector<float> errorColours(std::span<const float> errorMap)
{
    // Every eighth of magma, sRGB.
    static constexpr uint8_t kMagma[9][3] = {{0, 0, 4},      {29, 17, 71},   {81, 18, 124},   {131, 38, 129}, {183, 55, 121},
                                             {229, 89, 100}, {252, 137, 97}, {254, 194, 135}, {252, 253, 191}};
    std::vector<float> colours(errorMap.size() * 3);
    for (size_t i = 0; i < errorMap.size(); ++i)
    {
        const float x = 8.0f * std::clamp(errorMap[i], 0.0f, 1.0f);
        const int cell = std::min(7, static_cast<int>(x));
        for (int c = 0; c < 3; ++c)
        {
            const float srgb = std::lerp(float(kMagma[cell][c]), float(kMagma[cell + 1][c]), x - static_cast<float>(cell)) / 255.0f;
            colours[3 * i + size_t(c)] = srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
        }
    }
    return colours;
}

Status writeErrorMap(const CompareResult& result, const std::filesystem::path& png)
{
    return writePng(errorColours(result.errorMap), result.width, result.height, png);
}

Status writeSideBySide(const ImageSet& a, const ImageSet& reference, const CompareSettings& settings, const CompareResult& result,
                       const std::filesystem::path& png)
{
    const std::vector<float>&left = a.find(settings.layer)->pixels, &right = reference.find(settings.layer)->pixels;
    const float exposure = settings.exposure.value_or(autoExposure(right));
    const std::vector<float> panels[] = {toneMap(left, exposure), toneMap(right, exposure), errorColours(result.errorMap)};
    const size_t row = size_t(3) * result.width;
    std::vector<float> sheet;
    sheet.reserve(3 * row * result.height);
    for (size_t y = 0; y < result.height; ++y)
        for (const std::vector<float>& panel : panels) sheet.insert(sheet.end(), panel.begin() + y * row, panel.begin() + (y + 1) * row);
    return writePng(sheet, 3 * result.width, result.height, png);
}

} // namespace sconce
