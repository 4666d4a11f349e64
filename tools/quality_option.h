#pragma once

#include <optional>

#include "bench/sweep/tune.h"
#include "tools/common.h"

namespace sconce::tools
{

/// --quality FILE|LEVEL: settings of `sconce tune`, or a named level's. What the command line says itself stands.
struct QualityOption
{
    std::string text;
    CLI::App* command = nullptr;

    void add(CLI::App* to);
    /// None where the option isn't given.
    Result<std::optional<PointSettings>> load() const;
    /// target = value, unless the command line has the option or the command doesn't: `capture` keeps no maps in blocks.
    template <class T> void take(const char* option, T& target, const T& value) const
    {
        const CLI::Option* known = command->get_option_no_throw(option);
        if (known && known->count() == 0) target = value;
    }
};

} // namespace sconce::tools
