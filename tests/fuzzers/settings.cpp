// What `tune` writes and `--quality` reads, results.json, and a guard's baseline: all JSON, of three schemas.
#include "bench/sweep/guard.h"
#include "bench/sweep/results.h"
#include "bench/sweep/tune.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    using namespace sconce;
    const auto file = testing_support::inputFile(bytes, size);
    (void)loadQuality(file.string());
    (void)readResults(file);
    (void)readGuard(file);
    return 0;
}
