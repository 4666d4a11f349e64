#include "placement/probe_set.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/limits.h"
#include "base/numbers.h"
#include "base/safe_file.h"

namespace sconce
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr uintmax_t kMostBytes = uintmax_t(64) << 20;

/// The shortest decimal that reads back as the same float, so that files show 0.1 and not 0.10000000149011612.
double shortest(float value)
{
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double number = 0.0;
    std::from_chars(text, end, number);
    return number;
}

Json toJson(glm::vec3 value)
{
    return Json::array({shortest(value.x), shortest(value.y), shortest(value.z)});
}

/// Three finite numbers that fit a float.
bool readVector(const Json& json, glm::vec3& value)
{
    if (!json.is_array() || json.size() != 3) return false;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!json[size_t(axis)].is_number()) return false;
        value[axis] = float(json[size_t(axis)].get<double>());
    }
    return finite(value);
}

Error badFile(const std::filesystem::path& file, const std::string& what)
{
    return Error{ErrorCode::badInput, fmt::format("Probe file '{}': {}.", file.string(), what)};
}

std::string noPosition(size_t index)
{
    return fmt::format("probe {} has no \"position\" of three finite numbers", index);
}

std::string readGrid(const Json& json, size_t probes, ProbeGrid& grid)
{
    const auto count = json.is_object() ? json.find("count") : json.end();
    if (!json.is_object() || count == json.end() || !count->is_array() || count->size() != 3)
        return "\"grid\" needs \"count\" as three whole numbers";
    int64_t product = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Json& one = (*count)[size_t(axis)];
        if (!one.is_number_integer() || one.get<int64_t>() < 1 || one.get<int64_t>() > int64_t(kMostProbes))
            return "\"grid\" needs \"count\" as three whole numbers of at least 1";
        grid.count[axis] = int(one.get<int64_t>());
        product *= grid.count[axis];
    }
    if (product != int64_t(probes)) return fmt::format("\"grid\" has {} points but the file has {} probes", product, probes);
    if (!json.contains("origin") || !readVector(json["origin"], grid.origin)) return "\"grid\" needs \"origin\" as three finite numbers";
    if (!json.contains("step") || !readVector(json["step"], grid.step)) return "\"grid\" needs \"step\" as three finite numbers";
    return {};
}

/// The list "probes" of a file and what else it holds. Errors: fileError, badInput; both name the file.
Result<Json> readProbeFile(const std::filesystem::path& file)
{
    std::error_code fault;
    const uintmax_t bytes = std::filesystem::file_size(file, fault);
    std::ifstream in(file, std::ios::binary);
    if (fault || !in) return Error{ErrorCode::fileError, fmt::format("Probe file '{}' could not be read; check the path.", file.string())};
    // Before it is read: a wrong path may name a file of any size.
    if (bytes > kMostBytes) return badFile(file, fmt::format("it has {} bytes, more than any set of {} probes needs", bytes, kMostProbes));
    std::string text(static_cast<size_t>(bytes), '\0');
    if (!in.read(text.data(), std::streamsize(text.size())))
        return Error{ErrorCode::fileError, fmt::format("Probe file '{}' could not be read whole.", file.string())};

    Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (json.is_discarded()) return badFile(file, "it is not valid JSON; write it again with sconce place");
    if (!json.is_object() || !json.contains("probes") || !json["probes"].is_array()) return badFile(file, "it has no list \"probes\"");
    if (json["probes"].size() > kMostProbes)
        return badFile(file, fmt::format("it has {} probes; at most {} can be indexed", json["probes"].size(), kMostProbes));
    return json;
}

bool readPosition(const Json& probe, glm::vec3& position)
{
    return probe.is_object() && probe.contains("position") && readVector(probe["position"], position);
}

} // namespace

Status saveProbes(const ProbeSet& set, const std::filesystem::path& file)
{
    Json json;
    json["method"] = set.method;
    json["scene"] = set.scene;
    json["seed"] = set.seed;
    if (set.grid)
    {
        if (!finite(set.grid->origin) || !finite(set.grid->step))
            return Error{ErrorCode::badArgument, "The probe grid's origin or step is not finite, so it can't be written."};
        json["grid"] = {{"count", {set.grid->count.x, set.grid->count.y, set.grid->count.z}},
                        {"origin", toJson(set.grid->origin)},
                        {"step", toJson(set.grid->step)}};
    }
    json["probes"] = Json::array();
    for (size_t index = 0; index < set.probes.size(); ++index)
    {
        if (!finite(set.probes[index].position))
            return Error{ErrorCode::badArgument, fmt::format("Probe {} has a position that is not finite, so it can't be written.", index)};
        json["probes"].push_back({{"position", toJson(set.probes[index].position)}, {"why", set.probes[index].why}});
    }
    // One probe a line: readable, and differences show.
    std::string text = "{\n";
    for (const auto& [key, value] : json.items())
        if (key != "probes")
            text += fmt::format("  {}: {},\n", Json(key).dump(), value.dump(-1, ' ', false, Json::error_handler_t::replace));
    text += "  \"probes\": [";
    for (size_t index = 0; index < set.probes.size(); ++index)
        text += (index ? ",\n    " : "\n    ") + json["probes"][index].dump(-1, ' ', false, Json::error_handler_t::replace);
    text += set.probes.empty() ? "]\n}\n" : "\n  ]\n}\n";

    return writeText(file, text);
}

Result<ProbeSet> loadProbes(const std::filesystem::path& file)
{
    const auto bad = [&file](const std::string& what) { return badFile(file, what); };
    const Result<Json> read = readProbeFile(file);
    if (!read) return read.error();
    const Json& json = *read;
    const Json& list = json["probes"];
    ProbeSet set;
    for (size_t index = 0; index < list.size(); ++index)
    {
        PlacedProbe probe;
        if (!readPosition(list[index], probe.position)) return bad(noPosition(index));
        if (list[index].contains("why"))
        {
            if (!list[index]["why"].is_string()) return bad(fmt::format("\"why\" of probe {} is not text", index));
            probe.why = list[index]["why"].get<std::string>();
        }
        set.probes.push_back(std::move(probe));
    }
    for (const auto& [key, into] : {std::pair{"method", &set.method}, std::pair{"scene", &set.scene}})
        if (json.contains(key))
        {
            if (!json[key].is_string()) return bad(fmt::format("\"{}\" is not text", key));
            *into = json[key].get<std::string>();
        }
    if (json.contains("seed"))
    {
        if (!json["seed"].is_number_unsigned()) return bad("\"seed\" is not a whole number of at least 0");
        set.seed = json["seed"].get<uint64_t>();
    }
    if (json.contains("grid") && !json["grid"].is_null())
    {
        set.grid.emplace();
        if (const std::string what = readGrid(json["grid"], list.size(), *set.grid); !what.empty()) return bad(what);
    }
    return set;
}

Result<std::vector<Pin>> loadPins(const std::filesystem::path& file)
{
    const Result<Json> json = readProbeFile(file);
    if (!json) return json.error();
    const Json& list = (*json)["probes"];
    std::vector<Pin> pins;
    for (size_t index = 0; index < list.size(); ++index)
    {
        const Json& one = list[index];
        Pin pin;
        if (!readPosition(one, pin.position)) return badFile(file, noPosition(index));
        if (one.contains("pin"))
        {
            const std::string kind = one["pin"].is_string() ? one["pin"].get<std::string>() : one["pin"].dump(-1, ' ', true);
            if (kind != "keep" && kind != "add" && kind != "forbid")
                return badFile(file, fmt::format("\"pin\" of probe {} is {}; give \"keep\", \"add\" or \"forbid\"", index, kind));
            pin.kind = kind == "keep" ? Pin::Kind::keep : kind == "add" ? Pin::Kind::add : Pin::Kind::forbid;
        }
        const bool forbids = pin.kind == Pin::Kind::forbid;
        if (forbids != one.contains("radius"))
            return badFile(file, forbids ? fmt::format("probe {} forbids a place without a \"radius\" in metres", index)
                                         : fmt::format("probe {} has a \"radius\" but forbids nothing; give \"pin\": \"forbid\"", index));
        if (forbids)
        {
            const double radius = one["radius"].is_number() ? one["radius"].get<double>() : 0.0;
            pin.radius = float(radius);
            if (!(pin.radius > 0.0f && std::isfinite(pin.radius)))
                return badFile(file, fmt::format("\"radius\" of probe {} is not a length above 0 metres", index));
        }
        pins.push_back(pin);
    }
    return pins;
}

} // namespace sconce
