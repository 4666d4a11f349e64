#include "tools/quality_option.h"

#include <fmt/format.h>

namespace sconce::tools
{

void QualityOption::add(CLI::App* to)
{
    command = to;
    std::string levels;
    for (const QualityLevel& level : qualityLevels()) levels.append(levels.empty() ? "" : ", ").append(level.name);
    to->add_option("--quality", text,
                   described(fmt::format("A file of `sconce tune`, or {}: sets what the other options don't", levels),
                             words("the other options' defaults")))
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
