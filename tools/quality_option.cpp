#include "tools/quality_option.h"

namespace sconce::tools
{

void QualityOption::add(CLI::App* to)
{
    command = to;
    to->add_option("--quality", text,
                   "A file of `sconce tune`, or draft, low, medium, high, reference: sets what the other options don't (default: the other "
                   "options' defaults)")
        ->type_name("FILE|LEVEL");
}

Result<std::optional<PointSettings>> QualityOption::load() const
{
    if (text.empty()) return std::optional<PointSettings>();
    Result<PointSettings> settings = loadQuality(text);
    if (!settings) return settings.error();
    return std::optional(std::move(*settings));
}

} // namespace sconce::tools
