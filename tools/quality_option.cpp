#include "tools/quality_option.h"

#include <fmt/format.h>

#include "base/listed.h"
namespace sconce::tools
{

void QualityOption::add(CLI::App* to)
{
    command = to;
    to->add_option("--quality", text,
                   described(fmt::format("A file of `sconce tune`, or {}: sets what the other options don't",
                                         listed(qualityLevels(), &QualityLevel::name)),
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
