// Pictures that `sconce compare` and others are given.
#include "bench/reference/image_io.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    (void)sconce::readExr(sconce::testing_support::inputFile(bytes, size));
    return 0;
}
