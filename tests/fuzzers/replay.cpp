// Gives a target each file of a folder once: the stored inputs, those that once failed among them, without libFuzzer. replay FOLDER
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <vector>

#include "tests/fuzzers/input.h"

int main(int count, char** arguments)
{
    size_t files = 0;
    if (count == 2)
        for (const auto& entry : std::filesystem::directory_iterator(arguments[1]))
        {
            std::ifstream stream(entry.path(), std::ios::binary);
            const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
            std::printf("%s\n", entry.path().c_str());
            std::fflush(stdout); // the one that ends it is named
            LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
            ++files;
        }
    std::printf("%zu inputs\n", files);
    return files > 0 ? 0 : 1;
}
