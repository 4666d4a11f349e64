// Rays of `sconce trace`, as text, and of sconce_replay, as bytes.
#include "bench/race/ray_file.h"
#include "tests/fuzzers/input.h"
#include "tools/ray_files.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    const auto file = sconce::testing_support::inputFile(bytes, size);
    (void)sconce::tools::readRays(file);
    (void)sconce::loadRays(file);
    return 0;
}
