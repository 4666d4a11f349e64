// probes.json, and pins of the same form.
#include "placement/probe_set.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    const auto file = sconce::testing_support::inputFile(bytes, size);
    (void)sconce::loadProbes(file);
    (void)sconce::loadPins(file);
    return 0;
}
