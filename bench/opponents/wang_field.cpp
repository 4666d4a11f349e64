#include "bench/opponents/wang_field.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/parallel.h"
#include "bench/opponents/octahedral_field.h"
#include "runtime/field/tracer_cpu.h"

namespace sconce
{
namespace
{

constexpr uint32_t kSky = 0x7c00u;         // half of infinity: nothing is seen
constexpr uint32_t kFewestCells = 8;       // a side of the coarsest level
constexpr uint32_t kNothing = 0x0000ffffu; // bounds of no texel: least above any half, greatest 0

struct Faces // one probe's cube faces at one level: (min r, max r) a texel, halves
{
    uint32_t size;
    std::vector<uint32_t> bounds; // [face][y][x]
};

uint32_t join(uint32_t a, uint32_t b)
{
    return std::min(a & 0xffffu, b & 0xffffu) | (std::max(a >> 16, b >> 16) << 16);
}

using Text = twin::LightFieldTwin<float>;

/// Bounds of the radial distance over a face texel: its plane's q is linear, so q's extremes are at corners, and r = |(u, v, 1)| / q.
uint32_t radialBounds(Text& text, uint32_t word, uint32_t x, uint32_t y, uint32_t size)
{
    const uint32_t q = text.texelBounds(word); // q's maximum, and its minimum in the upper half
    // Sky is bounded as infinitely far, so that a ray marches past it.
    if ((word & 0xffffu) == 0) return kSky | (kSky << 16);
    const float low = 2.0f / float(size);
    const auto nearest = [&](uint32_t i) // of the interval [i, i + 1] of texels, in [-1, 1], to the face's middle
    {
        const float a = low * float(i) - 1.0f, b = low * float(i + 1) - 1.0f;
        return a > 0.0f ? a : std::min(b, 0.0f);
    };
    const auto furthest = [&](uint32_t i) { return std::max(std::abs(low * float(i) - 1.0f), std::abs(low * float(i + 1) - 1.0f)); };
    const auto length = [](float u, float v) { return std::sqrt(1.0f + u * u + v * v); };
    // A few roundings wider on either side, and rounded outwards to halves: bounds must hold what they bound.
    const float least = length(nearest(x), nearest(y)) / text.halfToReal(q) * 0.999999f;
    const float qLeast = text.halfToReal(q >> 16);
    const float greatest = qLeast > 0.0f ? length(furthest(x), furthest(y)) / qLeast * 1.000001f : 65504.0f;
    return text.realToHalfDown(least) | (text.realToHalfUp(greatest) << 16);
}

Faces halved(const Faces& finer)
{
    Faces coarser{finer.size / 2, std::vector<uint32_t>(size_t(6) * finer.size / 2 * finer.size / 2, kNothing)};
    for (uint32_t row = 0; row < 6 * coarser.size; ++row)
        for (uint32_t x = 0; x < coarser.size; ++x)
            for (uint32_t child = 0; child < 4; ++child)
            {
                uint32_t& bounds = coarser.bounds[size_t(row) * coarser.size + x];
                bounds = join(bounds, finer.bounds[size_t(2 * row + child / 2) * finer.size + 2 * x + child % 2]);
            }
    return coarser;
}

/// Adds a level of the faces to the octahedral level of the same size: each face texel to every octahedral texel that its image touches.
/// No face texel straddles an octant (the face's middle lines are texel borders), so its image is a quadrangle within one; its corners'
/// bounding box covers it.
void resample(Text& text, const Faces& faces, uint32_t* out)
{
    const int size = int(faces.size);
    const float step = 2.0f / float(size);
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
            {
                const glm::vec3 middle = text.faceDirection(face, {step * (float(x) + 0.5f) - 1.0f, step * (float(y) + 0.5f) - 1.0f, 1.0f});
                glm::vec2 low(1e9f), high(-1e9f);
                for (int corner = 0; corner < 4; ++corner)
                {
                    const glm::vec3 d =
                        text.faceDirection(face, {step * float(x + (corner & 1)) - 1.0f, step * float(y + (corner >> 1)) - 1.0f, 1.0f});
                    const float sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
                    glm::vec2 e = glm::vec2(d) / sum;
                    if (middle.z < 0.0f) // the octant is the middle's: a corner on its border has two images
                        e = (1.0f - glm::abs(glm::vec2(e.y, e.x))) *
                            glm::vec2(middle.x < 0.0f ? -1.0f : 1.0f, middle.y < 0.0f ? -1.0f : 1.0f);
                    const glm::vec2 pixel = 0.5f * float(size) * (e + 1.0f);
                    low = glm::min(low, pixel);
                    high = glm::max(high, pixel);
                }
                constexpr float kRounding = 1e-3f; // texels
                const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low - kRounding)), 0, size - 1);
                const glm::ivec2 last = glm::clamp(glm::ivec2(glm::floor(high + kRounding)), 0, size - 1);
                const uint32_t bounds = faces.bounds[(size_t(face) * faces.size + y) * faces.size + x];
                for (int v = first.y; v <= last.y; ++v)
                    for (int u = first.x; u <= last.x; ++u) out[v * size + u] = join(out[v * size + u], bounds);
            }
}

/// Level 0 and radiance (null: the faces have none): what lies in each octahedral texel's direction.
void resampleSurface(Text& text, const FieldData& faces, size_t probe, uint32_t* words, uint32_t* radiance)
{
    const uint32_t size = faces.info.faceSize, wordsPerFace = faces.info.wordsPerProbe / 6;
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
        {
            const glm::vec3 d = text.directionFromOctahedral((glm::vec2(x, y) + 0.5f) / float(size));
            const int face = text.dominantFace(d);
            const glm::vec3 uvw = text.faceCoordinates(face, d);
            const glm::vec2 at = glm::clamp((0.5f * glm::vec2(uvw) / uvw.z + 0.5f) * float(size), 0.0f, float(size) - 0.001f);
            const glm::uvec2 texel(at);
            const uint32_t word = faces.distance[probe * faces.info.wordsPerProbe + face * wordsPerFace + texel.y * size + texel.x];
            uint32_t& out = words[y * size + x];
            out = kSky;
            if ((word & 0xffffu) != 0)
            {
                const glm::vec2 off = at - glm::vec2(texel) - 0.5f;
                const float slope = text.unpackGradient(word >> 16) * off.x + text.unpackGradient(word >> 24) * off.y;
                const float q = text.halfToReal(word) * (1.0f + slope);
                out = text.realToHalf(1.0f / (q * uvw.z)) | (text.packNormal8(text.texelNormal(face, at, word)) << 16);
            }
            const size_t light = ((probe * 6 + size_t(face)) * size + texel.y) * size + texel.x;
            if (radiance) radiance[y * size + x] = faces.radiance[light];
        }
}

} // namespace

Result<FieldData> wangField(const FieldData& faces)
{
    if (inBlocks(faces.info))
        return Error{ErrorCode::badInput,
                     "Tracer wang makes its maps from texels, and this field's are in blocks. Bake without --compact."};
    const uint32_t size = faces.info.faceSize;
    if (!std::has_single_bit(size) || size < 2 * kFewestCells)
        return Error{ErrorCode::badInput, fmt::format("Tracer wang needs cube faces whose size is a power of two from 16; these have {} "
                                                      "texels a side. Bake at a resolution that is a power of two.",
                                                      size)};
    const uint32_t topLevel = uint32_t(std::countr_zero(size / kFewestCells));
    uint32_t words = 0;
    for (uint32_t level = 0; level <= topLevel; ++level) words += (size >> level) * (size >> level);
    FieldData made = octahedralCopy(faces, size, topLevel, words);
    std::ranges::fill(made.distance, kNothing);
    parallelFor(faces.probes.size(),
                [&](size_t probe)
                {
                    Text text(faces, {});
                    uint32_t* out = made.distance.data() + probe * words;
                    resampleSurface(text, faces, probe, out, made.radiance.empty() ? nullptr : made.radiance.data() + probe * size * size);
                    Faces chain{size, std::vector<uint32_t>(size_t(6) * size * size)};
                    for (uint32_t face = 0; face < 6; ++face)
                        for (uint32_t i = 0; i < size * size; ++i)
                        {
                            const uint32_t* from =
                                faces.distance.data() + probe * faces.info.wordsPerProbe + face * (faces.info.wordsPerProbe / 6);
                            chain.bounds[size_t(face) * size * size + i] = radialBounds(text, from[i], i % size, i / size, size);
                        }
                    for (uint32_t level = 1; level <= topLevel; ++level)
                    {
                        out += (size >> (level - 1)) * (size >> (level - 1));
                        chain = halved(chain);
                        resample(text, chain, out);
                    }
                });
    return made;
}

} // namespace sconce
