#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace sconce
{

/// Calls work(i) for every i in [0, count), on all cores. Each i must write only what is its own: then the result does not depend on the
/// number of threads.
template <class Work> void parallelFor(size_t count, const Work& work)
{
    const size_t threads = std::min<size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
    std::atomic<size_t> next{0};
    auto run = [&]
    {
        for (size_t i = next++; i < count; i = next++) work(i);
    };
    // Declared last, so joined before `next` and `run` go; joining also makes what the threads wrote visible to the caller.
    std::vector<std::jthread> pool;
    for (size_t t = 1; t < threads; ++t) pool.emplace_back(run);
    run();
}

} // namespace sconce
