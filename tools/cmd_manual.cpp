// sconce manual: manual page and completions, from the options themselves.
#include <iostream>

#include "tools/common.h"
#include "tools/manual.h"

namespace sconce::tools
{

namespace
{

struct ManualOptions
{
    const CLI::App* app = nullptr;
    std::string form = kManualForms[0];
};

int runManual(const ManualOptions& options, const Context&)
{
    std::cout << (options.form == kManualForms[0]   ? manualPage(*options.app)
                  : options.form == kManualForms[1] ? bashCompletion(*options.app)
                                                    : zshCompletion(*options.app))
              << std::flush;
    return exitOk;
}

} // namespace

void addManualCommand(CLI::App& app, Context& context)
{
    CLI::App* command = addCommand(app, context, "manual", "This program's manual page, and its completion for shells, from its options");
    auto options = std::make_shared<ManualOptions>();
    options->app = &app;
    command
        ->add_option("FORM", options->form,
                     described("man: a page for `man -l -`; bash, zsh: completion, for `source <(sconce manual bash)`", options->form))
        ->check(unlisted(CLI::IsMember(std::vector<std::string>(std::begin(kManualForms), std::end(kManualForms)))))
        ->type_name("man|bash|zsh");
    onChosen(command, context, options, runManual);
}

} // namespace sconce::tools
