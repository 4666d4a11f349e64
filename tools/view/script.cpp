#include "tools/view/script.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace sconce::tools
{

namespace
{

struct Syntax
{
    std::string_view name;
    ScriptCommand command;
    size_t least, most; // words after it
    std::string_view use;
};
constexpr Syntax kSyntax[] = {
    {"camera", ScriptCommand::camera, 2, 2, "camera X,Y,Z X,Y,Z (eye, target)"},
    {"set", ScriptCommand::set, 2, 2, "set KNOB VALUE"},
    {"effect", ScriptCommand::effect, 2, 2, "effect NAME on|off"},
    {"effects", ScriptCommand::effects, 1, 1, "effects auto|all|none|LIST"},
    {"view", ScriptCommand::view, 1, 1, "view NAME"},
    {"compare", ScriptCommand::compare, 1, 2, "compare off|split|difference [PATHS]"},
    {"sun", ScriptCommand::sun, 1, 2, "sun X,Y,Z [R,G,B] (the way its light travels, irradiance)"},
    {"dim", ScriptCommand::dim, 2, 2, "dim GROUP W|R,G,B"},
    {"panel", ScriptCommand::panel, 1, 1, "panel on|off"},
    {"frame", ScriptCommand::frame, 1, 1, "frame N"},
    {"shot", ScriptCommand::shot, 1, 1, "shot FILE.exr or shot FILE.png"},
    {"screen", ScriptCommand::screen, 1, 1, "screen FILE.png"},
    {"quit", ScriptCommand::quit, 0, 0, "quit"},
};

std::vector<std::string> wordsOf(std::string_view line)
{
    std::istringstream stream{std::string(line.substr(0, line.find('#')))};
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(std::move(word));
    return words;
}

bool parseCount(const std::string& text, uint32_t most, uint32_t& count)
{
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), count);
    return fault == std::errc() && end == text.data() + text.size() && count > 0 && count <= most;
}

std::string commandNames()
{
    std::string names;
    for (const Syntax& syntax : kSyntax) names += fmt::format("{}{}", names.empty() ? "" : ", ", syntax.name);
    return names;
}

/// What the words of a step mean. @return  what is wrong with them; empty: nothing
std::string understand(ScriptStep& step)
{
    const std::vector<std::string>& words = step.words;
    const auto numbers = [](const std::string& text, vec3& value)
    { return parseVec3(text, value) ? std::string() : fmt::format("'{}' is not three numbers parted by commas", text); };
    const auto count = [&](const std::string& text)
    {
        return parseCount(text, kMostScriptFrames, step.count)
                   ? std::string()
                   : fmt::format("'{}' is not a whole number from 1 to {}", text, kMostScriptFrames);
    };
    const auto ending = [&](std::initializer_list<const char*> endings)
    {
        for (const char* end : endings)
            if (words[0].ends_with(end) && words[0].size() > 4) return std::string();
        return fmt::format("'{}' doesn't end as its kind of picture does", words[0]);
    };
    switch (step.command)
    {
    case ScriptCommand::camera:
        if (std::string fault = numbers(words[0], step.eye); !fault.empty()) return fault;
        if (std::string fault = numbers(words[1], step.target); !fault.empty()) return fault;
        return step.eye == step.target ? "eye and target are the same point" : "";
    case ScriptCommand::sun:
        if (std::string fault = numbers(words[0], step.eye); !fault.empty()) return fault;
        if (step.eye == vec3(0.0f)) return "the sun has no direction";
        step.on = words.size() > 1;
        if (!step.on) return {};
        if (std::string fault = numbers(words[1], step.target); !fault.empty()) return fault;
        return glm::any(glm::lessThan(step.target, vec3(0.0f))) ? "the sun's light is negative" : "";
    case ScriptCommand::effect:
    case ScriptCommand::panel:
        step.on = words.back() == "on";
        return step.on || words.back() == "off" ? "" : fmt::format("'{}' is neither on nor off", words.back());
    case ScriptCommand::compare:
        step.count = 1;
        return words.size() > 1 ? count(words[1]) : "";
    case ScriptCommand::frame:
        return count(words[0]);
    case ScriptCommand::shot:
        return ending({".exr", ".png"});
    case ScriptCommand::screen:
        return ending({".png"});
    default:
        return {};
    }
}

} // namespace

bool parseNumber(std::string_view text, float& value)
{
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool parseVec3(std::string_view text, vec3& value)
{
    for (int i = 0; i < 3; ++i)
    {
        const size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (i == 2) || !parseNumber(text.substr(0, comma), value[i])) return false;
        text.remove_prefix(i == 2 ? text.size() : comma + 1);
    }
    return true;
}

Result<std::vector<ScriptStep>> parseScript(std::string_view text, const std::string& name)
{
    std::vector<ScriptStep> steps;
    size_t number = 0;
    while (!text.empty())
    {
        const size_t end = text.find('\n');
        std::vector<std::string> words = wordsOf(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++number;
        if (words.empty()) continue;
        const auto wrong = [&](const std::string& what, std::string_view right) {
            return Error{ErrorCode::badInput, fmt::format("The script '{}', line {}: {}; {}.", name, number, what, right)};
        };
        const Syntax* syntax = nullptr;
        for (const Syntax& known : kSyntax)
            if (known.name == words[0]) syntax = &known;
        if (!syntax) return wrong(fmt::format("there is no command '{}'", words[0]), "there are " + commandNames());
        ScriptStep step{syntax->command, number, {words.begin() + 1, words.end()}};
        const std::string write = fmt::format("write {}", syntax->use);
        if (step.words.size() < syntax->least || step.words.size() > syntax->most)
            return wrong(fmt::format("{} has {} words after it", words[0], step.words.size()), write);
        if (const std::string fault = understand(step); !fault.empty()) return wrong(fault, write);
        steps.push_back(std::move(step));
    }
    return steps;
}

Result<std::vector<ScriptStep>> readScript(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    if (stream) text << stream.rdbuf();
    if (!stream || !text)
        return Error{ErrorCode::fileError, fmt::format("Cannot read the script '{}'; give a file of text.", file.string())};
    return parseScript(text.str(), file.string());
}

} // namespace sconce::tools
