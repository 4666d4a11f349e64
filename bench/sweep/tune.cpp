#include "bench/sweep/tune.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "base/listed.h"
#include "base/parsed_json.h"
namespace sconce
{
namespace
{

constexpr int kQualityVersion = 1;
constexpr const char* kPrices[] = {"frame_ms",   "trace_ms",      "bytes",         "probes",
                                   "wrong_rays", "glossy.relmse", "beauty.relmse", "beauty.flip"};

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

/// By how much a point misses the goal: the product of the ratios of what is too much. 1: nothing.
std::optional<double> excess(const Json& point, const TuneGoal& goal)
{
    double product = 1.0;
    const std::pair<std::optional<double>, std::string_view> limits[] = {
        {goal.frameMs, "frame_ms"}, {goal.error, goal.metric}, {goal.bytes, "bytes"}};
    for (const auto& [limit, name] : limits)
    {
        if (!limit) continue;
        const auto figure = figureOf(point, name);
        if (!figure) return {};
        if (*figure > *limit) product *= *limit > 0.0 ? *figure / *limit : std::numeric_limits<double>::infinity();
    }
    return product;
}

} // namespace

Result<Json> tune(const std::vector<Json>& points, const TuneGoal& goal)
{
    if (!goal.frameMs && !goal.error && !goal.bytes)
        return Error{ErrorCode::badArgument, "There is nothing to tune for; give --time, --error or --memory."};
    const std::string wanted = goal.error ? "frame_ms" : goal.metric;
    const Json *best = nullptr, *nearest = nullptr;
    double bestFigure = 0.0, nearestExcess = 0.0;
    for (const Json& point : points)
    {
        if (point["method"] != "ours" || (point.contains("wrong") && point["wrong"].is_string())) continue;
        if (point.value("knob", "") == "distance bits") continue; // files of light fields have all
        const auto over = excess(point, goal);
        const auto figure = figureOf(point, wanted);
        if (!over || !figure) continue;
        // Of those that keep to the goal the best; where none does, the one that misses it least is named.
        if (*over == 1.0 && (!best || *figure < bestFigure)) best = &point, bestFigure = *figure;
        if (!nearest || *over < nearestExcess) nearest = &point, nearestExcess = *over;
    }
    if (best) return *best;
    if (!nearest)
        return Error{ErrorCode::badInput, "No point of ours has the figures that are asked for; measure the scene with `sconce bench`."};
    std::string has;
    for (const std::string_view name : {std::string_view("frame_ms"), std::string_view(goal.metric), std::string_view("bytes")})
        if (const auto figure = figureOf(*nearest, name)) has += fmt::format("{}{} {}", has.empty() ? "" : ", ", name, number(*figure));
    return Error{ErrorCode::badInput,
                 fmt::format("No measured settings keep to that; the nearest, {}, have {}.", (*nearest)["id"].get<std::string>(), has)};
}

Json qualityFile(const std::string& scene, const Json& point)
{
    Json file = {
        {"quality", kQualityVersion}, {"scene", scene}, {"point", point["id"]}, {"settings", point["settings"]}, {"price", Json::object()}};
    for (const char* name : kPrices)
        if (const auto figure = figureOf(point, name)) file["price"][name] = *figure;
    return file;
}

void applyLevel(PointSettings& settings, const QualityLevel& level)
{
    settings.resolution = level.resolution;
    settings.bounces = level.bounces;
    settings.compact = level.compact;
    settings.quality = level.quality;
    settings.frame.glossyRays = level.glossyRays;
    settings.frame.traceEvery = level.traceEvery;
    settings.frame.surfaceProbes = level.surfaceProbes;
    settings.frame.areaSamples = level.areaSamples;
    settings.frame.effects.denoise = level.denoise;
    settings.frame.raysBelow = level.raysBelow;
    settings.frame.effects.tracedDiffuse = level.tracedDiffuse;
}

Result<PointSettings> loadQuality(const std::string& fileOrLevel)
{
    if (const QualityLevel* level = findQualityLevel(fileOrLevel))
    {
        PointSettings settings;
        applyLevel(settings, *level);
        return settings;
    }
    if (!std::filesystem::exists(fileOrLevel))
        return Error{ErrorCode::badArgument, fmt::format("--quality: '{}' is neither a file nor a level ({}).", fileOrLevel,
                                                         listed(qualityLevels(), &QualityLevel::name))};
    std::ifstream stream(fileOrLevel);
    if (!stream) return Error{ErrorCode::fileError, fmt::format("File '{}' can't be read.", fileOrLevel)};
    const auto parsed = parsedJson<Json>(stream, fileOrLevel);
    if (!parsed) return parsed.error();
    const Json& json = *parsed;
    if (json.is_discarded() || !json.is_object() || json.value("quality", Json()) != kQualityVersion || !json.contains("settings"))
        return Error{ErrorCode::badInput, fmt::format("File '{}' holds no settings of `sconce tune`.", fileOrLevel)};
    Result<PointSettings> settings = settingsFrom("ours", json["settings"]);
    if (!settings) return Error{settings.error().code, fmt::format("File '{}': {}", fileOrLevel, settings.error().message)};
    return settings;
}

} // namespace sconce
