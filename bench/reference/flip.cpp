#include "bench/reference/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/glm.hpp>
#include <tbb/parallel_for.h>

#include "base/numbers.h"
#include "bench/reference/image_io.h"

namespace sconce
{
namespace
{

using Plane = std::vector<vec3>;
constexpr float kPi = 3.14159265f;

// Linear sRGB to CIE XYZ, D65 (IEC 61966-2-1); columns are R, G, B.
const mat3 kXyzFromRgb(vec3(0.4124564f, 0.2126729f, 0.0193339f), vec3(0.3575761f, 0.7151522f, 0.1191920f),
                       vec3(0.1804375f, 0.0721750f, 0.9503041f));
const mat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const vec3 kWhite = kXyzFromRgb * vec3(1.0f);

// YCxCz, the opponent space that keeps linear light (Flohr et al. 1993; eq. 1 of FLIP).
vec3 ycxczFromRgb(vec3 rgb)
{
    const vec3 r = kXyzFromRgb * rgb / kWhite;
    return {116.0f * r.y - 16.0f, 500.0f * (r.x - r.y), 200.0f * (r.y - r.z)};
}

vec3 rgbFromYcxcz(vec3 c)
{
    const float y = (c.x + 16.0f) / 116.0f;
    return kRgbFromXyz * (vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * kWhite);
}

// CIE 1976 L*a*b*, then the Hunt effect: colourfulness grows with luminance (Hunt 1952).
vec3 huntLabFromRgb(vec3 rgb)
{
    const vec3 r = kXyzFromRgb * rgb / kWhite;
    const auto f = [](float t)
    {
        constexpr float delta = 6.0f / 29.0f;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
    };
    const float fx = f(r.x), fy = f(r.y), fz = f(r.z);
    const float lightness = 116.0f * fy - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (fx - fy), 0.01f * lightness * 200.0f * (fy - fz)};
}

// HyAB (Abasi et al. 2020): city-block in lightness, Euclidean in chroma; for large colour differences.
float hyab(vec3 a, vec3 b)
{
    const vec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

/// Applies per-channel kernels along one axis; the border repeats.
template <class Weigh> void filterAxis(const Plane& in, Plane& out, int width, int height, int stepX, int stepY, int radius, Weigh weigh)
{
    tbb::parallel_for(0, height,
                      [&](int y)
                      {
                          for (int x = 0; x < width; ++x)
                          {
                              vec3 sum(0.0f);
                              for (int i = -radius; i <= radius; ++i)
                              {
                                  const int sx = std::clamp(x + i * stepX, 0, width - 1), sy = std::clamp(y + i * stepY, 0, height - 1);
                                  sum += weigh(i) * in[size_t(sy) * size_t(width) + size_t(sx)];
                              }
                              out[size_t(y) * size_t(width) + size_t(x)] = sum;
                          }
                      });
}

/// Contrast sensitivity as Gaussians a sqrt(pi/b) exp(-pi^2 d^2 / b), d in degrees (FLIP, table 1, after Johnson and Fairchild 2003).
/// Luminance and red-green are one Gaussian each; blue-yellow is the sum of two, filtered apart so that each separates.
struct ContrastFilter
{
    int radius;
    std::vector<vec3> first;  // [2 radius + 1] luminance, red-green, blue-yellow's first; each sums to 1
    std::vector<vec3> second; // only z: blue-yellow's second
    float firstShare;         // of blue-yellow's two-dimensional weight

    explicit ContrastFilter(float pixelsPerDegree)
    {
        const vec3 b1(0.0047f, 0.0053f, 0.04f);
        const float b2 = 0.025f, a1 = 34.1f, a2 = 13.5f;
        radius = static_cast<int>(std::ceil(3.0f * std::sqrt(0.04f / (2.0f * kPi * kPi)) * pixelsPerDegree));
        vec3 sum1(0.0f);
        float sum2 = 0.0f;
        for (int i = -radius; i <= radius; ++i)
        {
            const float d = static_cast<float>(i) / pixelsPerDegree;
            first.push_back(glm::exp(vec3(-kPi * kPi * d * d) / b1));
            second.emplace_back(0.0f, 0.0f, std::exp(-kPi * kPi * d * d / b2));
            sum1 += first.back();
            sum2 += second.back().z;
        }
        const float weight1 = a1 * std::sqrt(kPi / b1.z) * sum1.z * sum1.z, weight2 = a2 * std::sqrt(kPi / b2) * sum2 * sum2;
        firstShare = weight1 / (weight1 + weight2);
        for (vec3& w : first) w /= sum1;
        for (vec3& w : second) w.z /= sum2;
    }

    /// YCxCz in, what the eye resolves of it as clamped linear RGB in Hunt-adjusted Lab out.
    Plane apply(const Plane& ycxcz, int width, int height) const
    {
        Plane across(ycxcz.size()), once(ycxcz.size()), twice(ycxcz.size());
        filterAxis(ycxcz, across, width, height, 1, 0, radius, [&](int i) { return first[size_t(i + radius)]; });
        filterAxis(across, once, width, height, 0, 1, radius, [&](int i) { return first[size_t(i + radius)]; });
        filterAxis(ycxcz, across, width, height, 1, 0, radius, [&](int i) { return second[size_t(i + radius)]; });
        filterAxis(across, twice, width, height, 0, 1, radius, [&](int i) { return second[size_t(i + radius)]; });
        for (size_t i = 0; i < once.size(); ++i)
        {
            once[i].z = glm::mix(twice[i].z, once[i].z, firstShare);
            once[i] = huntLabFromRgb(glm::clamp(rgbFromYcxcz(once[i]), 0.0f, 1.0f));
        }
        return once;
    }
};

/// First and second derivative of a Gaussian: how strongly a pixel is an edge or a point (FLIP, section 4.2).
struct FeatureFilter
{
    int radius;
    std::vector<vec3> weights; // [2 radius + 1] smooth, edge, point; positive and negative weights sum to 1 and -1

    explicit FeatureFilter(float pixelsPerDegree)
    {
        const float sigma = 0.5f * 0.082f * pixelsPerDegree; // half the width of an edge that the eye resolves, in pixels
        radius = static_cast<int>(std::ceil(3.0f * sigma));
        vec3 positive(0.0f), negative(0.0f);
        for (int i = -radius; i <= radius; ++i)
        {
            const float x = static_cast<float>(i), g = std::exp(-x * x / (2.0f * sigma * sigma));
            weights.emplace_back(g, -x * g, (x * x / (sigma * sigma) - 1.0f) * g);
            positive += glm::max(weights.back(), 0.0f);
            negative -= glm::min(weights.back(), 0.0f);
        }
        for (vec3& w : weights)
            for (int c = 0; c < 3; ++c) w[c] /= w[c] < 0.0f ? negative[c] : positive[c];
    }

    struct Feature
    {
        float edge;
        float point;
    };
    std::vector<Feature> apply(const Plane& ycxcz, int width, int height) const
    {
        Plane grey(ycxcz.size()), across(ycxcz.size()), alongX(ycxcz.size()), alongY(ycxcz.size());
        for (size_t i = 0; i < grey.size(); ++i) grey[i] = vec3((ycxcz[i].x + 16.0f) / 116.0f);
        const auto own = [&](int i) { return weights[size_t(i + radius)]; };
        const auto smooth = [&](int i) { return vec3(weights[size_t(i + radius)].x); };
        filterAxis(grey, across, width, height, 1, 0, radius, own);
        filterAxis(across, alongX, width, height, 0, 1, radius, smooth);
        filterAxis(grey, across, width, height, 0, 1, radius, own);
        filterAxis(across, alongY, width, height, 1, 0, radius, smooth);
        std::vector<Feature> features(grey.size());
        for (size_t i = 0; i < grey.size(); ++i) features[i] = {std::hypot(alongX[i].y, alongY[i].y), std::hypot(alongX[i].z, alongY[i].z)};
        return features;
    }
};

Plane opponentPlane(std::span<const float> rgb)
{
    Plane plane(rgb.size() / 3);
    for (size_t i = 0; i < plane.size(); ++i)
        plane[i] = ycxczFromRgb(glm::clamp(vec3(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]), 0.0f, 1.0f));
    return plane;
}

} // namespace

std::vector<float> flipLdr(std::span<const float> test, std::span<const float> reference, uint32_t width, uint32_t height,
                           float pixelsPerDegree)
{
    assert(test.size() == reference.size() && test.size() == size_t(width) * height * 3);
    constexpr float kColourExponent = 0.7f, kFeatureExponent = 0.5f, kKnee = 0.4f, kKneeValue = 0.95f;
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    const Plane planes[2] = {opponentPlane(test), opponentPlane(reference)};
    const ContrastFilter contrast(pixelsPerDegree);
    const FeatureFilter feature(pixelsPerDegree);
    const Plane labs[2] = {contrast.apply(planes[0], w, h), contrast.apply(planes[1], w, h)};
    const auto features0 = feature.apply(planes[0], w, h), features1 = feature.apply(planes[1], w, h);

    // The largest difference in gamut is between green and blue; small differences are spread over most of the range.
    const float largest = std::pow(hyab(huntLabFromRgb({0.0f, 1.0f, 0.0f}), huntLabFromRgb({0.0f, 0.0f, 1.0f})), kColourExponent);
    const float knee = kKnee * largest;
    std::vector<float> flip(planes[0].size());
    for (size_t i = 0; i < flip.size(); ++i)
    {
        const float d = std::pow(hyab(labs[0][i], labs[1][i]), kColourExponent);
        const float colour = d < knee ? kKneeValue / knee * d : kKneeValue + (d - knee) / (largest - knee) * (1.0f - kKneeValue);
        const float difference =
            std::max(std::abs(features0[i].edge - features1[i].edge), std::abs(features0[i].point - features1[i].point));
        const float structure = std::min(1.0f, std::pow(difference / std::sqrt(2.0f), kFeatureExponent));
        flip[i] = std::clamp(std::pow(std::min(colour, 1.0f), 1.0f - structure), 0.0f, 1.0f);
    }
    return flip;
}

std::vector<float> flipHdr(std::span<const float> test, std::span<const float> reference, uint32_t width, uint32_t height,
                           float pixelsPerDegree)
{
    // From the exposure that takes the brightest pixel to 0.85 of the tone map's range to the one that takes the median there.
    std::vector<float> luminances(reference.size() / 3);
    for (size_t i = 0; i < luminances.size(); ++i)
        luminances[i] = luminance({reference[3 * i], reference[3 * i + 1], reference[3 * i + 2]});
    const auto middle = luminances.begin() + static_cast<ptrdiff_t>(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    const float median = *middle;
    const float brightest = *std::max_element(luminances.begin(), luminances.end());
    const float target = inverseToneMapAces(0.85f);
    // A black reference has no range: it is looked at as it is.
    const float smallest = 1e-5f * std::max(brightest, 1e-30f);
    const float start = brightest > 0.0f ? std::log2(target / brightest) : 0.0f;
    const float stop = brightest > 0.0f ? std::log2(target / std::max(median, smallest)) : 0.0f;
    const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
    std::vector<float> most(luminances.size(), 0.0f);
    for (int i = 0; i < count; ++i)
    {
        const float exposure = std::exp2(glm::mix(start, stop, static_cast<float>(i) / static_cast<float>(count - 1)));
        const auto at = flipLdr(toneMap(test, exposure), toneMap(reference, exposure), width, height, pixelsPerDegree);
        for (size_t p = 0; p < most.size(); ++p) most[p] = std::max(most[p], at[p]);
    }
    return most;
}

} // namespace sconce
