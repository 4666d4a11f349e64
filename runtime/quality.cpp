#include "runtime/quality.h"

#include <algorithm>

namespace sconce
{
namespace
{

// The tracer's own knobs stay at their defaults in every level: fewer ranked probes, hand-offs or a narrower hit rule cost rays and save
// nothing that could be measured. A bounce costs the bake alone.
constexpr QualityLevel kLevels[] = {
    {"draft", 128, 1, {}, 1, 2, true, 1.0f, 1.0f, 1.0f},      {"low", 128, 2, {}, 1, 2, true, 1.0f, 1.0f, 1.0f},
    {"medium", 256, 4, {}, 1, 8, true, 1.0f, 1.0f, 1.0f},     {"high", 416, 4, {}, 2, 32, true, 1.0f, 1.0f, 1.0f},
    {"reference", 512, 8, {}, 8, 32, true, 1.0f, 1.0f, 1.0f},
};

} // namespace

std::span<const QualityLevel> qualityLevels()
{
    return kLevels;
}

const QualityLevel* findQualityLevel(std::string_view name)
{
    const auto found = std::ranges::find(kLevels, name, &QualityLevel::name);
    return found == std::end(kLevels) ? nullptr : found;
}

} // namespace sconce
