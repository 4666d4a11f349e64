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
    if (const auto results = readResults(file); results)
    {
        (void)resultsCsv(*results);
        for (const Json& scene : (*results)["scenes"])
            (void)tune(scene["points"].get<std::vector<Json>>(), {.frameMs = 1.0, .error = 0.1, .bytes = 1e6});
    }
    if (const auto guard = readGuard(file); guard)
        for (const Json& scene : (*guard)["scenes"]) (void)worsened(*guard, scene, scene["points"].get<std::vector<Json>>());
    return 0;
}
