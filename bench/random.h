#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace sconce
{

/// A stream of numbers that depends only on (seed, item, sample), so that any number of threads draws the same ones.
/// PCG32 (O'Neill 2014) started from a SplitMix64 hash (Steele, Lea and Flood 2014).
class Random
{
public:
    Random(uint64_t seed, uint64_t item, uint64_t sample) : state(mix(mix(mix(seed) ^ item) ^ sample)), increment(mix(state) | 1u) {}

    uint32_t bits()
    {
        const uint64_t old = state;
        state = old * 6364136223846793005ull + increment;
        const auto shifted = static_cast<uint32_t>(((old >> 18u) ^ old) >> 27u);
        const auto turn = static_cast<uint32_t>(old >> 59u);
        return (shifted >> turn) | (shifted << ((32u - turn) & 31u));
    }
    float uniform() { return static_cast<float>(bits() >> 8) * 0x1p-24f; } // [0,1)
    glm::vec2 uniform2()
    {
        const float x = uniform();
        return {x, uniform()};
    }
    uint32_t below(uint32_t count) { return static_cast<uint32_t>((static_cast<uint64_t>(bits()) * count) >> 32); }

private:
    static uint64_t mix(uint64_t x)
    {
        x += 0x9e3779b97f4a7c15ull;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
        return x ^ (x >> 31);
    }
    uint64_t state;
    uint64_t increment;
};

} // namespace sconce
