#include "runtime/quality.h"

#include <algorithm>

namespace sconce
{
namespace
{

// The tracer's own knobs stay at their defaults in every level: fewer ranked probes, hand-offs or a narrower hit rule cost rays and save
// nothing that could be measured. A bounce costs the bake alone.
constexpr QualityLevel kLevels[] = {
    {"draft", 128, 1, {}, 1, 2, true, 0.88f, 0.32f, 1.11f},      {"low", 128, 2, {}, 1, 2, true, 0.96f, 0.32f, 1.02f},
    {"medium", 256, 4, {}, 1, 8, true, 1.00f, 1.00f, 1.00f},     {"high", 416, 4, {}, 2, 32, true, 1.54f, 2.48f, 0.98f},
    {"reference", 512, 8, {}, 8, 32, true, 2.70f, 3.71f, 0.93f},
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
