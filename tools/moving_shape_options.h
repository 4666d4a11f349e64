#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/result.h"
#include "runtime/sconce.h"

namespace sconce::tools
{

/// --shapes: what is in the picture, but not in the scene that the field was baked from.
struct MovingShapeOptions
{
    std::string file;

    void add(CLI::App* command);
    /// None without a file. Errors: fileError, badInput: names the file, the shape and what is wrong with it.
    Result<std::vector<MovingShape>> read() const;
};

} // namespace sconce::tools
