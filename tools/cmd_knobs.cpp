// sconce knobs: what can be set, from the table that everything else takes it from.
#include <iostream>
#include <regex>

#include <fmt/format.h>

#include "base/knobs.h"
#include "tools/common.h"

namespace sconce::tools
{

namespace
{

struct KnobsOptions
{
    bool markdown = false;
};

/// Options and pages marked up.
std::string marked(std::string text)
{
    text = std::regex_replace(text, std::regex("--[a-z][a-z-]*"), "`$&`");
    return std::regex_replace(text, std::regex("docs/[a-z_]+\\.md"), "[$&]($&)");
}

std::string nameIn(const KnobRow& row)
{
    std::string names = row.option.empty() ? "" : fmt::format("`{}`", row.option);
    for (const std::string& member : row.member.empty() ? std::vector<std::string>() : split(std::string(row.member), ','))
        names += fmt::format("{}{}`", names.empty() ? "`" : ", `", member.substr(member.find_first_not_of(' ')));
    return names;
}

/// The README's table.
void printMarkdown()
{
    std::cout << "| knob | default | range | what it buys and costs |\n| --- | --- | --- | --- |\n";
    for (const KnobRow& row : knobRows())
        if (row.readme)
            std::cout << "| " << nameIn(row) << " | " << marked(row.byDefault) << " | " << row.range << " | "
                      << marked(std::string(row.buys)) << " |\n";
    std::cout << std::flush;
}

void printText()
{
    for (const KnobRow& row : knobRows())
    {
        std::cout << (row.option.empty() ? row.member : row.option);
        if (!row.option.empty() && !row.member.empty()) std::cout << ", " << row.member;
        std::cout << "\n    " << row.what << (row.buys.empty() ? "" : "; ") << row.buys << "\n    default: " << row.byDefault
                  << "; range: " << row.range << "\n";
    }
    std::cout << std::flush;
}

Json knobsJson()
{
    Json list = Json::array();
    for (const KnobRow& row : knobRows())
        list.push_back({{"name", row.name},
                        {"option", row.option},
                        {"member", row.member},
                        {"default", row.byDefault},
                        {"range", row.range},
                        {"unit", row.unit},
                        {"what", row.what},
                        {"buys", row.buys}});
    return list;
}

int runKnobs(const KnobsOptions& options, const Context& context)
{
    if (context.json)
        print(knobsJson());
    else if (options.markdown)
        printMarkdown();
    else
        printText();
    return exitOk;
}

} // namespace

void addKnobsCommand(CLI::App& app, Context& context)
{
    CLI::App* command = addCommand(app, context, "knobs", "Everything that can be set: default, range, unit, what it buys and costs");
    auto options = std::make_shared<KnobsOptions>();
    command->add_flag("--markdown", options->markdown, described("The README's table of them", words("text")));
    onChosen(command, context, options, runKnobs);
}

} // namespace sconce::tools
