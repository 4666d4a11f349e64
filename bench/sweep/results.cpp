#include "bench/sweep/results.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

#include <unistd.h>

#include <fmt/format.h>

#include "base/parsed_json.h"
#include "base/safe_file.h"
#include "runtime/vulkan/host_vulkan.h"

namespace sconce
{
namespace
{

constexpr int kSchema = 2;

constexpr const char* kColumns[] = {"frame_ms",     "trace_ms",      "reads",         "wrong_rays",  "wrong_rays_02",
                                    "unresolved",   "bytes",         "probes",        "bake_s",      "place_s",
                                    "beauty.mse",   "beauty.relmse", "beauty.flip",   "diffuse.mse", "diffuse.relmse",
                                    "diffuse.flip", "glossy.mse",    "glossy.relmse", "glossy.flip"};

std::string firstAfter(const char* file, std::string_view key, char separator)
{
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
        if (line.starts_with(key))
            if (const size_t at = line.find(separator); at != std::string::npos)
            {
                std::string value = line.substr(at + 1);
                std::erase(value, '"');
                return value.substr(std::min(value.find_first_not_of(" \t"), value.size()));
            }
    return "";
}

std::string utcNow()
{
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts = {};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

std::optional<double> numberAt(const Json& json, std::initializer_list<std::string_view> path)
{
    const Json* at = &json;
    for (const std::string_view key : path)
    {
        if (!at->is_object()) return {};
        const auto found = at->find(key);
        if (found == at->end()) return {};
        at = &*found;
    }
    if (!at->is_number()) return {};
    return at->get<double>();
}

std::string quoted(const std::string& text)
{
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text)
    {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
    return out;
}

} // namespace

Json resultsHead(const std::string& version, const std::string& build, const std::string& command, const std::string& deviceName)
{
    const double memoryMb = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)) / 1e6;
    Json head = {{"schema", kSchema},     {"version", version},  {"build", build},
                 {"commands", {command}}, {"started", utcNow()}, {"seconds", 0.0}};
    head["machine"] = {{"cpu", firstAfter("/proc/cpuinfo", "model name", ':')},
                       {"cores", std::thread::hardware_concurrency()},
                       {"memory_mb", std::round(memoryMb)},
                       {"os", firstAfter("/etc/os-release", "PRETTY_NAME", '=')}};
    head["device"] = {{"name", deviceName}};
    if (const auto devices = deviceSummary())
        for (const DeviceSummary& each : *devices)
            if (each.name == deviceName)
                head["device"].update(Json{{"kind", each.kind}, {"driver", each.driver}, {"api", each.apiVersion}});
    head["scenes"] = Json::array();
    return head;
}

std::optional<double> figureOf(const Json& point, std::string_view name)
{
    if (name == "frame_ms" || name == "trace_ms") return numberAt(point, {name, "median"});
    if (name == "reads") return numberAt(point, {"rays", "reads_mean"});
    if (name == "unresolved" || name == "false" || name == "leak") return numberAt(point, {"rays", name});
    if (name == "bytes") return numberAt(point, {"bytes", "total"});
    if (name == "wrong_rays" || name == "wrong_rays_02") // within 1 % of the diagonal, 0.2 %
    {
        const auto right = numberAt(point, {"rays", name == "wrong_rays" ? "right_1" : "right_02"});
        return right ? std::optional(1.0 - *right) : std::nullopt;
    }
    if (const size_t dot = name.find('.'); dot != std::string_view::npos)
        return numberAt(point, {"error", name.substr(0, dot), name.substr(dot + 1)});
    return numberAt(point, {name});
}

std::string resultsCsv(const Json& results)
{
    std::ostringstream csv;
    csv << "scene,id,method,knob,value";
    for (const char* column : kColumns) csv << "," << column;
    csv << ",wrong\n";
    csv.precision(9);
    for (const Json& scene : results["scenes"])
        for (const Json& point : scene["points"])
        {
            csv << quoted(scene["name"]);
            for (const char* key : {"id", "method", "knob", "value"}) csv << "," << quoted(point[key]);
            for (const char* column : kColumns)
            {
                csv << ",";
                if (const auto figure = figureOf(point, column)) csv << *figure;
            }
            csv << "," << (point.contains("wrong") && point["wrong"].is_string() ? quoted(point["wrong"]) : "") << "\n";
        }
    return csv.str();
}

Status writeResults(const Json& results, const std::filesystem::path& folder)
{
    const std::string text = results.dump(1, ' ', false, Json::error_handler_t::replace);
    if (auto status = writeText(folder / "results.json", text + "\n"); !status) return status;
    return writeText(folder / "results.csv", resultsCsv(results));
}

bool holdsTexts(const Json& object, std::initializer_list<const char*> keys)
{
    return object.is_object() && std::ranges::all_of(keys, [&](const char* key) { return object.value(key, Json()).is_string(); });
}

namespace
{

/// Whether scenes and points can be told apart, and each point be asked for its figures.
bool isResults(const Json& json)
{
    if (!json.is_object() || json.value("schema", Json()) != kSchema) return false;
    const Json scenes = json.value("scenes", Json());
    const auto isPoint = [](const Json& point) { return holdsTexts(point, {"id", "method", "knob", "value"}); };
    const auto isScene = [&](const Json& scene)
    { return holdsTexts(scene, {"name"}) && scene.value("points", Json()).is_array() && std::ranges::all_of(scene["points"], isPoint); };
    return scenes.is_array() && std::ranges::all_of(scenes, isScene);
}

} // namespace

Result<Json> readResults(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream)
        return Error{ErrorCode::fileError, fmt::format("File '{}' can't be read; give the results.json of a bench.", file.string())};
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return parsed;
    const Json& json = *parsed;
    if (!isResults(json))
        return Error{ErrorCode::badInput,
                     fmt::format("File '{}' is no results.json of schema {}; run `sconce bench` again.", file.string(), kSchema)};
    return parsed;
}

namespace
{

bool holdsNumbers(const Json& object)
{
    return object.is_object() && std::ranges::all_of(object, [](const Json& value) { return value.is_number(); });
}

/// A part's frame, or null where it is none.
Json gpuFrame(const std::string& name, const Json& part)
{
    if (!name.starts_with("frame") && !name.starts_with("glossy")) return nullptr;
    const Json result = part.value("result", Json());
    if (!result.is_object() || !holdsNumbers(result.value("passes_ms", Json()))) return nullptr;
    return {{"name", name}, {"clock_mhz", part.value("clock_mhz", Json())}, {"passes_ms", result["passes_ms"]}};
}

void addGpuRays(Json& rays, const Json& part, bool cold)
{
    const auto rate = [](const Json& row, const char* order) { return row.value(order, Json::object()).value("mrays_per_s", Json()); };
    const Json result = part.value("result", Json());
    if (!result.is_array()) return;
    for (const Json& row : result)
    {
        if (!holdsTexts(row, {"tracer"}) || !row.value("coherent_ms", Json()).is_object() ||
            !row.value("incoherent_ms", Json()).is_object())
            continue;
        const Json inOrder = rate(row, "coherent_ms"), shuffled = rate(row, "incoherent_ms");
        if (inOrder.is_number() && shuffled.is_number())
            rays.push_back({{"tracer", row["tracer"]}, {"cold", cold}, {"in_order", inOrder}, {"shuffled", shuffled}});
    }
}

/// The device that a kit's doctor names first, which is what it ran on; null where there is none.
Json gpuDevice(const Json& parts)
{
    const Json doctor = parts.value("doctor", Json());
    const Json result = doctor.is_object() ? doctor.value("result", Json()) : Json();
    const Json devices = result.is_object() ? result.value("devices", Json()) : Json();
    if (!devices.is_array() || devices.empty() || !holdsTexts(devices[0], {"name", "driver"})) return nullptr;
    return devices[0];
}

} // namespace

Result<Json> readGpuRun(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream)
        return Error{ErrorCode::fileError, fmt::format("File '{}' can't be read; give what bench/gpu/run.sh wrote.", file.string())};
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return parsed;
    const Json parts = parsed->is_object() ? parsed->value("parts", Json()) : Json();
    const Json device = parts.is_object() ? gpuDevice(parts) : Json();
    if (device.is_null())
        return Error{ErrorCode::badInput, fmt::format("File '{}' is not what bench/gpu/run.sh writes; run the kit again.", file.string())};
    Json run = {{"device", device["name"]},
                {"driver", device["driver"]},
                {"size", parsed->value("size", Json())},
                {"wrong", parsed->value("wrong", Json())},
                {"frames", Json::array()},
                {"rays", Json::array()}};
    for (const auto& [name, part] : parts.items())
    {
        if (!part.is_object()) continue;
        if (Json frame = gpuFrame(name, part); !frame.is_null()) run["frames"].push_back(std::move(frame));
        if (name == "race" || name == "race_cold") addGpuRays(run["rays"], part, name == "race_cold");
    }
    return run;
}

} // namespace sconce
