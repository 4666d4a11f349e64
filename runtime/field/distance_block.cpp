#include "runtime/field/distance_block.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using Text = Pure<float>;

constexpr int kTexels = 16, kPlanes = Text::kBlockPlanes;
constexpr float kOfDistance =
    0.05f; // a share off a plane's distance, which a texel's own bits mend, for one of a gradient, which nothing does
constexpr float kGoodEnough = 0.001f; // of all texels, with which no further plane is looked for: less than a step of a gradient
constexpr int kLeastShare = -32, kMostShare = 31;

struct Texel
{
    bool sky = true;
    float q = 0.0f, gx = 0.0f, gy = 0.0f;
};

/// A half's bits without those that hold a precision, to nearest; not 0, which is sky.
uint32_t roundedHalf(float q)
{
    return std::clamp((Text::realToHalf(q) + 2u) & ~3u, 4u, 0x7bfcu);
}

/// The plane of a texel's surfel, about the block's middle; where it runs out of sight before that, one without gradients.
uint32_t planeOf(const Texel& texel, int i)
{
    const float dx = float(i % 4) - 1.5f, dy = float(i / 4) - 1.5f;
    const float share = 1.0f - texel.gx * dx - texel.gy * dy; // q of the middle over the texel's
    if (!(share > Text::kLeastRise)) return roundedHalf(texel.q);
    const float most = share * Text::kBlockGradients;
    return roundedHalf(texel.q * share) | Text::packGradient(texel.gx / most) << 16 | Text::packGradient(texel.gy / most) << 24;
}

/// How much a texel on that plane differs from itself.
float difference(uint32_t plane, const Texel& texel, int i)
{
    const float rise = Text::blockRise(plane, uint32_t(i % 4), uint32_t(i / 4));
    const uint32_t gradients = Text::blockGradients(plane, rise);
    return kOfDistance * std::abs(std::log(texel.q / Text::blockQ(plane, rise))) +
           0.5f * (std::abs(Text::unpackGradient(gradients >> 16) - texel.gx) + std::abs(Text::unpackGradient(gradients >> 24) - texel.gy));
}

/// A block that is being made.
struct Making
{
    std::array<Texel, kTexels> texels;
    std::array<uint32_t, kPlanes> planes{};
    std::array<int, kTexels> on{}; // its plane

    /// The planes but for those from `first` on are taken, of which the sky may be one.
    void choosePlanes(int first)
    {
        float differs[kTexels][kTexels], least[kTexels];
        std::ranges::fill(least, 1e9f);
        std::array<uint32_t, kTexels> offered{};
        for (int a = 0; a < kTexels; ++a)
        {
            if (texels[size_t(a)].sky) continue;
            offered[size_t(a)] = planeOf(texels[size_t(a)], a);
            for (int i = 0; i < kTexels; ++i)
                differs[a][i] = texels[size_t(i)].sky ? 0.0f : difference(offered[size_t(a)], texels[size_t(i)], i);
        }
        for (int plane = first; plane < kPlanes; ++plane)
        {
            int best = -1;
            float bestSum = 1e30f;
            for (int a = 0; a < kTexels; ++a)
            {
                if (texels[size_t(a)].sky) continue;
                float sum = 0.0f;
                for (int i = 0; i < kTexels; ++i) sum += std::min(differs[a][i], least[i]);
                if (sum < bestSum) best = a, bestSum = sum;
            }
            if (best < 0) return; // nothing but sky
            planes[size_t(plane)] = offered[size_t(best)];
            float worst = 0.0f;
            for (int i = 0; i < kTexels; ++i)
            {
                if (texels[size_t(i)].sky) continue;
                if (differs[best][i] < least[i]) least[i] = differs[best][i], on[size_t(i)] = plane;
                worst = std::max(worst, least[i]);
            }
            if (worst < kGoodEnough) return;
        }
    }

    float shareOff(int i) const
    {
        const size_t texel = size_t(i);
        const uint32_t plane = planes[size_t(on[texel])];
        return texels[texel].q / Text::blockQ(plane, Text::blockRise(plane, uint32_t(i % 4), uint32_t(i / 4))) - 1.0f;
    }

    /// The finest precision of each plane that reaches all of its texels, in the plane's own bits.
    void choosePrecisions()
    {
        for (int plane = 0; plane < kPlanes; ++plane)
        {
            if (planes[size_t(plane)] == 0) continue;
            uint32_t precision = 7;
            for (int i = 0; i < kTexels; ++i)
                while (precision > 0 && !texels[size_t(i)].sky && on[size_t(i)] == plane && !reaches(shareOff(i), precision)) --precision;
            planes[size_t(plane)] |= (precision & 3u) | (precision & 4u) << 13;
        }
    }

    static bool reaches(float share, uint32_t precision)
    {
        const float steps = std::round(share / Text::blockUnit(precision));
        return steps >= float(kLeastShare) && steps <= float(kMostShare);
    }

    std::array<uint32_t, 8> packed() const
    {
        std::array<uint32_t, 8> words{planes[0], planes[1], planes[2], planes[3]};
        for (int i = 0; i < kTexels; ++i)
        {
            uint32_t& row = words[size_t(4 + i / 4)];
            const int byte = 8 * (i % 4);
            row |= uint32_t(on[size_t(i)]) << byte;
            if (texels[size_t(i)].sky) continue;
            const float unit = Text::blockUnit(Text::blockPrecision(planes[size_t(on[size_t(i)])]));
            const int steps = std::clamp(int(std::round(shareOff(i) / unit)), kLeastShare, kMostShare);
            row |= (uint32_t(steps) & 63u) << (byte + 2);
        }
        return words;
    }
};

} // namespace

std::array<uint32_t, 8> distanceBlockOf(std::span<const uint32_t, 16> texels)
{
    Making block;
    bool sky = false;
    for (size_t i = 0; i < kTexels; ++i)
    {
        const uint32_t word = texels[i];
        if ((word & 0xffffu) == 0)
            sky = true; // on plane 0, whose word stays 0
        else
            block.texels[i] = {false, Text::halfToReal(word), Text::unpackGradient(word >> 16), Text::unpackGradient(word >> 24)};
    }
    block.choosePlanes(sky ? 1 : 0);
    block.choosePrecisions();
    return block.packed();
}

} // namespace sconce
