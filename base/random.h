#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/glm.hpp>

namespace sconce
{

/// A stream of random numbers: its n-th draw depends on (seed, stream) or (seed, stream, sample) alone, so that work may be split over any
/// number of threads and still give the same bytes. Source: Steele, Lea, Flood 2014, "Fast Splittable Pseudorandom Number Generators"
/// (SplitMix64).
class Random
{
public:
    Random(uint64_t seed, uint64_t stream) : state(mix(seed + kStep) ^ mix(stream * kSpread + 1)) {}
    Random(uint64_t seed, uint64_t stream, uint64_t sample) : Random(mix(seed + kStep) ^ stream, sample) {}

    uint64_t bits() { return mix(state += kStep); }
    float uniform() { return float(bits() >> 40) * 0x1p-24f; } // [0,1)
    glm::vec2 uniform2()
    {
        const float x = uniform();
        return {x, uniform()};
    }
    /// Uniform in [0,n). Misuse: n is 0.
    uint64_t below(uint64_t n) { return uint64_t((static_cast<unsigned __int128>(bits()) * n) >> 64); }

    glm::vec3 direction() // uniform on the sphere
    {
        const float y = 1.0f - 2.0f * uniform();
        const float radius = std::sqrt(std::fmax(0.0f, 1.0f - y * y));
        const float angle = 2.0f * std::numbers::pi_v<float> * uniform();
        return {radius * std::cos(angle), y, radius * std::sin(angle)};
    }

private:
    static constexpr uint64_t kStep = 0x9e3779b97f4a7c15ull;   // 2^64 over the golden ratio, odd
    static constexpr uint64_t kSpread = 0xd1342543de82ef95ull; // odd: neighbouring streams start far apart

    static uint64_t mix(uint64_t z)
    {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    uint64_t state;
};

} // namespace sconce
