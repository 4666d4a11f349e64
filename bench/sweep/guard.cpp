#include "bench/sweep/guard.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "base/parsed_json.h"

namespace sconce
{
namespace
{

constexpr int kGuardVersion = 1;

struct Margin
{
    const char* figure;
    double relative, absolute; // worse is more than before * (1 + relative) + absolute
};
// Counts and bytes are exact, so their margins are for intended small changes. A frame's error holds its noise, which another random
// number a pixel moves by a few per cent.
constexpr Margin kMargins[] = {{"reads", 0.03, 0.0},         {"wrong_rays", 0.05, 0.001},  {"wrong_rays_02", 0.05, 0.001},
                               {"false", 0.05, 0.001},       {"leak", 0.05, 0.001},        {"unresolved", 0.05, 0.001},
                               {"bytes", 0.01, 0.0},         {"beauty.relmse", 0.10, 0.0}, {"beauty.flip", 0.05, 0.0},
                               {"glossy.relmse", 0.10, 0.0}, {"diffuse.relmse", 0.10, 0.0}};

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::optional<std::string> wrongOf(const Json& point)
{
    if (!point.contains("wrong") || !point["wrong"].is_string()) return std::nullopt;
    return point["wrong"].get<std::string>();
}

} // namespace

Json emptyGuard()
{
    Json guard = {{"guard", kGuardVersion}, {"margins", Json::array()}, {"scenes", Json::array()}};
    for (const Margin& margin : kMargins)
        guard["margins"].push_back({{"figure", margin.figure}, {"relative", margin.relative}, {"absolute", margin.absolute}});
    return guard;
}

Json guardedScene(const std::string& name, const std::string& source, const Json& options, const std::vector<Json>& points)
{
    Json scene = {{"name", name}, {"source", source}, {"options", options}, {"points", Json::array()}};
    for (const Json& point : points)
    {
        Json kept = {{"id", point["id"]}};
        for (const Margin& margin : kMargins)
            if (const auto figure = figureOf(point, margin.figure)) kept[margin.figure] = *figure;
        if (wrongOf(point)) kept["wrong"] = *wrongOf(point);
        scene["points"].push_back(std::move(kept));
    }
    return scene;
}

namespace
{

/// Whether worsened() finds what it reads.
bool isGuard(const Json& json)
{
    if (!json.is_object() || json.value("guard", Json()) != kGuardVersion) return false;
    const Json margins = json.value("margins", Json()), scenes = json.value("scenes", Json());
    const auto isMargin = [](const Json& margin) {
        return holdsTexts(margin, {"figure"}) && margin.value("relative", Json()).is_number() &&
               margin.value("absolute", Json()).is_number();
    };
    const auto isPoint = [](const Json& point)
    {
        return holdsTexts(point, {"id"}) &&
               std::ranges::all_of(
                   point.items(), [](const auto& item)
                   { return item.key() == "id" || item.key() == "wrong" ? item.value().is_string() : item.value().is_number(); });
    };
    const auto isScene = [&](const Json& scene)
    {
        return holdsTexts(scene, {"name", "source"}) && scene.value("options", Json()).is_object() &&
               scene.value("points", Json()).is_array() && std::ranges::all_of(scene["points"], isPoint);
    };
    return margins.is_array() && scenes.is_array() && std::ranges::all_of(margins, isMargin) && std::ranges::all_of(scenes, isScene);
}

} // namespace

Result<Json> readGuard(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream)
        return Error{ErrorCode::fileError,
                     fmt::format("File '{}' can't be read; give a baseline of `sconce bench --baseline`.", file.string())};
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return parsed;
    const Json& json = *parsed;
    if (!isGuard(json))
        return Error{ErrorCode::badInput,
                     fmt::format("File '{}' is no baseline of version {}; write it again with `sconce bench --baseline`.", file.string(),
                                 kGuardVersion)};
    return parsed;
}

std::vector<std::string> worsened(const Json& guard, const Json& scene, const std::vector<Json>& points)
{
    std::vector<std::string> sentences;
    for (const Json& before : scene["points"])
    {
        const std::string id = before["id"], where = fmt::format("{}, {}: ", scene["name"].get<std::string>(), id);
        const Json* now = nullptr;
        for (const Json& point : points)
            if (point["id"] == id) now = &point;
        if (!now)
        {
            sentences.push_back(fmt::format("{}not measured; the baseline has it.", where));
            continue;
        }
        // An opponent may be as wrong as it was: its figures below judge it.
        if (const auto wrong = wrongOf(*now); wrong && !wrongOf(before)) sentences.push_back(fmt::format("{}{}", where, *wrong));
        for (const Json& margin : guard["margins"])
        {
            const std::string name = margin["figure"];
            if (!before.value(name, Json()).is_number()) continue;
            const double was = before[name];
            const double most = was * (1.0 + margin["relative"].get<double>()) + margin["absolute"].get<double>();
            const auto is = figureOf(*now, name);
            if (!is)
                sentences.push_back(fmt::format("{}{} was not measured; the baseline has {}.", where, name, number(was)));
            else if (!(*is <= most))
                sentences.push_back(fmt::format("{}{} is {}, worse than the baseline's {} by more than its margin (at most {}).", where,
                                                name, number(*is), number(was), number(most)));
        }
    }
    return sentences;
}

} // namespace sconce
