#include "runtime/bake/host_memory.h"

#include <unistd.h>

#include <gtest/gtest.h>

namespace sconce
{
namespace
{

// The kernel's word for all memory comes another way (sysconf): what is free is a part of it, and more than nothing.
TEST(HostMemory, WhatIsFreeIsAPartOfWhatThereIs)
{
    const uint64_t all = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGE_SIZE));
    EXPECT_GT(freeHostBytes(), uint64_t(1) << 20);
    EXPECT_LE(freeHostBytes(), all);
}

} // namespace
} // namespace sconce
