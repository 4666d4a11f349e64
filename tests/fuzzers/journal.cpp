// A part of a bake: what its records say, and each record.
#include "runtime/bake/bake_journal.h"
#include "tests/fuzzers/input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    using namespace sconce;
    const auto journal = JournalFile::read(testing_support::inputFile(bytes, size));
    if (!journal) return 0;
    for (const BakePart& part : journal->parts()) (void)journal->find(part);
    return 0;
}
