#include "tests/support/files.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <unistd.h>

namespace sconce::testing_support
{

TestFolder::TestFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "sconce_test_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path = name;
}

TestFolder::~TestFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

std::string readText(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void writeText(const std::filesystem::path& file, const std::string& text)
{
    std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

std::filesystem::path scenesFolder()
{
    const char* folder = std::getenv("SCONCE_SCENES");
    return folder != nullptr && *folder != '\0' ? folder : SCONCE_SCENES_DEFAULT;
}

} // namespace sconce::testing_support
