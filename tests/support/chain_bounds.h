#pragma once

#include <span>

#include <gtest/gtest.h>

#include "shaders/shared/pure.h"

namespace sconce::testing_support
{

/// q of a packed plane at an offset in texels, in double precision.
inline double planeAt(uint32_t word, double dx, double dy)
{
    using Text = Pure<float>;
    return double(Text::halfToReal(word)) *
           (1.0 + double(Text::unpackGradient(word >> 16)) * dx + double(Text::unpackGradient(word >> 24)) * dy);
}

/// Expects every texel's plane, at its corners and inside, to lie within the bounds of the cells above it. `words`: one face, all levels.
inline void expectChainBounds(std::span<const uint32_t> words, uint32_t size)
{
    using Text = Pure<float>;
    const int top = Text::chainTop(size);
    const double offsets[] = {-0.5, -0.17, 0.5};
    size_t above = 0, below = 0;
    for (int level = 2; level <= top; level += 2)
        for (uint32_t i = 0; i < size * size; ++i)
        {
            const uint32_t x = i % size, y = i / size, width = Text::chainWidth(size, level);
            const uint32_t at = (y >> level) * width + (x >> level), cell = Text::chainOffset(size, level) - size * size + at;
            const double far = Text::farBoundIn(words[Text::chainNearWords(size, top) + cell / 2], cell);
            const double half = 0.5 * (1 << level);
            for (const double ex : offsets)
                for (const double ey : offsets)
                {
                    const double q = planeAt(words[i], ex, ey);
                    if (q == 0.0)
                    {
                        below += far > 0.0; // sky: no surfel to bound from the front, everything is nearer
                        continue;
                    }
                    const uint32_t bound = words[Text::chainOffset(size, level) + at];
                    above += q > planeAt(bound, x % (1u << level) + 0.5 + ex - half, y % (1u << level) + 0.5 + ey - half);
                    below += q < far;
                }
        }
    EXPECT_EQ(above, 0u) << "surfels that rise above a near bound, faces of " << size;
    EXPECT_EQ(below, 0u) << "surfels behind a far bound, faces of " << size;
}

} // namespace sconce::testing_support
