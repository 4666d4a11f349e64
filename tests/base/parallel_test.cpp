#include "base/parallel.h"

#include <atomic>
#include <vector>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

TEST(ParallelFor, DoesEveryItemOnce)
{
    for (const size_t count : {size_t(0), size_t(1), size_t(2), size_t(1000)})
    {
        std::vector<std::atomic<int>> done(count);
        parallelFor(count, [&](size_t i) { ++done[i]; });
        for (size_t i = 0; i < count; ++i) ASSERT_EQ(done[i], 1) << i << " of " << count;
    }
}

} // namespace
} // namespace sconce
