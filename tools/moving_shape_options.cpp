#include "tools/moving_shape_options.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/parsed_json.h"
#include "runtime/frame/moving_shapes.h"
#include "tools/common.h"
#include "tools/json_numbers.h"

namespace sconce::tools
{
namespace
{

constexpr std::string_view kKinds[] = {"sphere", "capsule", "box"}; // as MovingShape::Kind

/// What is wrong with one shape of a file; empty where it is read.
std::string readShape(const Json& json, MovingShape& shape)
{
    if (!json.is_object() || !json.contains("kind") || !json["kind"].is_string()) return "it has no kind";
    const auto kind = std::ranges::find(kKinds, json["kind"].get<std::string>());
    if (kind == std::end(kKinds)) return fmt::format("its kind is '{}'; give {}", json["kind"].get<std::string>(), fmt::join(kKinds, ", "));
    shape.kind = MovingShape::Kind(kind - std::begin(kKinds));
    vec4 turn(0.0f, 0.0f, 0.0f, 1.0f);
    for (const auto& [key, value] : json.items())
    {
        bool right = true;
        if (key == "centre")
            right = readNumbers(value, shape.centre);
        else if (key == "turn")
            right = readNumbers(value, turn);
        else if (key == "half")
            right = readNumbers(value, shape.half);
        else if (key == "albedo")
            right = readNumbers(value, shape.albedo);
        else if (key == "emission")
            right = readNumbers(value, shape.emission);
        else if (key == "slack")
            right = readNumber(value, shape.slack);
        else
            right = key == "kind";
        if (!right) return fmt::format("its '{}' is unknown or not as it should be", key);
    }
    shape.turn = glm::quat(turn.w, turn.x, turn.y, turn.z);
    return {};
}

} // namespace

void MovingShapeOptions::add(CLI::App* command)
{
    command
        ->add_option(
            "--shapes", file,
            described(fmt::format(
                          "What stands in the picture and not in the scene that the field was baked from: JSON, {{\"shapes\": "
                          "[{{\"kind\": \"capsule\", \"centre\": [x,y,z], \"half\": [radius, half length, 0], \"albedo\": [r,g,b]}}, "
                          "...]}}, up to {}; kinds are sphere, capsule (along its y), box; besides there are turn (a quaternion x,y,z,w), "
                          "emission and slack",
                          gpu::kMostMovingShapes),
                      words("none")))
        ->type_name("FILE");
}

Result<std::vector<MovingShape>> MovingShapeOptions::read() const
{
    std::vector<MovingShape> shapes;
    if (file.empty()) return shapes;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{ErrorCode::fileError, fmt::format("Cannot read shapes '{}'.", file)};
    const auto parsed = parsedJson<Json>(stream, file);
    if (!parsed) return parsed.error();
    const Json& json = *parsed;
    const auto wrong = [&](const std::string& what) { return Error{ErrorCode::badInput, fmt::format("Shapes '{}': {}.", file, what)}; };
    if (!json.is_object() || !json.contains("shapes") || !json["shapes"].is_array())
        return wrong("it is no JSON object with an array `shapes`");
    for (const Json& one : json["shapes"])
        if (const std::string fault = readShape(one, shapes.emplace_back()); !fault.empty())
            return wrong(fmt::format("of shape {} {}", shapes.size() - 1, fault));
    if (const std::string fault = faultOf(shapes, gpu::kMostMovingShapes); !fault.empty()) return wrong(fault);
    return shapes;
}

} // namespace sconce::tools
