#include "tools/live_light_options.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "base/listed.h"
#include "base/parsed_json.h"
#include "runtime/field/live_light.h"
#include "tools/common.h"
#include "tools/json_numbers.h"

namespace sconce::tools
{

namespace
{

/// Of three numbers, or six; nothing where there is no direction, or light below 0.
std::optional<SunPlace> placeIn(std::span<const float> numbers)
{
    if (numbers.size() != 3 && numbers.size() != 6) return std::nullopt;
    SunPlace place{vec3(numbers[0], numbers[1], numbers[2]), std::nullopt};
    if (!(glm::length(place.direction) > 0.0f)) return std::nullopt;
    place.direction = glm::normalize(place.direction);
    if (numbers.size() == 6) place.irradiance = vec3(numbers[3], numbers[4], numbers[5]);
    if (place.irradiance && glm::any(glm::lessThan(*place.irradiance, vec3(0.0f)))) return std::nullopt;
    return place;
}

constexpr std::string_view kTypes[] = {"directional", "point", "spot"}; // as LightType

/// What is wrong with one light of a file, as a sentence; empty where it is read.
std::string readLight(const Json& json, Light& light)
{
    if (!json.is_object() || !json.contains("type") || !json["type"].is_string()) return "it has no type";
    const auto type = std::ranges::find(kTypes, json["type"].get<std::string>());
    if (type == std::end(kTypes)) return fmt::format("its type is '{}'; give {}", json["type"].get<std::string>(), fmt::join(kTypes, ", "));
    light.type = LightType(type - std::begin(kTypes));
    for (const auto& [key, value] : json.items())
    {
        bool right = true;
        if (key == "name" && value.is_string())
            light.name = value.get<std::string>();
        else if (key == "position")
            right = readNumbers(value, light.position);
        else if (key == "direction")
            right = readNumbers(value, light.direction);
        else if (key == "intensity")
            right = readNumbers(value, light.intensity);
        else if (key == "range")
            right = readNumber(value, light.range);
        else if (key == "inner_cone")
            right = readNumber(value, light.innerCone);
        else if (key == "outer_cone")
            right = readNumber(value, light.outerCone);
        else
            right = key == "type";
        if (!right) return fmt::format("its '{}' is unknown or not as it should be", key);
    }
    if (const float length = glm::length(light.direction); light.type != LightType::point && length > 0.0f) light.direction /= length;
    return {};
}

Result<std::vector<Light>> lightsIn(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{ErrorCode::fileError, fmt::format("Cannot read lights '{}'.", file.string())};
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return parsed.error();
    const Json& json = *parsed;
    const auto wrong = [&](const std::string& what) {
        return Error{ErrorCode::badInput, fmt::format("Lights '{}': {}.", file.string(), what)};
    };
    if (!json.is_object() || !json.contains("lights") || !json["lights"].is_array())
        return wrong("it is no JSON object with an array `lights`");
    std::vector<Light> lights;
    for (const Json& one : json["lights"])
        if (const std::string fault = readLight(one, lights.emplace_back()); !fault.empty())
            return wrong(fmt::format("of light {} {}", lights.size() - 1, fault));
    if (const std::string fault = lightFault(lights); !fault.empty()) return wrong(fault);
    return lights;
}

} // namespace

void LiveLightOptions::add(CLI::App* command)
{
    command
        ->add_option_function<std::string>(
            "--sun",
            [this](const std::string& text)
            {
                const Result<std::vector<float>> n = parseNumbers(text, {3, 6});
                if (!n) throw CLI::ValidationError("--sun", n.error().message);
                const vec3 direction((*n)[0], (*n)[1], (*n)[2]);
                if (!(glm::length(direction) > 0.0f)) throw CLI::ValidationError("--sun", fmt::format("'{}' has no direction", text));
                sunDirection = glm::normalize(direction);
                if (n->size() == 6) sunIrradiance = vec3((*n)[3], (*n)[4], (*n)[5]);
                if (sunIrradiance && glm::any(glm::lessThan(*sunIrradiance, vec3(0.0f))))
                    throw CLI::ValidationError("--sun", fmt::format("'{}' has negative light", text));
            },
            described("Replaces all directional lights by one: the way its light travels, any length, and its irradiance in W/m^2",
                      fmt::format("{}; irradiance {},{},{}", defaultText(knobs::light), knobText(kDefaultSunIrradiance[0]),
                                  knobText(kDefaultSunIrradiance[1]), knobText(kDefaultSunIrradiance[2])),
                      rangeText(knobs::light)))
        ->type_name("X,Y,Z[,R,G,B]");
    command
        ->add_option(
            "--lights", file,
            described("Lights of no extent in place of all others: JSON, {\"lights\": [{\"type\": \"point\", \"position\": [x,y,z], "
                      "\"intensity\": [r,g,b]}, ...]}; types are directional, point, spot; besides there are name, direction, range, "
                      "inner_cone and outer_cone",
                      words("the scene's own, or those of the field")))
        ->type_name("FILE");
}

Status LiveLightOptions::apply(std::vector<Light>& lights) const
{
    if (!file.empty())
    {
        auto read = lightsIn(file);
        if (!read) return read.error();
        lights = std::move(*read);
    }
    if (!sunDirection) return success();
    std::erase_if(lights, [](const Light& light) { return light.type == LightType::directional; });
    Light sun;
    sun.name = "sun";
    sun.direction = *sunDirection;
    sun.intensity = sunIrradiance.value_or(vec3(kDefaultSunIrradiance[0], kDefaultSunIrradiance[1], kDefaultSunIrradiance[2]));
    lights.insert(lights.begin(), sun);
    return success();
}

void turnSun(std::vector<Light>& lights, const SunPlace& place)
{
    auto sun = std::ranges::find(lights, LightType::directional, &Light::type);
    if (sun == lights.end())
    {
        sun = lights.insert(lights.begin(), Light());
        sun->name = "sun";
        sun->intensity = vec3(kDefaultSunIrradiance[0], kDefaultSunIrradiance[1], kDefaultSunIrradiance[2]);
    }
    sun->direction = place.direction;
    if (place.irradiance) sun->intensity = *place.irradiance;
    if (!(place.direction.y < 0.0f)) sun->intensity = vec3(0.0f);
}

std::string heldSunFault(std::span<const Light> fixed)
{
    const auto sun = std::ranges::find(fixed, LightType::directional, &Light::type);
    return sun == fixed.end() ? "" : fmt::format("the sun '{}' is in a light group, which dims it where it stands", sun->name);
}

Result<std::vector<SunPlace>> sunPath(const std::filesystem::path& file, uint32_t count)
{
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{ErrorCode::fileError, fmt::format("Cannot read the sun's path '{}'.", file.string())};
    const auto wrong = [&](size_t line, const std::string& what) {
        return Error{ErrorCode::badInput, fmt::format("The sun's path '{}', line {}: {}.", file.string(), line, what)};
    };
    std::string text;
    std::getline(stream, text);
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
    const bool coloured = text == "time,x,y,z,r,g,b";
    if (!coloured && text != "time,x,y,z") return wrong(1, "its header is neither time,x,y,z nor time,x,y,z,r,g,b");
    std::vector<std::vector<float>> lines;
    for (size_t line = 2; std::getline(stream, text); ++line)
    {
        while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
        if (text.empty()) continue;
        auto numbers = parseNumbers(text, {coloured ? 7u : 4u});
        if (!numbers) return wrong(line, fmt::format("'{}' is not {} numbers", text, coloured ? 7 : 4));
        if (!lines.empty() && !((*numbers)[0] > lines.back()[0])) return wrong(line, "its time is not after the line's before");
        lines.push_back(std::move(*numbers));
    }
    if (stream.bad()) return Error{ErrorCode::fileError, fmt::format("Cannot read the sun's path '{}' to its end.", file.string())};
    if (lines.empty()) return wrong(2, "there is no place of the sun; give one line at least");
    std::vector<SunPlace> places;
    for (uint32_t i = 0; i < count; ++i)
    {
        const float share = count > 1 ? float(i) / float(count - 1) : 0.0f,
                    time = lines.front()[0] + share * (lines.back()[0] - lines.front()[0]);
        const auto after = std::ranges::find_if(lines, [&](const auto& line) { return line[0] >= time; });
        const auto& high = after == lines.end() ? lines.back() : *after;
        const auto& low = after == lines.begin() ? lines.front() : *(after - 1);
        const float along = high[0] > low[0] ? (time - low[0]) / (high[0] - low[0]) : 0.0f;
        std::vector<float> at;
        for (size_t k = 1; k < low.size(); ++k) at.push_back(low[k] + along * (high[k] - low[k]));
        const auto place = placeIn(at);
        if (!place) return wrong(size_t(after - lines.begin()) + 2, "the sun has no direction there, or negative light");
        places.push_back(*place);
    }
    return places;
}

Result<std::vector<Light>> takeLiveLights(Scene& scene, std::vector<LightGroupDesc> groups)
{
    if (groups.empty()) groups.push_back({"rest", {}});
    const auto selected = selectLights(scene, groups);
    if (!selected) return selected.error();
    std::vector<Light> live, fixed;
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
    {
        bool named = false;
        for (size_t g = 0; g < groups.size(); ++g)
            named = named || (!groups[g].members.empty() && std::ranges::binary_search((*selected)[g].lights, i));
        (named ? fixed : live).push_back(scene.lights[i]);
    }
    scene.lights = std::move(fixed);
    return live;
}

} // namespace sconce::tools
