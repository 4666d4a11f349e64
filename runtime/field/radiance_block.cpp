#include "runtime/field/radiance_block.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/pure.h"

namespace sconce
{
namespace
{

using glm::ivec3;
using glm::uvec4;
using glm::vec3;
using Text = Pure<float>;

constexpr int kTexels = 16, kSteps = 16, kFinest = 1023; // of a block; from one endpoint to the other; the largest endpoint
constexpr float kHalfOfWidened = 31.0f / 64.0f;          // half float's bits for each of the 65,536 that endpoints are widened to

/// What is fitted: texels that count, as bits of half floats, and how much an error of one such bit weighs in each channel.
struct Wanted
{
    std::array<vec3, kTexels> halves;
    int count = 0;
    vec3 weight{1.0f}; // mean over the texels of (change of the channel, relative to the texel's light)^2
};

struct Endpoints
{
    ivec3 first{0}, second{0}; // 10 bits a channel
};

uint32_t halfOf(float value)
{
    return Text::realToHalf(value > 0.0f ? value : 0.0f); // NaN is 0
}

Wanted wantedOf(std::span<const vec3, kTexels> texels, uint32_t counts)
{
    Wanted wanted;
    vec3 slopes(0.0f);
    for (int i = 0; i < kTexels; ++i)
    {
        if ((counts >> i & 1u) == 0) continue;
        vec3& halves = wanted.halves[size_t(wanted.count++)];
        vec3 slope;
        for (int c = 0; c < 3; ++c)
        {
            const uint32_t bits = std::min(halfOf(texels[size_t(i)][c]), 0x7bfeu);
            halves[c] = float(bits);
            slope[c] = Text::halfToReal(bits + 1) - Text::halfToReal(bits);
        }
        const float light = std::max({texels[size_t(i)].x, texels[size_t(i)].y, texels[size_t(i)].z, 1e-6f});
        slopes += slope * slope / (light * light);
    }
    if (wanted.count > 0) wanted.weight = slopes / float(wanted.count);
    return wanted;
}

/// The longest axis of the texels about their mean, in channels scaled by their weights: power iteration.
vec3 axisOf(const Wanted& wanted, const vec3& scale, const vec3& mean)
{
    glm::mat3 spread(0.0f);
    for (int i = 0; i < wanted.count; ++i)
    {
        const vec3 off = scale * (wanted.halves[size_t(i)] - mean);
        spread += glm::outerProduct(off, off);
    }
    vec3 axis = scale; // of light that keeps its colour
    for (int turn = 0; turn < 8; ++turn)
    {
        const vec3 next = spread * axis;
        const float length = glm::length(next);
        if (!(length > 0.0f)) break;
        axis = next / length;
    }
    return glm::length(axis) > 0.0f ? glm::normalize(axis) : vec3(1.0f, 0.0f, 0.0f);
}

int narrowed(float half, float offset)
{
    return std::clamp(int(std::floor(half / kHalfOfWidened / 64.0f + offset)), 0, kFinest);
}

/// The endpoints' 16 colours, as bits of half floats.
std::array<vec3, kSteps> palette(const Endpoints& ends)
{
    std::array<vec3, kSteps> colours;
    for (int c = 0; c < 3; ++c)
    {
        const uint32_t first = Text::widenEndpoint(uint32_t(ends.first[c])), second = Text::widenEndpoint(uint32_t(ends.second[c]));
        for (uint32_t i = 0; i < kSteps; ++i) colours[i][c] = float(Text::blockHalf(first, second, Text::blockStep(i)));
    }
    return colours;
}

/// The nearest of the colours to each texel; the sum of the errors, weighed.
float nearest(const Wanted& wanted, const Endpoints& ends, std::array<uint8_t, kTexels>& index)
{
    const std::array<vec3, kSteps> colours = palette(ends);
    const vec3 way = colours[kSteps - 1] - colours[0];
    const float length = glm::dot(wanted.weight * way, way);
    float sum = 0.0f;
    for (int i = 0; i < wanted.count; ++i)
    {
        const vec3 off = wanted.halves[size_t(i)] - colours[0];
        const float share = length > 0.0f ? glm::dot(wanted.weight * way, off) / length : 0.0f;
        const auto place = uint32_t(std::clamp(int(share * float(kSteps - 1) + 0.5f), 0, kSteps - 1));
        const vec3 error = wanted.halves[size_t(i)] - colours[place];
        index[size_t(i)] = uint8_t(place);
        sum += glm::dot(wanted.weight * error, error);
    }
    return sum;
}

/// The endpoints that fit the texels best by least squares where each keeps its place between them.
bool fitted(const Wanted& wanted, const std::array<uint8_t, kTexels>& index, Endpoints& ends)
{
    float aa = 0.0f, ab = 0.0f, bb = 0.0f;
    vec3 a(0.0f), b(0.0f);
    for (int i = 0; i < wanted.count; ++i)
    {
        const float second = float(Text::blockStep(index[size_t(i)])) / 64.0f, first = 1.0f - second;
        aa += first * first, ab += first * second, bb += second * second;
        a += first * wanted.halves[size_t(i)], b += second * wanted.halves[size_t(i)];
    }
    const float determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-3f)) return false;
    const vec3 first = (bb * a - ab * b) / determinant, second = (aa * b - ab * a) / determinant;
    for (int c = 0; c < 3; ++c) ends.first[c] = narrowed(first[c], 0.0f), ends.second[c] = narrowed(second[c], 0.0f);
    return true;
}

/// The axis' ends, each rounded outwards, so that between them is every texel, however flat the block is.
Endpoints outermost(const Wanted& wanted)
{
    vec3 mean(0.0f);
    for (int i = 0; i < wanted.count; ++i) mean += wanted.halves[size_t(i)];
    mean /= float(wanted.count);
    const vec3 scale = glm::sqrt(wanted.weight), axis = axisOf(wanted, scale, mean);
    float low = 0.0f, high = 0.0f;
    for (int i = 0; i < wanted.count; ++i)
    {
        const float along = glm::dot(axis, scale * (wanted.halves[size_t(i)] - mean));
        low = std::min(low, along), high = std::max(high, along);
    }
    Endpoints ends;
    for (int c = 0; c < 3; ++c)
    {
        const float from = mean[c] + low * axis[c] / std::max(scale[c], 1e-20f), to = mean[c] + high * axis[c] / std::max(scale[c], 1e-20f);
        const bool rises = to >= from;
        ends.first[c] = narrowed(from, rises ? -0.5f : 0.5f);
        ends.second[c] = narrowed(to, rises ? 0.5f : -0.5f);
    }
    return ends;
}

/// Better ones nearby, one channel of one end at a time, until no step of one helps.
void improve(const Wanted& wanted, Endpoints& ends, std::array<uint8_t, kTexels>& index, float error)
{
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round)
    {
        bool better = false;
        for (int which = 0; which < 12; ++which)
        {
            Endpoints tried = ends;
            int& value = (which < 6 ? tried.first : tried.second)[which % 6 / 2];
            value = std::clamp(value + (which % 2 == 0 ? 1 : -1), 0, kFinest);
            std::array<uint8_t, kTexels> places;
            const float now = nearest(wanted, tried, places);
            if (now < error) ends = tried, index = places, error = now, better = true;
        }
        if (!better) return;
    }
}

std::array<uint32_t, 4> packed(Endpoints ends, std::array<uint8_t, kTexels> index)
{
    if (index[0] >= 8) // the first texel's highest bit isn't kept
    {
        std::swap(ends.first, ends.second);
        for (uint8_t& place : index) place = uint8_t(kSteps - 1 - place);
    }
    uint64_t low = Text::kBlockMode, high = 0;
    for (int c = 0; c < 3; ++c) low |= uint64_t(ends.first[c]) << (5 + 10 * c);
    for (int c = 0; c < 3; ++c) low |= uint64_t(ends.second[c]) << (35 + 10 * c); // of the last one 9 bits
    high = uint64_t(ends.second[2]) >> 9 | uint64_t(index[0]) << 1;
    for (int i = 1; i < kTexels; ++i) high |= uint64_t(index[size_t(i)]) << (4 * i);
    return {uint32_t(low), uint32_t(low >> 32), uint32_t(high), uint32_t(high >> 32)};
}

} // namespace

std::array<uint32_t, 4> radianceBlockOf(std::span<const vec3, 16> texels, uint32_t counts)
{
    const Wanted wanted = wantedOf(texels, counts);
    if (wanted.count == 0) return {Text::kBlockMode, 0, 0, 0};
    Endpoints ends = outermost(wanted);
    std::array<uint8_t, kTexels> index;
    float error = nearest(wanted, ends, index);
    for (int turn = 0; turn < 2; ++turn)
    {
        Endpoints tried;
        std::array<uint8_t, kTexels> places;
        if (!fitted(wanted, index, tried)) break;
        if (const float now = nearest(wanted, tried, places); now < error) ends = tried, index = places, error = now;
    }
    improve(wanted, ends, index, error);
    std::array<uint8_t, kTexels> all{};
    for (int i = 0, of = 0; i < kTexels; ++i)
        if ((counts >> i & 1u) != 0) all[size_t(i)] = index[size_t(of++)];
    return packed(ends, all);
}

} // namespace sconce
