#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sconce::testing_support
{

struct CommandResult
{
    int exit = -1;         // -1: it did not exit by itself
    int signal = 0;        // that ended it
    bool timedOut = false; // it computed for longer than it may
    std::string out, err;
};

struct CommandLimits
{
    /// Of all its threads together: a busy machine doesn't use it up. What hangs without computing is ended by ctest's limit.
    double processorSeconds = 600.0;
    std::string interruptWhen; // it gets SIGINT as soon as its stderr holds this; empty: never
};

/// Runs the `sconce` command of this build under the Vulkan validation layer, whose messages fail the test.
CommandResult sconceCommand(const std::vector<std::string>& arguments, const CommandLimits& limits = {});

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

/// Folder of the real scenes: the environment's SCONCE_SCENES, else the configured one; may not exist.
std::filesystem::path scenesFolder();

} // namespace sconce::testing_support
