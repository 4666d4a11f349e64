#include "tools/knob_options.h"

#include <fmt/format.h>

namespace sconce::tools
{

std::string described(std::string_view what, const std::string& byDefault, const std::string& range)
{
    return fmt::format("{} (default: {}{})", what, byDefault, range.empty() ? "" : fmt::format("; range: {}", range));
}

std::string described(std::string_view what, Words byDefault, const std::string& range)
{
    return described(what, std::string(byDefault.text), range);
}

} // namespace sconce::tools
