#include "tools/manual.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/common.h"

namespace sconce::tools
{
namespace
{

std::vector<const CLI::App*> commandsOf(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> namesOf(const std::vector<const CLI::App*>& commands)
{
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    return names;
}

/// "-o", "--output": as they are typed; empty of a positional.
std::vector<std::string> spellings(const CLI::Option& option)
{
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<const CLI::Option*> optionsOf(const CLI::App& app)
{
    return app.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

std::vector<std::string> optionNames(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : optionsOf(app))
        for (const std::string& name : spellings(*option)) names.push_back(name);
    return names;
}

/// The words that an option takes, where its type lists some: "auto|all|none|LIST" without what is in capitals.
std::vector<std::string> wordsOf(const CLI::Option& option)
{
    std::vector<std::string> words;
    const std::string type = option.get_type_name();
    if (type.find('|') == std::string::npos) return words;
    for (const std::string& word : split(type, '|'))
        if (std::ranges::none_of(word, [](char c) { return c >= 'A' && c <= 'Z'; })) words.push_back(word);
    return words;
}

/// Text as roff takes it: no line begins with a dot or an apostrophe, hyphens and backslashes are what they look like.
std::string roff(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
    }
    return out;
}

std::string optionEntry(const CLI::Option& option)
{
    const std::vector<std::string> names = spellings(option);
    const std::string type = option.get_type_name();
    return fmt::format(".TP\n.B {}{}\n{}\n", roff(fmt::format("{}", fmt::join(names, ", "))),
                       type.empty() ? "" : " \\fI" + roff(type) + "\\fR", roff(option.get_description()));
}

std::string commandSection(const CLI::App& command)
{
    std::string usage = "sconce " + command.get_name();
    std::string entries;
    for (const CLI::Option* option : command.get_options())
    {
        if (option->get_positional())
        {
            usage += " " + option->get_name(true);
            entries += fmt::format(".TP\n.I {}\n{}\n", roff(option->get_name(true)), roff(option->get_description()));
        }
        else
            entries += optionEntry(*option);
    }
    return fmt::format(".SS {} [OPTIONS]\n{}\n{}", roff(usage), roff(command.get_description()), entries);
}

/// One line a case of a shell's `case`: pattern) then what is offered.
std::string cases(const std::vector<const CLI::App*>& commands, const char* form)
{
    std::string text;
    for (const CLI::App* command : commands)
        text += fmt::format(fmt::runtime(form), command->get_name(), fmt::join(optionNames(*command), " "));
    return text;
}

/// The same by sub-command and option, where an option takes one of some words.
std::string wordCases(const std::vector<const CLI::App*>& commands, const char* form)
{
    std::string text;
    for (const CLI::App* command : commands)
        for (const CLI::Option* option : optionsOf(*command))
            if (const std::vector<std::string> words = wordsOf(*option); !words.empty())
                for (const std::string& name : spellings(*option))
                    text += fmt::format(fmt::runtime(form), command->get_name(), name, fmt::join(words, " "));
    return text;
}

} // namespace

std::string manualPage(const CLI::App& app)
{
    std::string page = ".TH SCONCE 1\n.SH NAME\nsconce \\- real\\-time indirect light from light field probes\n.SH SYNOPSIS\n.B sconce\n"
                       ".I COMMAND\n[\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n" +
                       roff(app.get_description()) + "\n.SH OPTIONS\n";
    for (const CLI::Option* option : optionsOf(app)) page += optionEntry(*option);
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : commandsOf(app)) page += commandSection(*command);
    return page;
}

std::string bashCompletion(const CLI::App& app)
{
    const std::vector<const CLI::App*> commands = commandsOf(app);
    return fmt::format(R"(_sconce()
{{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}} offered=
    COMPREPLY=()
    if [[ $COMP_CWORD -eq 1 ]]; then
        offered="{}"
    elif [[ $word == -* ]]; then
        case $command in
{}        esac
    else
        case "$command $before" in
{}        esac
    fi
    if [[ -n $offered ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$offered" -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
}}
complete -o filenames -F _sconce sconce
)",
                       fmt::join(namesOf(commands), " "), cases(commands, "            {}) offered=\"{}\" ;;\n"),
                       wordCases(commands, "            \"{} {}\") offered=\"{}\" ;;\n"));
}

std::string zshCompletion(const CLI::App& app)
{
    const std::vector<const CLI::App*> commands = commandsOf(app);
    return fmt::format(R"(#compdef sconce
_sconce()
{{
    local offered= before=${{words[CURRENT-1]}} command=${{words[2]}}
    if (( CURRENT == 2 )); then
        offered="{}"
    elif [[ ${{words[CURRENT]}} == -* ]]; then
        case $command in
{}        esac
    else
        case "$command $before" in
{}        esac
    fi
    if [[ -n $offered ]]; then
        compadd -- ${{=offered}}
    else
        _files
    fi
}}
compdef _sconce sconce
)",
                       fmt::join(namesOf(commands), " "), cases(commands, "            {}) offered=\"{}\" ;;\n"),
                       wordCases(commands, "            \"{} {}\") offered=\"{}\" ;;\n"));
}

} // namespace sconce::tools
