#pragma once

#include <filesystem>
#include <string>

namespace sconce::testing_support
{

/// A folder of the test's own, empty at first, removed at the end.
class TestFolder
{
public:
    TestFolder();
    ~TestFolder();
    std::filesystem::path path;
    std::string operator/(const std::string& name) const { return (path / name).string(); }
};

std::string readText(const std::filesystem::path& file);
void writeText(const std::filesystem::path& file, const std::string& text);

/// Folder of the real scenes: the environment's SCONCE_SCENES, else the one of the build's setting; may not exist.
std::filesystem::path scenesFolder();

} // namespace sconce::testing_support
