// sconce merge: the light field of a bake's parts.
#include <algorithm>

#include <fmt/format.h>

#include "tools/bake_command.h"

namespace sconce::tools
{

namespace
{

struct MergeOptions
{
    std::vector<std::string> parts;
    std::string output;
    JobOptions job;
};

/// What the parts' command was told, but for what is a merge's own.
Result<BakeOptions> toldBy(const JournalFile& part, CLI::App& app, Context& context)
{
    auto arguments = commandOf(part);
    if (!arguments) return arguments.error();
    const BakeCommands commands = addBakeCommands(app, context);
    std::ranges::reverse(*arguments); // CLI11 takes them from the end
    try
    {
        app.parse(std::move(*arguments));
    }
    catch (const CLI::ParseError& error)
    {
        return Error{ErrorCode::badInput, fmt::format("The part '{}' was baked by a command that can't be read ({}); bake it again",
                                                      part.path().string(), error.what())};
    }
    return app.got_subcommand("capture") ? *commands.capture : *commands.bake;
}

int runMerge(const MergeOptions& options, const Context& context)
{
    auto parts = readParts(options.parts);
    if (!parts) return fail(parts.error());
    CLI::App app;
    Context ofParts;
    Result<BakeOptions> told = toldBy(parts->front(), app, ofParts);
    if (!told) return fail(told.error());
    told->output = options.output;
    told->job = options.job;
    return runBake(*told, std::move(*parts), context);
}

} // namespace

void addMergeCommand(CLI::App& app, Context& context)
{
    CLI::App* merge = addCommand(app, context, "merge",
                                 "The light field of parts that `bake --shard` or `capture --shard` wrote: the bytes of one bake. By their "
                                 "command, which they hold: run it in the folder that their scene and probes are named from");
    auto options = std::make_shared<MergeOptions>();
    merge
        ->add_option("PART", options->parts,
                     "Part files of all shards of the maps, and of what is gathered all or none, in any order (required)")
        ->required()
        ->type_name("");
    merge->add_option("-o,--output", options->output, ".sconce file to write (required)")->required()->type_name("FILE");
    options->job.add(merge);
    onChosen(merge, context, options, runMerge);
}

} // namespace sconce::tools
