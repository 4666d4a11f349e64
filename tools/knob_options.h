#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/knobs.h"

namespace sconce::tools
{

/// A default that is no number: "the scene's camera". One with a digit doesn't compile: numbers come from the table or the variable.
struct Words
{
    consteval Words(const char* literal) : text(literal)
    {
        if (text.find_first_of("0123456789") != std::string_view::npos) throw "a number belongs in base/knobs.h";
    }
    std::string_view text;
};
consteval Words words(const char* literal)
{
    return Words(literal);
}

/// An option's line of --help: "what (default: ...; range: ...)". No help text says a default or a range but through it, so that none can
/// say another than the table or the variable has.
std::string described(std::string_view what, Words byDefault, const std::string& range = {});
std::string described(std::string_view what, const std::string& byDefault, const std::string& range = {});
std::string described(std::string_view what, const char* byDefault, const std::string& range = {}) = delete; // words(), or a variable

/// What the knob is, and what it buys.
template <class T> std::string wordsOf(const Knob<T>& knob)
{
    std::string text(knob.what);
    return knob.buys.empty() ? text : fmt::format("{}; {}", text, knob.buys);
}

/// The check of the knob's range.
template <class T> CLI::Validator checkOf(const Knob<T>& knob)
{
    const auto check = [&knob](const std::string& text) -> std::string
    {
        T value{};
        bool allowed = false;
        if constexpr (std::is_same_v<T, std::string_view>)
            allowed = knob.inRange(text);
        else
            allowed = CLI::detail::lexical_cast(text, value) && knob.inRange(value);
        return allowed ? std::string() : fmt::format("it can't be '{}'; give {}.", text, rangeText(knob));
    };
    return CLI::Validator(check, "");
}

template <class T> std::string typeName(const Knob<T>& knob)
{
    std::string names;
    for (const T choice : knob.only) names += fmt::format("{}{}", names.empty() ? "" : "|", knobText(choice));
    return names;
}

/// An option whose words, default, range and check are the knob's.
/// @param what  instead of the knob's words, where they don't fit this command
template <class T, class Target>
CLI::Option* addKnob(CLI::App* command, const std::string& name, Target& target, const Knob<T>& knob, const char* type = "N",
                     std::string_view what = {})
{
    constexpr bool choice = std::is_same_v<T, std::string_view>;
    const std::string text = what.empty() ? wordsOf(knob) : std::string(what);
    return command
        ->add_option(name, target, described(text, defaultText(knob), choice ? std::string() : rangeText(knob))) // type_name has choices
        ->check(checkOf(knob))
        ->type_name(choice ? typeName(knob) : type);
}

/// A choice that the target holds as its place among them: an enum, or a number.
template <class Target>
CLI::Option* addChoice(CLI::App* command, const std::string& name, Target& target, const Knob<std::string_view>& knob)
{
    std::map<std::string, Target> places;
    for (size_t i = 0; i < knob.only.size(); ++i) places.emplace(knob.only[i], Target(i));
    return command->add_option(name, target, described(wordsOf(knob), defaultText(knob)))
        ->transform(CLI::CheckedTransformer(places).description(""))
        ->type_name(typeName(knob));
}

inline CLI::Option* addSwitch(CLI::App* command, const std::string& name, bool& target, const Knob<bool>& knob)
{
    return command->add_flag(name, target, described(knob.what, defaultText(knob)));
}

} // namespace sconce::tools
