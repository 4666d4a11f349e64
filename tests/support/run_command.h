#pragma once

#include <string>
#include <vector>

#include "tests/support/files.h"

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
    std::string interruptWhen = {}; // it gets SIGINT as soon as its stderr holds this; empty: never
};

/// Runs the `sconce` command of this build under the Vulkan validation layer, whose messages fail the test.
CommandResult sconceCommand(const std::vector<std::string>& arguments, const CommandLimits& limits = {});

} // namespace sconce::testing_support
