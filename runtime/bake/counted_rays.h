#pragma once

#include <array>
#include <atomic>

#include "scene/exact_rays.h"

namespace sconce
{

/// Rays to triangles, counted: what a bake asks. Each thread counts in one of a few places, so that they don't wait for each other.
class CountedRays final : public ExactRays
{
public:
    explicit CountedRays(const ExactRays& asked) : rays(asked) {}
    std::optional<Hit> closest(vec3 origin, vec3 direction, float tFar = std::numeric_limits<float>::infinity()) const override
    {
        add();
        return rays.closest(origin, direction, tFar);
    }
    bool occluded(vec3 origin, vec3 direction, float tFar) const override
    {
        add();
        return rays.occluded(origin, direction, tFar);
    }
    const Scene& scene() const override { return rays.scene(); }
    uint64_t count() const
    {
        uint64_t sum = 0;
        for (const Counter& counter : counters) sum += counter.value.load(std::memory_order_relaxed);
        return sum;
    }

private:
    struct alignas(64) Counter
    {
        std::atomic<uint64_t> value{0};
    };

    void add() const
    {
        static std::atomic<uint32_t> threads{0};
        thread_local const uint32_t mine = threads.fetch_add(1, std::memory_order_relaxed);
        counters[mine % counters.size()].value.fetch_add(1, std::memory_order_relaxed);
    }

    const ExactRays& rays;
    mutable std::array<Counter, 16> counters;
};

} // namespace sconce
